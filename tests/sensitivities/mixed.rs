//! Derivatives of motions of further systems, most of all where holonomic and velocity constraints meet.

use lagrange_core::linearized::DifferentiableMethod;
use lagrange_core::nalgebra::{Const, DVector};
use lagrange_core::{Function, Scalar, prelude::*};
use lagrange_random::{Random, cases};
use lagrange_systems::{ChaplyginSleigh, DoublePendulum, random_state};

use crate::differences::{changed, check_each, difference, flat, flow, names};
use crate::event_differences::BOB;
use crate::stiff::is_as_alone;
use crate::{BEAD, DAMPED, bead_start, method};

#[test]
fn driven_pendulum() {
    check_each(&DAMPED, State::new([1.0], [0.5]).at_time(1.0), 4.0);
}

#[test]
fn double_pendulum() {
    let system = DoublePendulum { m: [1.0, 0.7], l: [0.8, 1.1], g: 9.81 };
    check_each(&system, State::new([0.9, -0.4], [0.3, 1.0]), 2.0);
}

#[test]
fn spherical_pendulum_in_cartesian_coordinates() {
    check_each(&BOB, State::new([0.6, 0.2, -0.9], [0.5, 1.0, 0.3]), 2.0);
}

#[test]
fn chaplygin_sleigh() {
    let system = ChaplyginSleigh { m: 1.1, a: 0.4, inertia: 0.3 };
    check_each(&system, State::new([0.0, 0.0, 0.5], [0.8, 0.4, 1.5]), 3.0);
}

/// A pendulum on a rod, whose constraint follows from another where neither factor is zero.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rod: a*(x^2 + y^2 - l^2) = 0)]
#[constraint(again: b*(x*x_dot + y*y_dot) = 0)]
#[dissipation(c/2*(x_dot^2 + y_dot^2))]
struct Twice<T> {
    g: T,
    c: T,
    l: T,
    a: T,
    b: T,
}

#[test]
fn dependent_constraints() {
    let twice = Twice { g: 9.81, c: 0.2, l: 1.3, a: 1.0, b: 1.0 };
    check_each(&twice, State::new([0.5, -1.2], [1.2, 0.5]), 1.5);
    let method = Radau::with_tolerance(1e-8);
    is_as_alone(&twice, State::new([0.5, -1.2], [1.2, 0.5]), method);
    is_as_alone(&BEAD, bead_start(), method.stages::<5>());
    is_as_alone(&DAMPED, State::new([1.0], [0.5]), method.stages::<7>());
}

/// c φ̇ = −g/l cos φ for the angle from the horizontal, but for g/(l c²): sin φ = −tanh(g t/(l c)).
#[test]
fn a_pendulum_in_honey_has_its_closed_derivatives() {
    let (g, c, l, end) = (9.81, 1e6, 1.0, 3e5);
    let twice = Twice { g, c, l, a: 1.0, b: 1.0 };
    let method = Radau::with_tolerance(1e-9).stages::<5>();
    let names = ["y", "g", "c", "l"];
    let motion = twice.integrate_sensitivities(State::at_rest([1.0, 0.0]), end, method, &names).unwrap();
    assert!(motion.statistics().accepted < 60, "{:?}", motion.statistics());
    for t in [1e4, 1e5, 2.5e5, end] {
        let at = motion.derivatives_at(t).unwrap();
        let turned = g * t / (l * c);
        let (sin, cos) = (-turned.tanh(), 1.0 / turned.cosh());
        // dφ: by the start; by the argument of tanh.
        let angles = [cos / l, -cos * turned / g, cos * turned / c, cos * turned / l];
        for (j, angle) in angles.into_iter().enumerate() {
            let length = if j == 3 { 1.0 } else { 0.0 };
            let exact = [length * cos - l * sin * angle, length * sin + l * cos * angle];
            for (i, exact) in exact.into_iter().enumerate() {
                let size = if j == 2 { c } else { 1.0 };
                let off = (at.q[(i, j)] - exact) * size;
                assert!(off.abs() < 1e-6, "{i} by {} at {t}: {} for {exact}", names[j], at.q[(i, j)]);
            }
        }
    }
}

#[derive(Clone, PartialEq)]
struct Well;

impl Function<1, 1> for Well {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [x.sin() * x + (x * S::constant(0.3)).exp()]
    }
}

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[function(U(x) = well)]
#[lagrangian(m/2*x_dot^2 - k*U(x))]
struct InWell<T> {
    m: T,
    k: T,
    well: Well,
}

#[test]
fn potential_that_the_user_supplies() {
    check_each(&InWell { m: 1.0, k: 2.0, well: Well }, State::new([0.4], [0.2]), 3.0);
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
    for found in [by_pairs.derivatives_at_end().unwrap(), by_series.derivatives_at_end().unwrap()] {
        for (found, expected) in found.q.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "{found} for {expected}");
        }
    }
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

#[test]
fn blade_on_a_body_that_turns_in_space() {
    let (i, [m, n, g, k], [a, b, c, d]) = ([0.5, 0.6, 0.2], [1.0, 0.2, 1.5, 0.9], [0.4, -0.3, 0.2, 0.3]);
    let start = State::new([0.9, 0.3, -0.2, 0.1, 0.2], [0.2, 0.5, 1.0, 2.0, 0.3]);
    check_each(&Suslov { i, m, n, g, k, a, b, c, d }, start, 1.0);
}

/// Numbers near these, by up to 30 %.
fn near<const K: usize>(random: &mut Random, about: [f64; K]) -> [f64; K] {
    about.map(|x| x * random.between(0.7, 1.3))
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

/// Compares derivatives by four arguments with differences, of random systems of a family at the end of motions of 0.5 to 1.5, half
/// of them by Taylor's method. Differences of two steps that disagree decide nothing.
fn campaign<S, const N: usize>(seed: u64, draw: impl Fn(&mut Random) -> (S, State<f64, N>))
where
    S: Linearized<N = Const<N>, Scalar = f64> + Clone,
    Taylor: DifferentiableMethod<S>,
{
    let (mut random, method) = (Random(seed), Dop853::with_tolerance(1e-12));
    let (names, [mut compared, mut unclear]) = (names::<S>(), [0; 2]);
    for case in 0..cases([2, 4, 150]) {
        let (system, start) = draw(&mut random);
        let end = start.t + random.between(0.5, 1.5);
        let Ok((start, _)) = system.make_consistent(&start) else { continue };
        for argument in [0; 4].map(|_| random.below(names.len())) {
            let moved = |by: f64| {
                let end = changed(&system, &start, argument, by).and_then(|(system, start)| {
                    Ok(flat(system.integrate(start, end, method)?.end().state()))
                });
                end.unwrap_or_else(|_| DVector::repeat(2 * N, f64::NAN))
            };
            let [coarse, expected] = [4e-3, 1e-3].map(|step| difference(step, moved));
            let size = expected.amax().max(1e-3);
            let name = [names[argument].as_str()];
            let is_clear = (coarse - &expected).iter().all(|x| x.abs() < 1e-7 * size);
            compared += 1;
            unclear += usize::from(!is_clear);
            let found = if case % 2 == 1 {
                system.integrate_sensitivities(start, end, Taylor::default(), &name)
            } else {
                system.integrate_sensitivities(start, end, method, &name)
            };
            let error = (flow(found.unwrap().derivatives_at_end().unwrap()) - expected).amax() / size;
            assert!(!is_clear || error < 1e-6, "{} {case} by {}: off by {error:e}", S::NAME, name[0]);
        }
    }
    println!("{}: {unclear} of {compared} differences are unclear", S::NAME);
    assert!(compared > 0 && 10 * unclear <= compared, "{unclear} of {compared}");
}
