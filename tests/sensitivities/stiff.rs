//! Derivatives along steps of Radau: those of the map of the steps, and of stiff motions in closed form.

use lagrange_core::nalgebra::{Const, DMatrix, DVector};
use lagrange_core::{linearized::DifferentiableMethod, linearized::StateSensitivity, prelude::*};
use num_dual::Dual64;

use crate::differences::difference;
use crate::{ChaplyginSleigh, DAMPED, SliderCrank, Twice};
use lagrange_random::{Random, cases};

/// Asserts that a motion with derivatives ends where it does without, and takes few more steps.
fn is_as_alone<S, P, const N: usize>(system: &S, start: State<f64, N>, method: P)
where
    S: Linearized<N = Const<N>, Scalar = f64>,
    P: DifferentiableMethod<S> + Copy,
{
    let start = system.make_consistent(&start).unwrap().0;
    let names: Vec<&str> = S::COORDINATES.iter().chain(S::PARAMETERS).copied().collect();
    let with = system.integrate_sensitivities(start, 2.0, method, &names).unwrap();
    let alone = system.integrate(start, 2.0, method).unwrap();
    let off = with.trajectory().end().state().q - alone.end().state().q;
    assert!(off.amax() < 1e-7, "{}: off by {:e}", S::NAME, off.amax());
    let [more, steps] =
        [with.trajectory(), &alone].map(|path| path.statistics().accepted + path.statistics().rejected);
    assert!(more <= steps + steps / 4, "{}: {more} steps, and {steps} without derivatives", S::NAME);
}

#[test]
fn derivatives_take_few_more_steps() {
    let method = Radau::with_tolerance(1e-8);
    is_as_alone(&DAMPED, State::new([1.0], [0.5]), method);
    is_as_alone(&DAMPED, State::new([1.0], [0.5]), method.stages::<7>());
    let crank = SliderCrank { r: 0.3, l: 1.0, crank: 0.2, rod: 1.5, slider: 2.0, k: 1.0, c: 0.4 };
    is_as_alone(&crank, State::new([1.0, -0.25, 1.13], [0.5, 0.0, 0.0]), method.stages::<5>());
    is_as_alone(&Twice { l: 1.3, a: 1.0, b: 1.0 }, State::new([0.5, -1.2], [1.2, 0.5]), method);
    let sleigh = ChaplyginSleigh { m: 1.1, a: 0.4, inertia: 0.3 };
    is_as_alone(&sleigh, State::new([0.0, 0.0, 0.5], [0.8, 0.4, 1.5]), method);
}

/// Two masses on springs, one of them pushed.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + m*y_dot^2)/2 - (x^2 + k*(x - y)^2)/2)]
#[dissipation(c/2*(x_dot + y_dot)^2)]
#[force(y: a*cos(w*t))]
struct Masses<T> {
    m: T,
    k: T,
    c: T,
    a: T,
    w: T,
}

/// Long steps of a linear system, on which Newton's iteration is exact: derivatives are those of the steps, to round-off, not
/// those of the motion.
#[test]
fn derivatives_are_those_of_the_steps() {
    let masses = Masses { m: 0.5, k: 2.0, c: 0.1, a: 1.0, w: 1.3 };
    are_of_the_steps(&masses, Radau::with_tolerance(0.1).first_step(0.25).max_step(0.25), 1e-5);
    let fifth = Radau::with_tolerance(1e-5).stages::<5>();
    are_of_the_steps(&masses, fifth.first_step(0.25).max_step(0.25), 2e-11);
    are_of_the_steps(&masses, RungeKutta4::with_step(0.25), 1e-5);
}

/// `least` is the least error of the steps.
fn are_of_the_steps(masses: &Masses<f64>, method: impl DifferentiableMethod<Masses<f64>> + Copy, least: f64) {
    let (start, end) = (State::new([0.9, -0.4], [0.3, 1.0]), 4.0);
    let names = ["x", "y_dot", "m", "k", "c", "a", "w"];
    let found = masses.integrate_sensitivities(start, end, method, &names).unwrap();
    let exact = masses.integrate_sensitivities(start, end, Taylor::default(), &names).unwrap();
    assert_eq!(found.trajectory().statistics().accepted, 16);
    let column = |at: &StateSensitivity<f64, _>, j: usize| {
        DVector::from_iterator(4, at.q.column(j).iter().chain(&at.v.column(j)).copied())
    };
    // At the end, and within a step.
    for (j, t) in (0..names.len()).flat_map(|j| [(j, end), (j, 2.2)]) {
        let moved = |by: f64| {
            let (mut masses, mut start) = (masses.clone(), start);
            match j {
                0 => start.q[0] += by,
                1 => start.v[1] += by,
                j => assert!(masses.set_parameter(j - 2, masses.parameters()[j - 2] + by)),
            }
            let path = masses.integrate(start, end, method).unwrap();
            assert_eq!(path.statistics().accepted, 16);
            let state = *path.at(t).unwrap().state();
            DVector::from_iterator(4, state.q.iter().chain(&state.v).copied())
        };
        let expected = difference(2e-3, moved);
        let off = (column(&found.at(t).unwrap(), j) - &expected).amax();
        let error = (column(&exact.at(t).unwrap(), j) - &expected).amax();
        println!("by {} at {t}: {off:.1e}, the error of the steps {error:.1e}", names[j]);
        assert!(off < 5e-12 && error > least, "by {} at {t}: {off:e} of {error:e}", names[j]);
    }
}

/// Masses that rest, so that their motion allows any step, or that have little left of a swing, with dampings from none to strong
/// ones. Their derivatives by coordinates are the motions from one coordinate of 1, and their errors, which count by
/// the largest entry, are those of these motions with the tenfold tolerance.
#[test]
fn derivatives_keep_the_tolerance() {
    let count = cases([20, 60, 5_000]);
    let (mut random, mut worst) = (Random(7), [[0.0_f64; 3]; 2]);
    for number in 0..count {
        let mut one = |from: f64, to: f64| random.size(from, to);
        let (m, k, c) = (one(0.1, 10.0), one(0.1, 10.0), one(1e-3, 100.0));
        let masses = Masses { m, k, c, a: 0.0, w: 1.0 };
        let (tolerance, end) = (one(1e-11, 1e-5), one(0.1, 30.0));
        let start = if number % 2 == 0 { [0.0, 0.0] } else { [one(1e-6, 1e-2), -one(1e-6, 1e-2)] };
        let (method, tenfold) = (Radau::with_tolerance(tolerance), Radau::with_tolerance(10.0 * tolerance));
        let found = [
            [derivatives(&masses, start, end, method), motions(&masses, end, tenfold)],
            [
                derivatives(&masses, start, end, method.stages::<5>()),
                motions(&masses, end, tenfold.stages::<5>()),
            ],
            [
                derivatives(&masses, start, end, method.stages::<7>()),
                motions(&masses, end, tenfold.stages::<7>()),
            ],
        ];
        let exact = motions(&masses, end, Taylor::default());
        for (method, found) in found.iter().enumerate() {
            for (worst, found) in worst.iter_mut().zip(found) {
                worst[method] = worst[method].max((found - &exact).amax() / tolerance);
            }
        }
    }
    println!(
        "errors of derivatives and of motions, in units of the tolerance, by 3, 5 and 7 stages: {worst:.0?}"
    );
    assert!((0..3).all(|method| worst[0][method] < 4.0 * worst[1][method]), "{worst:?}");
}

/// Derivatives of the state at the end by the coordinates at the start.
fn derivatives(
    masses: &Masses<f64>,
    q: [f64; 2],
    end: f64,
    method: impl DifferentiableMethod<Masses<f64>>,
) -> DMatrix<f64> {
    let found = masses.integrate_sensitivities(State::at_rest(q), end, method, &["x", "y"]).unwrap();
    let at = found.end().unwrap();
    DMatrix::from_fn(4, 2, |i, j| if i < 2 { at.q[(i, j)] } else { at.v[(i - 2, j)] })
}

/// States at the end of the motions from one coordinate of 1.
fn motions(
    masses: &Masses<f64>,
    end: f64,
    method: impl lagrange_core::motion::Method<Masses<f64>> + Copy,
) -> DMatrix<f64> {
    let ends = [[1.0, 0.0], [0.0, 1.0]].map(|q| {
        let path = masses.integrate(State::at_rest(q), end, method).unwrap();
        *path.end().state()
    });
    DMatrix::from_fn(4, 2, |i, j| if i < 2 { ends[j].q[i] } else { ends[j].v[i - 2] })
}

/// A spring in honey.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k*x^2/2)]
#[dissipation(c/2*x_dot^2)]
struct Slow {
    k: f64,
    c: f64,
}

/// The motion from x and v at time t.
fn slow([x, v, k, c, t]: [Dual64; 5]) -> [Dual64; 2] {
    let fast = -c / 2.0 - (c * c / 4.0 - k).sqrt();
    let slow = k / fast;
    let [a, b] = [(x * fast - v) / (fast - slow), (v - x * slow) / (fast - slow)];
    let [a, b] = [a * (slow * t).exp(), b * (fast * t).exp()];
    [a + b, a * slow + b * fast]
}

#[test]
fn a_spring_in_honey_has_its_closed_derivatives() {
    let (spring, start) = (Slow { k: 1.0, c: 1e6 }, State::new([1.0], [0.3]));
    // From rest, no velocity of the motion itself decays in 10⁻⁶.
    check_slow(&spring, State::at_rest([1.0]), Radau::with_tolerance(1e-7), 1e-7);
    check_slow(&spring, start, Radau::with_tolerance(1e-7), 1e-7);
    check_slow(&spring, start, Radau::with_tolerance(1e-10).stages::<5>(), 1e-10);
    check_slow(&spring, start, Radau::with_tolerance(1e-12).stages::<7>(), 1e-12);
}

/// Compares with the closed form at the end, and within steps to the order of dense output.
fn check_slow<P: DifferentiableMethod<Slow>>(spring: &Slow, start: State<f64, 1>, method: P, tolerance: f64) {
    let names = ["x", "x_dot", "k", "c"];
    let motion = spring.integrate_sensitivities(start, 1e6, method, &names).unwrap();
    let dense = tolerance.powf(0.75);
    for (t, allowed) in
        [(1e-6, dense), (1e-4, dense), (3.0, dense), (1e4, dense), (4e5, dense), (1e6, tolerance)]
    {
        let at = motion.at(t).unwrap();
        for j in 0..4 {
            let mut given = [1.0, start.v[0], 1.0, 1e6, t].map(Dual64::from_re);
            given[j] = given[j].derivative();
            let exact = slow(given).map(|x| x.eps);
            let size = if j == 3 { 1e6 } else { 1.0 };
            let off = ((at.q[(0, j)] - exact[0]).abs() + (at.v[(0, j)] - exact[1]).abs()) * size;
            println!("by {} at {t}: {off:.1e}, tolerance {tolerance:e}", names[j]);
            assert!(off < 30.0 * allowed, "by {} at {t}: {} for {}", names[j], at.q[(0, j)], exact[0]);
        }
    }
}

/// A pendulum in honey on a rod that is there twice.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rod: x^2 + y^2 = l^2)]
#[constraint(again: a*x^2 + b*y^2 = l^2)]
#[dissipation(c/2*(x_dot^2 + y_dot^2))]
struct Rods {
    g: f64,
    c: f64,
    l: f64,
    a: f64,
    b: f64,
}

/// c φ̇ = −g/l cos φ for the angle from the horizontal, but for g/(l c²): sin φ = −tanh(g t/(l c)).
#[test]
fn a_pendulum_in_honey_has_its_closed_derivatives() {
    let (g, c, l, end) = (9.81, 1e6, 1.0, 3e5);
    let rods = Rods { g, c, l, a: 1.0, b: 1.0 };
    let method = Radau::with_tolerance(1e-9).stages::<5>();
    let names = ["y", "g", "c", "l"];
    let motion = rods.integrate_sensitivities(State::at_rest([1.0, 0.0]), end, method, &names).unwrap();
    assert!(motion.trajectory().statistics().accepted < 60, "{:?}", motion.trajectory().statistics());
    for t in [1e4, 1e5, 2.5e5, end] {
        let at = motion.at(t).unwrap();
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

/// The spring in honey crosses ½, at a time that depends on everything.
#[test]
fn a_stiff_motion_ends_at_an_event() {
    let spring = Slow { k: 1.0, c: 1e6 };
    let half = spring.differentiable_event("half", |s| Ok(s.coordinate("x")? - s.number("level", 0.5)));
    let half = half.falling().terminal();
    let start = spring.sensitivity(&State::new([1.0], [0.0]), &["x", "k", "c"]).unwrap();
    let start = start.with(&["level"]).unwrap();
    let method = Radau::with_tolerance(1e-10);
    let motion = spring.motion_with_derivatives(&start).by(method).event(half).towards(1e7).unwrap();
    let end = motion.end().unwrap();
    // t = ln 2 c/k, but for 1/c².
    let (c, ln) = (1e6, std::f64::consts::LN_2);
    assert!((end.state.t - ln * c).abs() < 1e-6 * c);
    for (found, exact) in end.t.iter().zip([c, -ln * c, ln, -2.0 * c]) {
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} for {exact}");
    }
    assert!((0..4).all(|j| (end.q[(0, j)] - if j == 3 { 1.0 } else { 0.0 }).abs() < 1e-12));
}
