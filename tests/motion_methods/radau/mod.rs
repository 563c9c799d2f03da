//! Radau IIA: its order, stiff systems with and without constraints, redundant constraints, and what goes wrong. Broken input
//! of all kinds is in `motion_control/faults`.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

// Three, five and seven stages, each of which the compiler makes for each system.
#[cfg(feature = "thorough")]
mod order;
#[cfg(feature = "thorough")]
mod poses;
#[cfg(feature = "thorough")]
mod stages;

use lagrange_core::{StateDerivatives, prelude::*};
use lagrange_systems::DrivenSpring;

fn off<const N: usize>(state: &State<f64, N>, exact: &State<f64, N>) -> f64 {
    (state.q - exact.q).amax().max((state.v - exact.v).amax())
}

/// A crank that a motor turns at a constant rate: no freedom is left.
#[derive(Clone, Lagrangian)]
#[coordinates(crank, rod, slider)]
#[lagrangian(crank_dot^2/2 + rod_dot^2/3 + cos(crank - rod)*crank_dot*rod_dot/4 + slider_dot^2/2)]
#[constraint(height: sin(crank)/2 + sin(rod) = 0)]
#[constraint(length: slider - cos(crank)/2 - cos(rod) = 0)]
#[constraint(motor: crank - 3*t = 0)]
struct Crank;

#[test]
fn a_motion_without_freedom_follows_its_constraints() {
    let (start, _) = Crank.make_consistent(&State::at_rest([0.0, 0.0, 1.5])).unwrap();
    let path = Crank.integrate(start, 5.0, Radau::default()).unwrap();
    for sample in path.samples(50) {
        let crank = 3.0 * sample.time();
        let rod = -(crank.sin() / 2.0).asin();
        let exact = [crank, rod, crank.cos() / 2.0 + rod.cos()];
        assert!(
            (0..3).all(|i| (sample.state().q[i] - exact[i]).abs() < 1e-6),
            "{:?} at {crank}",
            sample.state()
        );
    }
    let exact = Crank.integrate(start, 5.0, Dop853::default()).unwrap();
    for name in ["height", "length", "motor"] {
        let [found, exact] = [&path, &exact].map(|path| path.end().multiplier(name).unwrap());
        assert!((found - exact).abs() < 1e-7, "{name}");
    }
}

/// A spring in honey, let go at 1.
fn slow(c: f64) -> (DrivenSpring<f64>, impl Fn(f64) -> State<f64, 1>) {
    let fast = -c / 2.0 - (c * c / 4.0 - 1.0).sqrt();
    let slow = 1.0 / fast;
    let [a, b] = [fast / (fast - slow), -slow / (fast - slow)];
    let exact = move |t: f64| {
        let (x, y) = (a * (slow * t).exp(), b * (fast * t).exp());
        State::new([x + y], [slow * x + fast * y]).at_time(t)
    };
    (DrivenSpring { m: 1.0, k: 1.0, c, a: 0.0, w: 0.0 }, exact)
}

#[test]
fn stiff_damping_takes_few_steps() {
    let (spring, exact) = slow(1e6);
    for (tolerance, steps) in [(1e-6, 30), (1e-9, 50), (1e-12, 150)] {
        let path = spring.integrate(State::at_rest([1.0]), 1e6, Radau::with_tolerance(tolerance)).unwrap();
        assert!(off(path.end().state(), &exact(1e6)) < tolerance.max(1e-12), "{tolerance}");
        assert!(path.statistics().accepted < steps, "{:?}", path.statistics());
        // Dense output, from the steep start on.
        for t in [1e-5, 1e-2, 10.0, 3e3, 7e5] {
            let error = off(path.at(t).unwrap().state(), &exact(t));
            assert!(error < 30.0 * tolerance.powf(0.75), "{error:e} at {t}, tolerance {tolerance}");
        }
    }
    // Backwards in time the spring flees from its end, and is followed.
    let path = spring.integrate(exact(2e-6), 0.0, Radau::default()).unwrap();
    let back = off(path.end().state(), &exact(0.0));
    assert!(back < 1e-7, "{back:e}");
}

#[test]
fn wrong_settings_are_refused_and_round_off_ends() {
    let (spring, _) = slow(3.0);
    let start = State::at_rest([1.0]);
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for method in [
            Radau::with_tolerance(wrong),
            Radau::default().max_step(wrong),
            Radau::default().first_step(wrong),
            Radau::default().absolute_tolerance(wrong),
        ] {
            assert!(matches!(spring.integrate(start, 1.0, method), Err(Error::Setting { .. })));
        }
    }
    // A tolerance below round-off comes to an end, one way or the other.
    let path = spring.motion(start).by(Radau::with_tolerance(1e-16)).towards(1.0).unwrap();
    let exact = spring.integrate(start, path.end().time(), Dop853::with_tolerance(1e-14)).unwrap();
    assert!(off(path.end().state(), exact.end().state()) < 1e-11);
}

/// Friction that grows with the distance: its derivative jumps at x = 0, and has no value there.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[force(x: -abs(x)/2)]
struct Kinked;

impl Kinked {
    /// The motion through 0 at t = 0 at speed 1, until it returns a second time: frequencies √(3/2) and √(1/2).
    fn at(t: f64) -> State<f64, 1> {
        let (right, left) = (1.5_f64.sqrt(), 0.5_f64.sqrt());
        let back = t - std::f64::consts::PI / right;
        let (sign, w, t) = if back < 0.0 { (1.0, right, t) } else { (-1.0, left, back) };
        State::new([sign * (w * t).sin() / w], [sign * (w * t).cos()])
    }
}

#[test]
fn a_kink_is_passed_at_the_start_and_on_the_way() {
    let start = State::new([0.0], [1.0]);
    assert!(matches!(Kinked.state_jacobian(&start), Err(Error::DerivativeNotFinite { .. })));
    let path = Kinked.motion(start).by(Radau::default()).towards(7.0).unwrap().finished().unwrap();
    assert!(path.statistics().rejected < 50, "{:?}", path.statistics());
    // A step across a kink has an error of third order, of which 10⁻⁷ is allowed at this tolerance, and there are two.
    for step in path.steps() {
        let error = off(step.state(), &Kinked::at(step.time()));
        assert!(error < 1e-6, "{error:e} at {}", step.time());
    }
    // A stop on the kink, in the middle of the motion, and one that rests there.
    let mut motion = Motion::new(Kinked, State::new([0.5], [0.0]), Radau::default()).unwrap();
    motion.advance_to(1.0).unwrap();
    motion.set_state(start.at_time(1.0)).unwrap();
    motion.advance_to(3.0).unwrap();
    assert!(off(motion.state(), &Kinked::at(2.0)) < 1e-6 && motion.statistics().rejected < 50);
    let path = Kinked.integrate(State::at_rest([0.0]), 5.0, Radau::default()).unwrap();
    assert_eq!(path.end().state().q[0], 0.0);
}

/// A force whose derivative is not finite on a whole side.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[force(x: max(x, 0)^(3/2)*sqrt(max(-x, 0)))]
struct Flat;

#[test]
fn derivatives_that_are_not_finite_end_the_motion_at_once() {
    let path = Flat.motion(State::new([0.5], [0.0])).by(Radau::default()).towards(1.0).unwrap();
    let named = path.ending().to_string();
    assert!(named.contains("derivative") && named.contains('x'), "{named}");
    assert_eq!(path.statistics().rejected, 0);
}
