//! Derivatives of motions where holonomic and velocity constraints meet, beside Richardson's extrapolation of differences.
//!
//! Systems are families whose coefficients, starts and times are drawn at random: 4 arguments of each, and every
//! argument at the level `full`.

use lagrange_core::nalgebra::DVector;
use lagrange_core::{Dual, StateOf, error::Entry, linearized::DifferentiableMethod, prelude::*};

use crate::event_differences::{block, check, stack, values};
use lagrange_random::{Level, Random, cases};
use lagrange_systems::random_state;

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-12)
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, th)]
#[lagrangian(x_dot^2/2 + 2*y_dot^2 + th_dot^2/2)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[constraint(knife: x_dot*sin(th) = y_dot*cos(th) + th_dot)]
struct Knife<T> {
    l: T,
}

/// At rest it stays where it is put: the nearest place on the rod, which x and y share as one over their masses.
#[test]
fn a_velocity_constraint_takes_no_part_in_where_a_motion_starts() {
    let (knife, start) = (Knife { l: 1.0 }, State::at_rest([0.6, 0.8, 0.4]));
    // M δq = F μ with F δq = l: μ = 1/(0.36/1 + 0.64/4).
    let expected = [0.6, 0.2, 0.0].map(|x| x / 0.52);
    let by_pairs = knife.integrate_sensitivities(start, 1.0, method(), &["l"]).unwrap();
    let by_series = knife.integrate_sensitivities(start, 1.0, Taylor::default(), &["l"]).unwrap();
    for found in [by_pairs.end().unwrap(), by_series.end().unwrap()] {
        for (found, expected) in found.q.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "{found} for {expected}");
        }
    }
}

/// A bob on a rod with a knife, and a stop that moves against its turning.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, th, u)]
#[lagrangian(x_dot^2/2 + 2*y_dot^2 + th_dot^2/2 + u_dot^2/2 + x*y_dot*u_dot/4 - g*x)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[constraint(knife: x_dot*sin(th) = y_dot*cos(th) + th_dot)]
struct Turning {
    l: f64,
    g: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, th, u)]
#[lagrangian(x_dot^2/2 + 2*y_dot^2 + th_dot^2/2 + u_dot^2/2 + x*y_dot*u_dot/4 - g*x)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[constraint(knife: x_dot*sin(th) = y_dot*cos(th) + th_dot)]
#[constraint(stop: th + x^2/4 + u/3 = s - w*t)]
struct Stopped {
    l: f64,
    g: f64,
    s: f64,
    w: f64,
}

/// To the impact, where the rod and the knife hold on, and after it.
#[test]
fn an_impact_on_constraints_of_both_kinds() {
    const NAMES: [&str; 4] = ["x", "l", "w", "e"];
    let (given, start) = ([1.0, 0.1, 0.5], State::new([0.6, 0.8, 0.2, 0.1], [1.2, -0.8, 1.5, 1.0]));
    let start = Turning { l: given[0], g: 3.0 }.make_consistent(&start).unwrap().0;
    let run = |start: State<f64, 4>, [l, w, e]: [f64; 3]| {
        let (g, s) = (3.0, 0.6);
        let (turning, stopped) = (Turning { l, g }, Stopped { l, g, s, w });
        let start = turning.make_consistent(&start).unwrap().0;
        let hits = turning.differentiable_event("hits", |at| {
            let ([x, _, th, u], moved) = (at.state().q.into(), at.number("w", w) * at.time());
            th + x * x * Dual::constant(0.25) + u / Dual::constant(3.0) + moved - Dual::constant(s)
        });
        let at = turning.sensitivity(&start, &NAMES[..2]).unwrap().with(&NAMES[2..]).unwrap();
        let turn =
            turning.motion_with_derivatives(&at).by(method()).event(hits.rising().terminal()).towards(10.0);
        let hit = stopped.impact_sensitivity(turn.unwrap().end().unwrap(), "stop", ("e", e)).unwrap();
        let after = turning.motion_with_derivatives(&hit).by(method()).towards(1.2).unwrap();
        (hit, after.end().unwrap().clone())
    };
    let (hit, end) = run(start, given);
    assert!(hit.state.t > 0.1 && hit.state.t < 1.0, "{}", hit.state.t);
    check("a knife on a rod that is stopped", &stack([block(&hit), block(&end)]), |j, change| {
        let (mut start, mut given) = (start, given);
        match j {
            0 => start.q[0] += change,
            j => given[j - 1] += change,
        }
        let (hit, end) = run(start, given);
        stack([values(&hit.state), values(&end.state)])
    });
}

/// A mass matrix that varies, a curved surface and a skate on it.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z, w)]
#[lagrangian(m[0]/2*(1 + x^2/4)*x_dot^2 + m[1]/2*y_dot^2 + m[2]/2*(1 + sin(y)^2/3)*z_dot^2 + m[3]/2*w_dot^2
    + n*(x_dot*y_dot*cos(z) + z_dot*w_dot*sin(x)) - k/2*(x^2 + y^2 + z^2 + w^2) - g*y)]
#[constraint(surface: a[0]*x^2/2 + a[1]*y^2/2 + a[2]*z + a[3]*x*w = l)]
#[constraint(skate: (b[0] + b[1]*sin(x))*x_dot + b[2]*y_dot + b[3]*cos(y)*z_dot + w_dot = b[4] + b[5]*x)]
struct Skate<T> {
    m: [T; 4],
    n: T,
    k: T,
    g: T,
    a: [T; 4],
    l: T,
    b: [T; 6],
}

/// Two bars that move with time, and a wheel.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z, u, w)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) + j/2*(1 + x^2/3)*u_dot^2 + j/3*w_dot^2 - k/2*(x^2 + u^2 + w^2) - g*z)]
#[dissipation(c/2*u_dot^2)]
#[constraint(first: (x^2 + y^2 + z^2 - (l + s*sin(t))^2)/2 = 0)]
#[constraint(second: y - h*sin(u) + s*x*w = 0)]
#[constraint(wheel: x_dot*cos(u) + z_dot*sin(u) - r*w_dot = s*t)]
struct Bars<T> {
    m: T,
    j: T,
    k: T,
    g: T,
    c: T,
    l: T,
    s: T,
    h: T,
    r: T,
}

/// A bob that two velocity constraints steer, by one of which a coordinate without mass follows.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z, s)]
#[lagrangian(m[0]/2*x_dot^2 + m[1]/2*y_dot^2 + m[2]/2*z_dot^2 + n*x_dot*z_dot*sin(y) - k/2*(x^2 + y^2) - g*z - f*s*x)]
#[constraint(rod: (x^2 + a*y^2 + z^2 - l^2)/2 = 0)]
#[constraint(steer: b*x_dot*sin(s) + y_dot*cos(s) = e*z_dot)]
#[constraint(follow: s_dot = p*y_dot + e*x*z_dot)]
struct Follower<T> {
    m: [T; 3],
    n: T,
    k: T,
    g: T,
    f: T,
    a: T,
    l: T,
    b: T,
    e: T,
    p: T,
}

/// A body whose attitude is a quaternion, with a blade that does not turn about an axis of its own.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [4], x)]
#[define(w = quat_rate_body(q, q_dot))]
#[lagrangian(dot(w, [i[0]*w[0], i[1]*w[1], i[2]*w[2]])/2 + m/2*x_dot^2 + n*x_dot*w[0] - g*quat_rotate(q, [0, 0, 1])[2] - k/2*x^2)]
#[constraint(unit: (dot(q, q) - 1)/2 = 0)]
#[constraint(blade: a*w[0] + b*w[1] + w[2] = c*x_dot + d*x)]
struct Suslov<T> {
    i: [T; 3],
    m: T,
    n: T,
    g: T,
    k: T,
    a: T,
    b: T,
    c: T,
    d: T,
}

/// Numbers near these, by up to 30 %.
fn near<const K: usize>(random: &mut Random, about: [f64; K]) -> [f64; K] {
    about.map(|x| x * random.between(0.7, 1.3))
}

#[test]
fn a_skate_on_a_surface() {
    campaign(1, |random| {
        let [k, g, l, n] = near(random, [1.0, 2.0, 1.0, 0.2]);
        let [m, a] = [[1.0, 1.5, 0.8, 1.2], [0.5, 0.7, 1.0, 0.4]].map(|about| near(random, about));
        let b = near(random, [0.6, 0.3, -0.8, 0.5, 0.2, 0.3]);
        (
            Skate { m, n, k, g, a, l, b },
            State::new(random.array(Random::signed), random.array(Random::signed)),
        )
    });
}

#[test]
fn bars_and_a_wheel() {
    campaign(2, |random| {
        let [m, j, k, g, c] = near(random, [1.0, 0.7, 1.5, 2.0, 0.3]);
        let [l, s, h, r] = near(random, [1.5, 0.2, 1.2, 0.6]);
        let q = near(random, [0.9, 0.5, -1.1, 0.4, 0.3]);
        let start = State::new(q, random.array(Random::signed)).at_time(random.between(0.0, 2.0));
        (Bars { m, j, k, g, c, l, s, h, r }, start)
    });
}

#[test]
fn a_coordinate_without_mass_that_follows() {
    campaign(3, |random| {
        let m = near(random, [1.0, 1.4, 0.8]);
        let [n, k, g, f, a] = near(random, [0.2, 1.0, 2.0, 0.3, 0.8]);
        let [l, b, e, p] = near(random, [1.2, 0.5, 0.4, 0.7]);
        let q = near(random, [0.6, 0.5, -0.8, 0.4]);
        (Follower { m, n, k, g, f, a, l, b, e, p }, State::new(q, random.array(Random::signed)))
    });
}

#[test]
fn a_blade_on_a_body_that_turns_in_space() {
    campaign(4, |random| {
        let i = near(random, [1.0, 1.4, 0.8]);
        let [n, g, a, b, c, d] = near(random, [0.2, 1.5, 0.4, -0.3, 0.2, 0.3]);
        let [m, k] = random.array(Random::positive);
        let start = random_state(random);
        (Suslov { i, m, n, g, k, a, b, c, d }, start)
    });
}

/// Random systems of a family and random starts, for a time of 0.5 to 1.5, every fourth by Taylor's method.
fn campaign<S>(seed: u64, draw: impl Fn(&mut Random) -> (S, StateOf<S>))
where
    S: Linearized<Scalar = f64> + Clone,
    Taylor: DifferentiableMethod<S>,
{
    let count = cases([2, 4, 150]);
    let (mut random, mut worst, mut done, mut unclear) = (Random(seed), 0.0_f64, 0, 0);
    while done < count {
        let (system, start) = draw(&mut random);
        let end = start.t + random.between(0.5, 1.5);
        let all: Vec<usize> = (0..2 * S::COORDINATES.len() + S::PARAMETERS.len()).collect();
        let first = random.between(0.0, all.len() as f64) as usize;
        let mut arguments = all;
        if Level::asked() != Level::Full {
            arguments.rotate_left(first);
            arguments.truncate(4);
        }
        let Some(expected) = by_differences(&system, start, end, &arguments) else {
            unclear += 1;
            continue;
        };
        let found = if done % 4 == 3 {
            by_variations(&system, start, end, Taylor::default(), &arguments)
        } else {
            by_variations(&system, start, end, method(), &arguments)
        };
        for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let error = (found - expected).amax() / expected.amax().max(1e-3);
            let name = name::<S>(arguments[k]);
            assert!(error < 1e-6, "{} {done} by {name}: off by {error:e}\n{found}{expected}", S::NAME);
            worst = worst.max(error);
        }
        done += 1;
    }
    println!("{}: {done}, and {unclear} without a clear difference; at most {worst:.1e}", S::NAME);
    assert!(10 * unclear <= done, "{unclear} of {done}");
}

fn name<S>(argument: usize) -> String
where
    S: Linearized<Scalar = f64>,
{
    let n = S::COORDINATES.len();
    let entry = match argument {
        i if i < n => Entry::Coordinate(S::COORDINATES[i]),
        i if i < 2 * n => Entry::Velocity(S::COORDINATES[i - n]),
        i => Entry::Parameter(S::PARAMETERS[i - 2 * n]),
    };
    entry.to_string()
}

/// The derivatives of (q, q̇) at the end by each argument.
fn by_variations<S, D>(
    system: &S,
    start: StateOf<S>,
    end: f64,
    method: D,
    arguments: &[usize],
) -> Vec<DVector<f64>>
where
    S: Linearized<Scalar = f64>,
    D: DifferentiableMethod<S>,
{
    let start = system.make_consistent(&start).unwrap().0;
    let names: Vec<String> = arguments.iter().map(|&argument| name::<S>(argument)).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let motion = system.integrate_sensitivities(start, end, method, &names).unwrap();
    let at = motion.end().unwrap();
    let column = |j| at.q.column(j).iter().chain(&at.v.column(j)).copied().collect::<Vec<f64>>();
    (0..names.len()).map(|j| DVector::from_vec(column(j))).collect()
}

/// The same by central differences, extrapolated once; none where two steps do not agree.
fn by_differences<S>(
    system: &S,
    start: StateOf<S>,
    end: f64,
    arguments: &[usize],
) -> Option<Vec<DVector<f64>>>
where
    S: Linearized<Scalar = f64> + Clone,
{
    let n = S::COORDINATES.len();
    let start = system.make_consistent(&start).ok()?.0;
    let moved = |argument: usize, by: f64| {
        let (mut system, mut start) = (system.clone(), start);
        match argument {
            i if i < n => start.q[i] += by,
            i if i < 2 * n => start.v[i - n] += by,
            i => assert!(system.set_parameter(i - 2 * n, system.parameters()[i - 2 * n] + by)),
        }
        let (start, _) = system.make_consistent(&start).ok()?;
        let end = *system.integrate(start, end, method()).ok()?.end().state();
        Some(DVector::from_iterator(2 * n, end.q.iter().chain(&end.v).copied()))
    };
    let central = |argument, h: f64| Some((moved(argument, h)? - moved(argument, -h)?) / (2.0 * h));
    let extrapolated =
        |argument, h: f64| Some((central(argument, h / 2.0)? * 4.0 - central(argument, h)?) / 3.0);
    let derivative = |&argument: &usize| {
        let [coarse, fine] = [extrapolated(argument, 4e-3)?, extrapolated(argument, 1e-3)?];
        let agree = (&coarse - &fine).amax() < 1e-7 * fine.amax().max(1e-3);
        agree.then_some(fine)
    };
    arguments.iter().map(derivative).collect()
}
