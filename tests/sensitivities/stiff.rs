//! Derivatives along steps of Radau: those of the map of the steps, and of stiff motions in closed form.

use lagrange_core::nalgebra::Const;
use lagrange_core::{linearized::DifferentiableMethod, motion::Method, prelude::*};
use lagrange_random::{Random, cases};
use lagrange_systems::DrivenSpring;
use num_dual::Dual64;

use crate::DAMPED;
use crate::differences::{changed, difference, flat, flow, names};

/// Asserts that a motion with derivatives ends where it does without, and takes few more steps.
pub(crate) fn is_as_alone<S, P, const N: usize>(system: &S, start: State<f64, N>, method: P)
where
    S: Linearized<N = Const<N>, Scalar = f64>,
    P: DifferentiableMethod<S> + Copy,
{
    let start = system.make_consistent(&start).unwrap().0;
    let names: Vec<&str> = S::COORDINATES.iter().chain(S::PARAMETERS).copied().collect();
    let with = system.integrate_sensitivities(start, 2.0, method, &names).unwrap();
    let alone = system.integrate(start, 2.0, method).unwrap();
    let off = with.end().state().q - alone.end().state().q;
    assert!(off.amax() < 1e-7, "{}: off by {:e}", S::NAME, off.amax());
    let [more, steps] = [&*with, &alone].map(|path| path.statistics().accepted + path.statistics().rejected);
    assert!(more <= steps + steps / 4, "{}: {more} steps, and {steps} without derivatives", S::NAME);
}

#[test]
fn derivatives_take_few_more_steps() {
    is_as_alone(&DAMPED, State::new([1.0], [0.5]), Radau::with_tolerance(1e-8));
}

/// Long steps of a linear system, on which Newton's iteration is exact: derivatives are those of the steps, to round-off, not
/// those of the motion.
#[test]
fn derivatives_are_those_of_the_steps() {
    are_of_the_steps(Radau::with_tolerance(0.1).first_step(0.25).max_step(0.25), 1e-5);
    are_of_the_steps(Radau::with_tolerance(1e-5).stages::<5>().first_step(0.25).max_step(0.25), 1e-11);
    are_of_the_steps(RungeKutta4::with_step(0.25), 1e-5);
}

/// `least` is the least error of the steps.
fn are_of_the_steps(method: impl DifferentiableMethod<DrivenSpring<f64>> + Copy, least: f64) {
    let spring = DrivenSpring { m: 0.5, k: 2.0, c: 0.1, a: 1.0, w: 1.3 };
    let (start, end, names) = (State::new([0.9], [0.3]), 4.0, names::<DrivenSpring<f64>>());
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let found = spring.integrate_sensitivities(start, end, method, &names).unwrap();
    let exact = spring.integrate_sensitivities(start, end, Taylor::default(), &names).unwrap();
    assert_eq!(found.statistics().accepted, 16);
    // At the end, and within a step.
    for (j, t) in (0..names.len()).flat_map(|j| [(j, end), (j, 2.2)]) {
        let expected = difference(2e-3, |by| {
            let (spring, start) = changed(&spring, &start, j, by).unwrap();
            let path = spring.integrate(start, end, method).unwrap();
            assert_eq!(path.statistics().accepted, 16);
            flat(path.at(t).unwrap().state())
        });
        let [off, error] = [&found, &exact]
            .map(|motion| (flow(&motion.derivatives_at(t).unwrap()).column(j) - &expected).amax());
        println!("by {} at {t}: {off:.1e}, the error of the steps {error:.1e}", names[j]);
        assert!(off < 1e-12 && error > least, "by {} at {t}: {off:e} of {error:e}", names[j]);
    }
}

/// A mass that rests, so that its motion allows any step, or that has little left of a swing, with dampings from none to strong
/// ones. Its derivatives by x are the motion from x = 1, and their errors are those of this motion with the tenfold tolerance.
#[test]
fn derivatives_keep_the_tolerance() {
    let (mut random, mut worst) = (Random(7), [[0.0_f64; 3]; 2]);
    for number in 0..cases([20, 60, 5_000]) {
        let mut one = |from: f64, to: f64| random.size(from, to);
        let spring =
            DrivenSpring { m: one(0.1, 10.0), k: one(0.1, 10.0), c: one(1e-3, 100.0), a: 0.0, w: 0.0 };
        let (tolerance, end) = (one(1e-11, 1e-5), one(0.1, 30.0));
        let start = State::at_rest([if number % 2 == 0 { 0.0 } else { one(1e-6, 1e-2) }]);
        let exact = moved(&spring, end, Taylor::default());
        let (method, tenfold) = (Radau::with_tolerance(tolerance), Radau::with_tolerance(10.0 * tolerance));
        let found = [
            [by_x(&spring, start, end, method), moved(&spring, end, tenfold)],
            [by_x(&spring, start, end, method.stages::<5>()), moved(&spring, end, tenfold.stages::<5>())],
            [by_x(&spring, start, end, method.stages::<7>()), moved(&spring, end, tenfold.stages::<7>())],
        ];
        for (stages, found) in found.iter().enumerate() {
            for (worst, found) in worst.iter_mut().zip(found) {
                let off = (found[0] - exact[0]).abs().max((found[1] - exact[1]).abs());
                worst[stages] = worst[stages].max(off / tolerance);
            }
        }
    }
    println!(
        "errors of derivatives and of motions, in units of the tolerance, by 3, 5 and 7 stages: {worst:.0?}"
    );
    assert!((0..3).all(|stages| worst[0][stages] < 4.0 * worst[1][stages]), "{worst:?}");
}

/// Derivative of the state at the end by x at the start.
fn by_x(
    spring: &DrivenSpring<f64>,
    start: State<f64, 1>,
    end: f64,
    method: impl DifferentiableMethod<DrivenSpring<f64>>,
) -> [f64; 2] {
    let found = spring.integrate_sensitivities(start, end, method, &["x"]).unwrap();
    let at = found.derivatives_at_end().unwrap();
    [at.q[0], at.v[0]]
}

/// State at the end of the motion from x = 1.
fn moved(spring: &DrivenSpring<f64>, end: f64, method: impl Method<DrivenSpring<f64>>) -> [f64; 2] {
    let state = *spring.integrate(State::at_rest([1.0]), end, method).unwrap().end().state();
    [state.q[0], state.v[0]]
}

/// A spring in honey.
const HONEY: DrivenSpring<f64> = DrivenSpring { m: 1.0, k: 1.0, c: 1e6, a: 0.0, w: 0.0 };

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
    let start = State::new([1.0], [0.3]);
    // From rest, no velocity of the motion itself decays in 10⁻⁶.
    check_slow(State::at_rest([1.0]), Radau::with_tolerance(1e-7), 1e-7);
    check_slow(start, Radau::with_tolerance(1e-7), 1e-7);
    check_slow(start, Radau::with_tolerance(1e-10).stages::<5>(), 1e-10);
    check_slow(start, Radau::with_tolerance(1e-12).stages::<7>(), 1e-12);
}

/// Compares with the closed form at the end, and within steps to the order of dense output.
fn check_slow<P: DifferentiableMethod<DrivenSpring<f64>>>(start: State<f64, 1>, method: P, tolerance: f64) {
    let names = ["x", "x_dot", "k", "c"];
    let motion = HONEY.integrate_sensitivities(start, 1e6, method, &names).unwrap();
    let dense = tolerance.powf(0.75);
    for (t, allowed) in
        [(1e-6, dense), (1e-4, dense), (3.0, dense), (1e4, dense), (4e5, dense), (1e6, tolerance)]
    {
        let at = motion.derivatives_at(t).unwrap();
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

/// The spring in honey crosses ½, at a time that depends on everything.
#[test]
fn a_stiff_motion_ends_at_an_event() {
    let half = HONEY.differentiable_event("half", |s| Ok(s.coordinate("x")? - s.number("level", 0.5)));
    let half = half.falling().terminal();
    let start = HONEY.sensitivity(&State::new([1.0], [0.0]), &["x", "k", "c"]).unwrap();
    let start = start.with(&["level"]).unwrap();
    let method = Radau::with_tolerance(1e-10);
    let motion = HONEY.motion_with_derivatives(&start).by(method).event(half).towards(1e7).unwrap();
    let end = motion.derivatives_at_end().unwrap();
    // t = ln 2 c/k, but for 1/c².
    let (c, ln) = (1e6, std::f64::consts::LN_2);
    assert!((end.state.t - ln * c).abs() < 1e-6 * c);
    for (found, exact) in end.t.iter().zip([c, -ln * c, ln, -2.0 * c]) {
        assert!((found / exact - 1.0).abs() < 1e-6, "{found} for {exact}");
    }
    assert!((0..4).all(|j| (end.q[(0, j)] - if j == 3 { 1.0 } else { 0.0 }).abs() < 1e-12));
}
