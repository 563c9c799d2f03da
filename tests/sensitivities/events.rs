//! Derivatives across events, by closed forms and by differences of motions.

use lagrange_core::nalgebra::{DMatrix, DVector};
use lagrange_core::{Dual, Ending, Sensitivity, prelude::*};
use num_dual::Dual64;

use crate::differences::{STEPS, TOLERANCE, difference};

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-13).max_step(0.2)
}

/// Columns of derivatives beside columns of differences, each by its own largest.
fn check(what: &str, found: &DMatrix<f64>, of: impl Fn(usize, f64) -> DMatrix<f64>) {
    for (j, column) in found.column_iter().enumerate() {
        let errors = STEPS.map(|step| {
            let expected = difference(step, |change| DVector::from_column_slice(of(j, change).as_slice()));
            (column - &expected).amax() / expected.amax().max(1e-3)
        });
        let error = errors[0].min(errors[1]);
        println!("{what}, by argument {j}: {error:.1e}");
        assert!(error < TOLERANCE, "{what}, by argument {j}: off by {error:e}");
    }
}

/// Time, coordinates and velocities, one below the other.
fn block<const N: usize>(at: &Sensitivity<f64, N>) -> DMatrix<f64> {
    DMatrix::from_fn(1 + 2 * N, at.t.len(), |i, j| match i {
        0 => at.t[j],
        i if i <= N => at.q[(i - 1, j)],
        i => at.v[(i - 1 - N, j)],
    })
}

fn values<const N: usize>(state: &State<f64, N>) -> DMatrix<f64> {
    DMatrix::from_iterator(1 + 2 * N, 1, [state.t].iter().chain(&state.q).chain(&state.v).copied())
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
struct Flying {
    m: f64,
    g: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(floor: y = 0)]
struct Touching {
    m: f64,
    g: f64,
}

/// The height after three bounces: v₀eⁿ is the speed after impact n, 2v₀eⁿ/g until the next.
fn third_flight(t: f64, [h, g, e]: [Dual64; 3]) -> Dual64 {
    let v = (h * g * 2.0).sqrt();
    let third = v / g * (e * 2.0 + e * e * 2.0 + 1.0);
    let (tau, up) = (-third + t, v * e * e * e);
    up * tau - g * tau * tau * 0.5
}

#[test]
fn a_ball_after_three_bounces() {
    let (h, g, e) = (1.3, 9.81, 0.8);
    let (ball, floor) = (Flying { m: 0.2, g }, Touching { m: 0.2, g });
    let mut lands = ball.differentiable_event("lands", |s| s.coordinate("y")).falling().terminal();
    let start = State::new([0.0, h], [0.5, 0.0]);
    let mut at = ball.sensitivity(&start, &["y", "g", "m", "x_dot"]).unwrap().with(&["e"]).unwrap();
    for bounce in 1..=3 {
        lands = lands.terminal_at(bounce);
        let flight = ball.integrate_sensitivities_until(&at, 10.0, method(), &mut [&mut lands]).unwrap();
        let landing = flight.end().unwrap();
        // At the event the height is zero whatever changes.
        assert!(landing.q.row(1).amax() < 1e-14);
        at = floor.impact_sensitivity(landing, "floor", ("e", e)).unwrap();
    }
    let end = at.state.t + 0.3;
    let flight = ball.integrate_sensitivities_until(&at, end, method(), &mut [&mut lands]).unwrap();
    for t in [at.state.t + 1e-9, at.state.t + 0.13, end] {
        let [one, d] = [Dual64::from_re, |x| Dual64::from_re(x).derivative()];
        let exact = [
            third_flight(t, [d(h), one(g), one(e)]).eps,
            third_flight(t, [one(h), d(g), one(e)]).eps,
            0.0,
            0.0,
            third_flight(t, [one(h), one(g), d(e)]).eps,
        ];
        let found = flight.at(t).unwrap();
        for (j, exact) in exact.into_iter().enumerate() {
            let found = found.q[(1, j)];
            assert!((found - exact).abs() < 1e-12 * (1.0 + exact.abs()), "{t}, {j}: {found} for {exact}");
        }
        // Whatever it does, it goes on along x.
        assert!((found.q[(0, 3)] - t).abs() < 1e-13 && found.q[(0, 4)].abs() < 1e-15);
    }
    let by = flight.coordinate(end, "y", "e").unwrap();
    assert_eq!(by, flight.end().unwrap().q[(1, 4)]);
}

/// One below the other.
fn stack([above, below]: [DMatrix<f64>; 2]) -> DMatrix<f64> {
    let rows = above.nrows();
    DMatrix::from_fn(
        2 * rows,
        above.ncols(),
        |i, j| if i < rows { above[(i, j)] } else { below[(i - rows, j)] },
    )
}

/// A bob on a rod, and a wall that moves away.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + n*x_dot*y_dot*z - m*g*z)]
#[constraint(rod: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
struct Bob {
    m: f64,
    n: f64,
    g: f64,
    l: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + n*x_dot*y_dot*z - m*g*z)]
#[constraint(rod: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
#[constraint(wall: x + y^2/2 = w*t)]
struct Walled {
    m: f64,
    n: f64,
    g: f64,
    l: f64,
    w: f64,
}

/// Through two impacts and on: entries of the start and all parameters; a rod, a curved wall that moves, masses
/// that depend on where it is, and an event that depends on the time.
#[test]
fn a_spherical_pendulum_that_hits_a_wall_twice() {
    const NAMES: [&str; 8] = ["x_dot", "y", "m", "n", "g", "l", "w", "e"];
    let given @ [m, n, g, l, ..] = [1.1, 0.3, 9.81, 1.0, 0.12, 0.7];
    let start = State::new([-0.5, 0.2, -0.9], [0.6, 0.9, 0.0]);
    let start = Bob { m, n, g, l }.make_consistent(&start).unwrap().0;
    let run = |start: State<f64, 3>, [m, n, g, l, w, e]: [f64; 6]| {
        let (bob, walled) = (Bob { m, n, g, l }, Walled { m, n, g, l, w });
        let start = bob.make_consistent(&start).unwrap().0;
        let mut hits = bob.differentiable_event("hits", |s| {
            let [x, y, _] = s.state().q.into();
            x + y * y * Dual::constant(0.5) - s.number("w", w) * s.time()
        });
        hits = hits.rising();
        let mut at = bob.sensitivity(&start, &NAMES[..6]).unwrap().with(&NAMES[6..]).unwrap();
        for hit in 1..=2 {
            hits = hits.terminal_at(hit);
            let swing = bob.integrate_sensitivities_until(&at, 10.0, method(), &mut [&mut hits]).unwrap();
            assert!(matches!(swing.trajectory().ending(), Ending::Event { .. }));
            at = walled.impact_sensitivity(swing.end().unwrap(), "wall", ("e", e)).unwrap();
        }
        let end = 2.2;
        assert!(at.state.t > 0.3 && at.state.t < end, "{}", at.state.t);
        let after = bob.integrate_sensitivities_until(&at, end, method(), &mut []).unwrap();
        assert_eq!(after.trajectory().end().time(), end);
        let last = after.end().unwrap().clone();
        // Derivatives by the start stay on the rod.
        let off = |j: usize| (last.q.column(j).transpose() * last.state.q)[0];
        assert!(off(0).abs() < 1e-11 && off(1).abs() < 1e-11 && off(6).abs() < 1e-11);
        (at, last)
    };
    let (at, last) = run(start, given);
    let changed = |j: usize, change: f64| {
        let (mut start, mut given) = (start, given);
        match j {
            0 => start.v[0] += change,
            1 => start.q[1] += change,
            j => given[j - 2] += change,
        }
        run(start, given)
    };
    // After the second impact, and at the end.
    let found = stack([block(&at), block(&last)]);
    check("a wall hit twice", &found, |j, change| {
        let (at, last) = changed(j, change);
        stack([values(&at.state), values(&last.state)])
    });
}

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[constraint(friction: x_dot - belt = 0)]
struct Sticking {
    m: f64,
    k: f64,
    belt: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[force(x: pull)]
struct Slipping {
    m: f64,
    k: f64,
    pull: f64,
}

/// Place and velocity of a block on a belt: it rides until the spring pulls with `hold`, swings about pull/k to the mirror
/// image of that place, and is caught there.
fn stick_slip(t: f64, [m, k, belt, pull, hold]: [Dual64; 5]) -> [Dual64; 2] {
    let (first, d, omega) = (hold / k / belt, (hold - pull) / k, (k / m).sqrt());
    let slips = ((omega * d / belt).atan() * -2.0 + std::f64::consts::TAU) / omega;
    let since = -first + t;
    if since.re < 0.0 {
        return [belt * t, belt];
    }
    if since.re < slips.re {
        let (sin, cos) = (omega * since).sin_cos();
        return [pull / k + d * cos + belt / omega * sin, belt * cos - omega * d * sin];
    }
    [pull / k - d + belt * (since - slips), belt]
}

#[test]
fn stick_and_slip_from_system_to_system() {
    let values @ [m, k, belt, pull, hold] = [0.7, 3.0, 0.4, 1.1, 1.7];
    let (sticking, slipping) = (Sticking { m, k, belt }, Slipping { m, k, pull });
    let mut gives = sticking
        .differentiable_event("gives", |s| Ok(s.multiplier("friction")? - s.number("hold", hold)))
        .rising()
        .terminal();
    let mut catches = slipping
        .differentiable_event("catches", |s| Ok(s.velocity("x")? - s.number("belt", belt)))
        .rising()
        .terminal();
    let start = State::new([0.0], [belt]);
    let start = sticking.sensitivity(&start, &["m", "k", "belt"]).unwrap().with(&["pull", "hold"]).unwrap();
    let method = Dop853::with_tolerance(1e-13);
    let ride = sticking.integrate_sensitivities_until(&start, 50.0, method, &mut [&mut gives]).unwrap();
    let slip = slipping
        .integrate_sensitivities_until(ride.end().unwrap(), 50.0, method, &mut [&mut catches])
        .unwrap();
    let caught = slip.end().unwrap();
    let again =
        sticking.integrate_sensitivities_until(caught, caught.state.t + 0.5, method, &mut []).unwrap();
    for (leg, part) in (0..30).map(|k| (k % 3, f64::from(1 + k / 3) / 11.0)) {
        let (start, end) = match leg {
            0 => (0.0, ride.trajectory().end().time()),
            1 => (ride.trajectory().end().time(), caught.state.t),
            _ => (caught.state.t, caught.state.t + 0.5),
        };
        let t = start + part * (end - start);
        let found = match leg {
            0 => ride.at(t),
            1 => slip.at(t),
            _ => again.at(t),
        };
        let found = found.unwrap();
        for j in 0..5 {
            let one = |i: usize| {
                if i == j { Dual64::from_re(values[i]).derivative() } else { Dual64::from_re(values[i]) }
            };
            let [x, v] = stick_slip(t, std::array::from_fn(one));
            let off = (found.q[(0, j)] - x.eps).abs().max((found.v[(0, j)] - v.eps).abs());
            assert!(off < 1e-11 * (1.0 + x.eps.abs() + v.eps.abs()), "{t}, {j}: off by {off:e}");
        }
    }
    // δ(F q̇ + b) = 0 of the belt: it is as fast as the belt, whatever the speed of that.
    assert!(again.end().unwrap().v.column(2)[0] == 1.0 && again.end().unwrap().v.column(0)[0] == 0.0);
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[constraint(floor: y - a*sin(theta) = 0)]
#[constraint(wall: x - a*cos(theta) = 0)]
struct Leaning {
    m: f64,
    a: f64,
    g: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
#[constraint(floor: y - a*sin(theta) = 0)]
struct Sliding {
    m: f64,
    a: f64,
    g: f64,
}

/// It leaves where sin θ is 2/3 of what it was.
#[test]
fn a_ladder_that_leaves_the_wall() {
    let run = |theta: f64, [m, a, g]: [f64; 3]| {
        let (leaning, sliding) = (Leaning { m, a, g }, Sliding { m, a, g });
        let start = State::at_rest([2.0 * 1.2_f64.cos(), 2.0 * 1.2_f64.sin(), theta]);
        let start = leaning.make_consistent(&start).unwrap().0;
        let leaves = leaning.differentiable_event("leaves", |s| s.multiplier("wall"));
        let mut leaves = leaves.falling().terminal();
        let at = leaning.sensitivity(&start, &["theta", "m", "a", "g"]).unwrap();
        let lean = leaning.integrate_sensitivities_until(&at, 10.0, method(), &mut [&mut leaves]).unwrap();
        let left = lean.end().unwrap().clone();
        let [from, to] = [start.q[2], left.state.q[2]];
        assert!((to.sin() - from.sin() * 2.0 / 3.0).abs() < 1e-12);
        let (expected, turned) = (2.0 / 3.0 * from.cos() / to.cos(), lean.at(0.0).unwrap().q[(2, 0)]);
        assert!((left.q[(2, 0)] - expected * turned).abs() < 1e-10, "{}", left.q[(2, 0)] / turned);
        let slide = sliding.integrate_sensitivities_until(&left, 1.4, method(), &mut []).unwrap();
        (left, slide.end().unwrap().clone())
    };
    let given = [3.0, 2.0, 9.81];
    let (left, last) = run(1.2, given);
    assert!(left.state.t < 1.3);
    check("a ladder", &stack([block(&left), block(&last)]), |j, change| {
        let (mut theta, mut given) = (1.2, given);
        match j {
            0 => theta += change,
            j => given[j - 1] += change,
        }
        let (left, last) = run(theta, given);
        stack([values(&left.state), values(&last.state)])
    });
}

/// A pendulum swings, its string is cut at an angle, and the bob flies until it lands: from one coordinate to two.
#[test]
fn a_reset_to_other_coordinates() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(theta)]
    #[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
    struct Swinging {
        m: f64,
        l: f64,
        g: f64,
    }
    let run = |[theta, l, g, cut, speed]: [f64; 5]| {
        let (swinging, flying) = (Swinging { m: 0.2, l, g }, Flying { m: 0.2, g });
        let cuts =
            swinging.differentiable_event("cut", |s| Ok(s.coordinate("theta")? - s.number("cut", cut)));
        let mut cuts = cuts.rising().terminal();
        let lands = flying.differentiable_event("lands", |s| Ok(s.coordinate("y")? + Dual::constant(3.0)));
        let mut lands = lands.falling().terminal();
        let at = swinging.sensitivity(&State::at_rest([theta]), &["theta", "l", "g"]).unwrap();
        let at = at.with(&["cut", "speed"]).unwrap();
        let swing = swinging.integrate_sensitivities_until(&at, 10.0, method(), &mut [&mut cuts]).unwrap();
        let thrown = swinging.carry(swing.end().unwrap(), |s| {
            let (l, theta, rate) = (s.parameter("l")?, s.coordinate("theta")?, s.velocity("theta")?);
            let (sin, cos) = theta.sin_cos();
            // Thrown a little faster the later it is.
            let up = l * sin * rate + s.number("speed", speed) * s.time();
            Ok([[l * sin, -l * cos], [l * cos * rate, up]])
        });
        let flight =
            flying.integrate_sensitivities_until(&thrown.unwrap(), 10.0, method(), &mut [&mut lands]);
        flight.unwrap().end().unwrap().clone()
    };
    let given = [-1.0, 1.5, 9.81, 0.7, 0.4];
    check("a cut pendulum", &block(&run(given)), |j, change| {
        let mut given = given;
        given[j] += change;
        values(&run(given).state)
    });
}

/// The map from one crossing of x = 0 to the next, at one energy, keeps areas of (y, ẏ).
#[test]
fn a_poincare_map_keeps_areas() {
    #[derive(Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
    struct HenonHeiles;

    let state = State::new([0.0, 0.1], [0.35, 0.1]);
    let start = HenonHeiles.sensitivity(&state, &["y", "y_dot", "x_dot"]).unwrap();
    let mut section = HenonHeiles.differentiable_event("section", |s| s.state().q[0]).rising().terminal_at(5);
    let method = Dop853::with_tolerance(1e-13);
    let motion = HenonHeiles.integrate_sensitivities_until(&start, 1e3, method, &mut [&mut section]).unwrap();
    let end = motion.end().unwrap();
    assert_eq!(motion.trajectory().crossings().len(), 5);
    assert!(end.q.row(0).amax() < 1e-14 && end.t.amin() > 1e-3, "{end:?}");
    // At x = 0 the energy is (ẋ² + ẏ² + y²)/2 − y³/3: with y and ẏ changes ẋ.
    let by_x_dot = [-(0.1 - 0.01) / 0.35, -0.1 / 0.35];
    let at = |row: &DMatrix<f64>, j: usize| row[(1, j)] + row[(1, 2)] * by_x_dot[j];
    let area = at(&end.q, 0) * at(&end.v, 1) - at(&end.q, 1) * at(&end.v, 0);
    assert!((area - 1.0).abs() < 1e-10, "{area}");
}

/// There and back again: a bounce undoes itself where time goes back.
#[test]
fn an_elastic_bounce_backwards() {
    let (ball, floor) = (Flying { m: 1.0, g: 9.81 }, Touching { m: 1.0, g: 9.81 });
    let mut lands = ball.differentiable_event("lands", |s| s.coordinate("y")).terminal();
    let start = ball.sensitivity(&State::new([0.0, 1.0], [1.0, 0.5]), &["x", "y", "x_dot", "y_dot"]).unwrap();
    let mut at = start.clone();
    for (bounce, time) in [(1, 10.0), (2, 0.7), (2, -10.0), (3, 0.0)] {
        lands = lands.terminal_at(bounce);
        let flight = ball.integrate_sensitivities_until(&at, time, method(), &mut [&mut lands]).unwrap();
        at = flight.end().unwrap().clone();
        if time.abs() == 10.0 {
            assert!(at.state.q[1].abs() < 1e-15 && at.t[1].abs() > 1e-2);
            at = floor.impact_sensitivity(&at, "floor", ("e", 1.0)).unwrap();
        }
    }
    assert!((&at.q - &start.q).amax() < 1e-13 && (&at.v - &start.v).amax() < 1e-12, "{at:?}");
}

/// Where the mass matrix is singular and constraints say the same twice, the general solve serves. Of the two ends of a lever,
/// of which one has the mass, the other is stopped: ẋ⁺ = −e ẋ.
#[test]
fn singular_and_dependent_systems_have_derivatives_of_impacts() {
    #[derive(Lagrangian)]
    #[coordinates(x, z)]
    #[lagrangian(m/2 * x_dot^2)]
    #[constraint(lever: z - r*x = 0)]
    #[constraint(again: z^2/2 - r^2*x^2/2 = 0)]
    #[constraint(stop: z - 1 = 0)]
    struct Lever {
        m: f64,
        r: f64,
    }
    let (lever, e) = (Lever { m: 4.0, r: 2.0 }, 0.5);
    let before = lever.sensitivity(&State::new([0.5, 1.0], [1.0, 2.0]), &["m"]).unwrap().with(&["e", "by"]);
    let mut before = before.unwrap();
    // Faster on the constraints.
    (before.v[(0, 2)], before.v[(1, 2)]) = (1.0, 2.0);
    let after = lever.impact_sensitivity(&before, "stop", ("e", e)).unwrap();
    let expected = [[0.0, 0.0], [-1.0, -2.0], [-e, -2.0 * e]];
    for (j, [x, z]) in expected.into_iter().enumerate() {
        assert!((after.v[(0, j)] - x).abs() < 1e-13 && (after.v[(1, j)] - z).abs() < 1e-13, "{}", after.v);
    }
}

/// λ z of a rod is the force on z, and m z̈ = −m g + λ z where masses do not depend on the place.
#[test]
fn what_follows_from_a_state_changes_with_it() {
    let bob = Bob { m: 1.1, n: 0.0, g: 9.81, l: 1.0 };
    let state = State::new([-0.5, 0.2, -0.9], [0.6, 0.9, 0.0]);
    let state = bob.make_consistent(&state).unwrap().0;
    let at = bob.sensitivity(&state, &["x", "y", "z", "z_dot", "m", "n", "g", "l"]).unwrap();
    let forces = bob.carry(&at, |s| {
        let [m, g, z] = [s.parameter("m")?, s.parameter("g")?, s.coordinate("z")?];
        let lever = s.multiplier("rod")? * z;
        // What n adds is −n d(ẋẏ)… of the rows of x and y, and n ẋ ẏ in that of z.
        let row =
            m * s.acceleration("z")? + m * g - s.parameter("n")? * s.velocity("x")? * s.velocity("y")?;
        Ok([[s.constraint_force("z")?, lever], [row, lever]])
    });
    let Sensitivity { state, q, v, .. } = forces.unwrap();
    assert!((state.q[0] - state.q[1]).abs() < 1e-14 && (state.q[0] - state.v[0]).abs() < 1e-13);
    assert!(q.row(0).amax() > 1.0 && (q.row(0) - q.row(1)).amax() < 1e-12, "{q}");
    assert!((q.row(0) - v.row(0)).amax() < 1e-12, "{q}{v}");
}

#[test]
fn what_grazes_has_no_derivative() {
    let (ball, start) = (Flying { m: 1.0, g: 1.0 }, State::new([0.0, 0.0], [0.0, 1.0]));
    let start = ball.sensitivity(&start, &["y_dot"]).unwrap();
    let method = Dop853::default().fixed_step(0.25);
    // One that touches zero at t = 1, and one that is flat where it crosses.
    let mut touches = ball.differentiable_event("touches", |s| {
        let left = s.time() - Dual::constant(1.0);
        left * left
    });
    touches = touches.terminal();
    let mut flat = ball.differentiable_event("flat", |s| {
        let over = s.coordinate("y")? - Dual::constant(0.3);
        Ok(over * over * over)
    });
    flat = flat.terminal();
    let motion = ball.integrate_sensitivities_until(&start, 3.0, method, &mut [&mut touches]).unwrap();
    let error = motion.end().unwrap_err();
    assert_eq!(error, Error::Grazing { event: "touches", time: 1.0 });
    // The motion is there all the same, and its derivatives at given times.
    assert!((motion.at(0.6).unwrap().q[(1, 0)] - 0.6).abs() < 1e-14);
    let motion = ball.integrate_sensitivities_until(&start, 3.0, method, &mut [&mut flat]).unwrap();
    let error = motion.end().unwrap_err().to_string();
    assert!(error.contains("grazes the event `flat` at t = 0.367"), "{error}");
}

/// What was computed is there, and there is no end to go on from.
#[test]
fn what_is_not_finished_is_said() {
    let (ball, floor) = (Flying { m: 1.0, g: 9.81 }, Touching { m: 1.0, g: 9.81 });
    let mut at = ball.sensitivity(&State::at_rest([0.0, 1.0]), &["y"]).unwrap();
    let mut lands = ball.differentiable_event("lands", |s| s.coordinate("y")).falling().terminal();
    let few = method().max_steps(2);
    let fall = ball.integrate_sensitivities_until(&at, 5.0, few, &mut [&mut lands]).unwrap();
    assert!(
        matches!(fall.trajectory().ending(), Ending::StepLimit { .. })
            && fall.at(fall.trajectory().end().time() / 2.0).is_ok()
    );
    assert!(fall.end().unwrap_err().to_string().contains("after 2 steps") && fall.finished().is_err());
    assert!(matches!(ball.integrate_sensitivities(at.state, 5.0, few, &["y"]), Err(Error::Unfinished(_))));
    let mut bounces = 0;
    let ending = loop {
        let flight = ball.integrate_sensitivities_until(&at, 50.0, method(), &mut [&mut lands]).unwrap();
        match flight.end() {
            Ok(landing) => at = floor.impact_sensitivity(landing, "floor", ("e", 0.4)).unwrap(),
            Err(_) => break flight.trajectory().ending().clone(),
        }
        bounces += 1;
    };
    assert!(matches!(ending, Ending::EventsAccumulate { event: "lands", .. }) && bounces > 10, "{ending}");
}

/// As far as single precision goes.
#[test]
fn a_bounce_in_single_precision() {
    #[derive(Lagrangian)]
    #[coordinates(y)]
    #[lagrangian(y_dot^2/2 - g*y)]
    #[constraint(floor: y = 0)]
    struct Resting {
        g: f32,
    }
    #[derive(Lagrangian)]
    #[coordinates(y)]
    #[lagrangian(y_dot^2/2 - g*y)]
    struct Falling {
        g: f32,
    }
    let (ball, floor) = (Falling { g: 9.81 }, Resting { g: 9.81 });
    let mut lands = ball.differentiable_event("lands", |s| s.coordinate("y")).falling().terminal();
    let start = ball.sensitivity(&State::at_rest([1.0]), &["y", "g"]).unwrap().with(&["e"]).unwrap();
    let method = Dop853::with_tolerance(1e-6);
    let fall = ball.integrate_sensitivities_until(&start, 10.0, method, &mut [&mut lands]).unwrap();
    let bounce = floor.impact_sensitivity(fall.end().unwrap(), "floor", ("e", 0.8)).unwrap();
    let flight = ball.integrate_sensitivities_until(&bounce, 0.6, method, &mut []).unwrap();
    let (v, fall) = (19.62_f32.sqrt(), (2.0_f32 / 9.81).sqrt());
    assert!((flight.coordinate(0.6, "y", "e").unwrap() - v * (0.6 - fall)).abs() < 1e-5);
}

#[test]
fn what_cannot_be_is_named() {
    let (ball, floor) = (Flying { m: 1.0, g: 1.0 }, Touching { m: 1.0, g: 1.0 });
    let state = State::new([0.0, 0.0], [0.0, -1.0]);
    let start = ball.sensitivity(&state, &["y", "g"]).unwrap();
    assert!(matches!(ball.sensitivity(&state, &["h"]), Err(Error::UnknownName { .. })));
    assert!(matches!(start.clone().with(&["e", "g"]), Err(Error::RepeatedName { .. })));
    let error = floor.impact_sensitivity(&start, "flor", ("e", 0.5)).unwrap_err();
    assert!(error.to_string().contains("did you mean `floor`?"), "{error}");
    assert!(matches!(floor.impact_sensitivity(&start, "floor", ("e", -1.0)), Err(Error::Restitution { .. })));
    let mut event = ball.differentiable_event("no", |s| s.multiplier("floor"));
    let error = ball.integrate_sensitivities_until(&start, 1.0, method(), &mut [&mut event]).unwrap_err();
    assert!(error.to_string().contains("there is no constraint `floor`"), "{error}");
    // A value without a derivative.
    let mut kink = ball.differentiable_event("kink", |s| {
        let down = s.coordinate("y")?.value + 0.5;
        Ok(Dual { value: down, slope: f64::NAN })
    });
    kink = kink.terminal();
    let fall = ball.integrate_sensitivities_until(&start, 1.0, method(), &mut [&mut kink]).unwrap();
    assert!(matches!(fall.end(), Err(Error::EventNotFinite { event: "kink", .. })), "{:?}", fall.end());
}
