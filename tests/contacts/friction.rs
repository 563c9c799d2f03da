//! Friction: the equations of each state against systems written by hand, and motions against closed solutions.

use lagrange_core::contact::{Contact, Friction, Transition};
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};
use lagrange_systems::{Belt, Block, Puck, Rod, Sphere};

use crate::{Congruence, impacts};

fn block() -> Block<f64> {
    Block { m: 2.0, g: 10.0, mu: 0.3, pull: 1.0, floor: Contact::Closed, ..Block::default() }
}

#[test]
fn a_block_is_free_or_sticks_or_slides() {
    let state = State::new([0.5, 0.0], [0.0, 0.0]);
    for (floor, accelerations, multipliers) in [
        (Contact::Open, [0.5, -10.0], [0.0, 0.0]),
        (Contact::Closed, [0.0, 0.0], [20.0, -1.0]),
        (Contact::Slides([1.0, 0.0]), [-2.5, 0.0], [20.0, -6.0]),
        (Contact::Slides([-1.0, 0.0]), [3.5, 0.0], [20.0, 6.0]),
    ] {
        let solution = Block { floor, ..block() }.solve(&state).expect("it moves");
        assert_eq!(solution.accelerations.as_slice(), accelerations, "{floor:?}");
        assert_eq!(solution.multipliers.as_slice(), multipliers, "{floor:?}");
    }
}

/// The block thrown along the floor slides for v/(μ g), and stops.
#[test]
fn a_block_that_slides_stops() {
    let thrown = Block { pull: 0.0, ..block() };
    let path = thrown.motion(State::new([0.0; 2], [3.0, 0.0])).with_contacts().to(2.0).unwrap();
    let [Transition::Sticks { time, .. }] = path.transitions() else { panic!("{:?}", path.transitions()) };
    assert!((time - 1.0).abs() < 1e-14, "{time}");
    assert!((path.end().state().q[0] - 1.5).abs() < 1e-14, "{:?}", path.end());
    assert_eq!(path.end().state().v[0], 0.0);
}

/// A sphere thrown on a floor slides until v = 5/7 v₀, at the time 2/7 v₀/(μ g), and rolls (Milton 8.8; any textbook).
#[test]
fn a_sphere_thrown_on_a_floor_slides_and_then_rolls() {
    let sphere = Sphere { m: 0.4, g: 9.81, r: 0.3, e: 0.0, mu: 0.25, floor: Contact::Closed };
    for speed in [2.0, -2.0] {
        let motion = sphere.motion(State::new([0.0, 0.3, 0.0], [speed, 0.0, 0.0]));
        let path = motion.with_contacts().to(1.0).unwrap();
        let [Transition::Sticks { time, .. }] = path.transitions() else {
            panic!("{:?}", path.transitions())
        };
        assert!((time - 2.0 / 7.0 * 2.0 / (0.25 * 9.81)).abs() < 1e-13, "{time}");
        let v = path.end().state().v;
        assert!((v[0] - 5.0 / 7.0 * speed).abs() < 1e-13 && (v[2] * 0.3 - v[0]).abs() < 1e-14, "{v:?}");
    }
}

/// Held by a spring (den Hartog 1931), it sticks until k x = the limit, and slides with the lower force of sliding until it has
/// the speed of the belt again.
#[test]
fn a_block_on_a_belt_sticks_and_slips() {
    let system = Belt { m: 1.0, k: 4.0, speed: 0.2, hold: 2.0, pull: 1.0, ..Belt::default() };
    let path =
        system.motion(State::new([0.0], [0.2])).by(Taylor::default()).with_contacts().to(20.0).unwrap();
    // From x = hold/k = 1/2 at the speed 0.2 about the center pull/k = 1/4: x − 1/4 = A cos ωt + (v/ω) sin ωt, and
    // the speed is 0.2 again at the mirrored place.
    let (omega, amplitude) = (2.0_f64, 0.25_f64);
    let slides = (std::f64::consts::PI + 2.0 * (0.2_f64 / omega / amplitude).atan()) / omega;
    let sticks = 2.0 * amplitude / 0.2;
    let mut time = 0.5 / 0.2;
    for pair in path.transitions().chunks(2) {
        let [Transition::Slips { time: slips, .. }, Transition::Sticks { time: stops, .. }] = pair else {
            assert!(pair.len() == 1, "{pair:?}");
            continue;
        };
        assert!((slips - time).abs() < 1e-12, "{slips} for {time}");
        assert!((stops - time - slides).abs() < 1e-12, "{stops} for {}", time + slides);
        time += slides + sticks;
    }
    assert!(path.transitions().len() >= 8, "{:?}", path.transitions());
}

/// Thrown across an inclined plane, a block turns towards the line of fall, and with tan α = μ its speed plus its velocity down
/// the plane stays the same, so that it ends with half its speed straight down.
#[test]
fn a_block_thrown_across_a_slope_turns_down() {
    let tilt = 0.4_f64;
    let (down, floor) = ([0.0, 1.0], Contact::Closed);
    let slope = Puck { m: 1.0, g: 10.0, tilt, down, mu: tilt.tan(), floor, ..Puck::default() };
    let start = State::new([0.0; 3], [2.0, 0.0, 0.0]);
    let path = slope.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(20.0).unwrap();
    let v = path.end().state().v;
    assert!((v[0].hypot(v[1]) + v[1] - 2.0).abs() < 1e-10, "{v:?}");
    assert!((v[1] - 1.0).abs() < 1e-6 && v[0].abs() < 1e-6, "{v:?}");
}

/// The impulse along the floor is μ times that of the impact, or stops the point of contact, which takes 2/7 of the momentum
/// along it.
#[test]
fn a_sphere_with_spin_bounces() {
    let (r, e, mu) = (0.1, 0.8, 0.1);
    let sphere = Sphere { m: 0.4, g: 0.0, r, e, mu, floor: Contact::Open };
    for spin in [0.0, 15.0, 19.0, 30.0, -30.0] {
        let path =
            sphere.motion(State::new([0.0, 1.0, 0.0], [2.0, -1.0, spin])).with_contacts().to(2.0).unwrap();
        let slip: f64 = 2.0 - r * spin;
        let change = -(mu * (1.0 + e)).min(2.0 / 7.0 * slip.abs()) * slip.signum();
        let v = path.end().state().v;
        assert!((v[1] - e).abs() < 1e-14 && (v[0] - (2.0 + change)).abs() < 1e-14, "{spin}: {v:?}");
        assert!((v[2] - (spin - 2.5 * change / r)).abs() < 1e-12, "{spin}: {v:?}");
    }
}

/// Painlevé's rod: it slides on its lower end with a coefficient above 4/3, leaning so that friction presses it into the floor.
/// No force goes with any acceleration (Painlevé 1895; Génot and Brogliato 1999).
#[test]
fn a_rod_that_digs_in_is_named() {
    let theta = 1.1_f64;
    let (floor, j) = ([Contact::Closed, Contact::Open], 0.25 / 3.0);
    let rod = |mu| Rod { m: 1.0, j, a: 0.5, g: 9.81, mu: [mu; 2], left: -9.0, floor, ..Rod::default() };
    let start = State::new([0.0, 0.5 * theta.sin(), theta], [-3.0, 0.0, 0.0]);
    for sign in [1.0, -1.0] {
        let start = State { v: start.v * sign, ..start };
        let result = rod(3.0).motion(start).with_contacts().to(1.0);
        let jams = matches!(&result, Err(Error::FrictionJams { friction: "floor_friction[0]", .. }))
            || matches!(&result, Err(Error::Unfinished(ending)) if ending.to_string().contains("Painlevé"));
        assert_eq!(jams, sign > 0.0, "{result:?}");
    }
    assert!(rod(0.5).motion(start).with_contacts().to(0.1).is_ok());
}

/// A slender block rocks from corner to corner on a rough floor (Housner, *Bulletin of the Seismological Society of America* 53,
/// 1963). At each impact its energy falls by the factor (1 − 3/2 sin² α)², its equation (8); the largest angle between two
/// impacts follows from the energy.
#[test]
fn a_block_rocks_as_housner_says() {
    let (b, h, g) = (0.1_f64, 0.5_f64, 9.81);
    let (r, alpha) = (b.hypot(h), (b / h).atan());
    let (floor, j) = ([Contact::Closed, Contact::Open], b * b + h * h);
    let block = Rod { m: 3.0, j, a: b, h, g, mu: [0.8; 2], left: -9.0, floor, ..Rod::default() };
    // It leans on the left corner, by θ > 0.
    let theta = 0.6 * alpha;
    let (s, c) = theta.sin_cos();
    let start = State::at_rest([b * c - h * s, b * s + h * c, theta]);
    let path = block.motion(start).by(Dop853::with_tolerance(1e-12)).with_contacts().to(3.0).unwrap();
    let impacts = impacts(path.transitions());
    assert!(impacts.len() > 4, "{:?}", path.transitions());
    let ratio = (1.0 - 1.5 * alpha.sin().powi(2)).powi(2);
    let mut expected = 3.0 * g * r * ((alpha - theta).cos() - alpha.cos());
    for (impact, next) in impacts.iter().zip(&impacts[1..]) {
        let before = path.at(impact - 1e-3).unwrap().energy() - 3.0 * g * h;
        assert!((before - expected).abs() < 1e-9, "{before} for {expected}");
        expected *= ratio;
        // The largest angle, half way between two impacts.
        let largest = alpha - (alpha.cos() + expected / (3.0 * g * r)).acos();
        let found = path.at(0.5 * (impact + next)).unwrap().coordinate("theta").unwrap().abs();
        assert!((found - largest).abs() < 1e-9, "{found} for {largest}");
    }
}

/// Friction in all its states on random systems, against M, h, W and γ written by hand and a dense solver.
#[test]
fn each_state_solves_the_equations_written_by_hand() {
    let mut random = Congruence(3);
    let mut next = |low, high| random.between(low, high);
    let slides = |sign| Contact::Slides([sign, 0.0]);
    let shares = Contact::Shares([Some(-0.4), None]);
    let states = [Contact::Open, Contact::Closed, slides(1.0), slides(-1.0), shares];
    let (mut jams, count) = (0, cases([400, 2_000, 100_000]));
    for case in 0..count {
        // Two closed contacts of which one sticks are three rows at most.
        let floor = [states[case % 5], states[[0, 2, 3, 4][case / 5 % 4]]];
        let (m, j, a, mu) = (next(0.5, 2.0), next(0.1, 1.0), next(0.3, 1.0), next(0.0, 0.5));
        let rod = Rod { m, j, a, g: 9.81, mu: [mu; 2], left: -9.0, floor, ..Rod::default() };
        let theta = next(-1.3, 1.3);
        let state = State::new([0.0, 1.0, theta], [next(-2.0, 2.0), next(-2.0, 2.0), next(-2.0, 2.0)]);
        let omega = state.v[2];
        let (s, c) = theta.sin_cos();
        // Unknowns: q̈, then N and T of both ends.
        let mut k = nalgebra::SMatrix::<f64, 7, 7>::zeros();
        let mut rhs = nalgebra::SVector::<f64, 7>::zeros();
        for (i, mass) in [rod.m, rod.m, rod.j].into_iter().enumerate() {
            k[(i, i)] = mass;
        }
        rhs[1] = -rod.m * rod.g;
        for (end, side) in [-1.0, 1.0].into_iter().enumerate() {
            let (normal, tangent) = ([0.0, 1.0, side * rod.a * c], [1.0, 0.0, -side * rod.a * s]);
            let bias = [-side * rod.a * s * omega * omega, -side * rod.a * c * omega * omega];
            let (n, t) = (3 + end, 5 + end);
            for i in 0..3 {
                (k[(i, n)], k[(i, t)]) = (-normal[i], -tangent[i]);
            }
            let set = |k: &mut nalgebra::SMatrix<f64, 7, 7>, row: usize, of: [f64; 3]| {
                (0..3).for_each(|i| k[(row, i)] = of[i]);
            };
            match floor[end] {
                Contact::Open => (k[(n, n)], k[(t, t)]) = (1.0, 1.0),
                Contact::Closed => {
                    set(&mut k, n, normal);
                    set(&mut k, t, tangent);
                    (rhs[n], rhs[t]) = (-bias[0], -bias[1]);
                }
                Contact::Slides([sign, _]) => {
                    set(&mut k, n, normal);
                    rhs[n] = -bias[0];
                    (k[(t, t)], k[(t, n)]) = (1.0, mu * sign);
                }
                Contact::Shares([part, _]) => {
                    set(&mut k, n, normal);
                    rhs[n] = -bias[0];
                    (k[(t, t)], k[(t, n)]) = (1.0, -mu * part.unwrap());
                }
            }
        }
        let expected = k.lu().solve(&rhs).expect("a solution");
        let found = match rod.solve(&state) {
            Ok(found) => found,
            Err(Error::FrictionJams { .. }) => {
                jams += 1;
                continue;
            }
            Err(other) => panic!("case {case}, {floor:?}: {other}"),
        };
        let scale = 1e-11 * (1.0 + expected.amax());
        assert!((found.accelerations - expected.fixed_rows::<3>(0)).amax() < scale, "case {case}, {floor:?}");
        let of_floor = found.multipliers.fixed_rows::<4>(0);
        assert!((of_floor - expected.fixed_rows::<4>(3)).amax() < scale, "case {case}, {floor:?}");
        // Derivatives by central differences of accelerations, the emitted Jacobian's.
        let jacobian = rod.jacobian(&state).unwrap().accelerations;
        for column in 0..6 {
            let moved = |step: f64| {
                let mut moved = state;
                if column < 3 {
                    moved.q[column] += step;
                } else {
                    moved.v[column - 3] += step;
                }
                rod.solve(&moved).unwrap().accelerations
            };
            let difference = (moved(1e-6) - moved(-1e-6)) / 2e-6;
            let slopes = if column < 3 { jacobian.q.column(column) } else { jacobian.v.column(column - 3) };
            let error = (difference - slopes).amax();
            assert!(
                error < 1e-6 * (1.0 + difference.amax()),
                "case {case}, {floor:?}, column {column}: {error:e}"
            );
        }
    }
    // Rods that lean far and are light to turn dig in.
    assert!(jams < count / 10, "{jams}");
}

/// A crank drives a block along a floor. At its dead centres the block stops, and no force of friction moves the crank: the block turns round
/// all the same, and energy is lost by μ m g for each length.
#[test]
fn a_block_on_a_crank_turns_round_at_its_dead_centres() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(theta, y)]
    #[lagrangian(j/2 * theta_dot^2 + m/2 * y_dot^2 - m*g*y)]
    #[contact(floor: y >= 0, friction(mu): -l*sin(theta)*theta_dot)]
    struct Crank {
        j: f64,
        m: f64,
        l: f64,
        g: f64,
        mu: f64,
        floor: Contact,
    }
    let crank = Crank { j: 2.0, m: 1.0, l: 0.5, g: 10.0, mu: 0.3, floor: Contact::Closed };
    let motion = crank.motion(State::new([0.5, 0.0], [4.0, 0.0])).by(Dop853::with_tolerance(1e-12));
    let path = motion.with_contacts().to(2.0).unwrap();
    let (end, turns) = (path.end(), path.transitions());
    assert!(
        turns.iter().all(|turn| matches!(turn, Transition::Reverses { .. })) && turns.len() == 2,
        "{turns:?} {end:?}"
    );
    let theta = end.state().q[0];
    assert!(theta > 2.0 * std::f64::consts::PI && theta < 3.0 * std::f64::consts::PI, "{theta}");
    // From 0.5 to π, to 2 π, and on.
    let length = 0.5 * ((0.5_f64.cos() + 1.0) + 2.0 + (1.0 - theta.cos()));
    let lost = 0.5 * 2.0 * (16.0 - end.state().v[0] * end.state().v[0]);
    assert!((lost - 0.3 * 10.0 * length).abs() < 1e-9, "{lost} {}", 3.0 * length);
}

/// Two bodies fall side by side in a guide with a friction of so little that the force between them, which is zero, exceeds it by round-off.
#[test]
fn a_guide_without_friction_is_decided() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(y, z)]
    #[lagrangian(a/2*y_dot^2 + b/2*z_dot^2 - a*g*y - b*g*z)]
    #[friction(guide: y_dot - z_dot, sliding: hold)]
    struct Guided {
        a: f64,
        b: f64,
        g: f64,
        hold: f64,
        guide: Friction,
    }
    let mut random = Random(2);
    for _ in 0..cases([20, 40, 2000]) {
        let [a, b] = [(); 2].map(|()| random.between(0.1, 50.0));
        for hold in [0.0, 1e-300, 1e-20, 1e-16, 1e-15, 1e-12] {
            let guided = Guided { a, b, g: 9.81, hold, guide: Friction::Sticks };
            for v in [[0.0; 2], [0.1, 0.2]] {
                let path = guided.motion(State::new([1.0, 0.5], v)).with_contacts().to(0.1).unwrap();
                let fallen = path.end().state().q - lagrange_core::nalgebra::Vector2::new(1.0, 0.5);
                let expected = v.map(|v| 0.1 * v - 0.5 * 9.81 * 0.01);
                let off = (fallen - lagrange_core::nalgebra::Vector2::from(expected)).amax();
                assert!(off < 1e-12, "{a} {b} {hold:e} {v:?}: {off:e}");
            }
        }
    }
}
