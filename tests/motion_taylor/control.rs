//! Steps: how they are chosen, what lies within, where they end, and what goes wrong.

use std::f64::consts::TAU;

use lagrange_core::{Method, prelude::*};
use lagrange_systems::{DrivenSpring, Planet, Spring};

use super::SPRING;

const STIFF: Spring<f64> = Spring { m: 1.0, k: 4.0 };

#[test]
fn equilibria_take_one_step() -> Result<(), Error> {
    let path = STIFF.integrate(State::at_rest([0.0]), 1e6, Taylor::default())?;
    assert_eq!((path.statistics().accepted, path.end().coordinate("x")?), (1, 0.0));
    Ok(())
}

#[test]
fn a_step_is_the_series_between_its_ends() -> Result<(), Error> {
    let path = STIFF.integrate(State::at_rest([0.3]), 10.0, Taylor::default())?;
    assert!(path.statistics().accepted < 40, "{:?}", path.statistics());
    for i in 0..=1000 {
        let t = f64::from(i) * 0.01;
        let state = *path.at(t)?.state();
        let (x, v) = (0.3 * (2.0 * t).cos(), -0.6 * (2.0 * t).sin());
        assert!((state.q[0] - x).abs() < 2e-15 && (state.v[0] - v).abs() < 4e-15, "at {t}");
    }
    let back = *STIFF.integrate(*path.end().state(), 0.0, Taylor::default())?.end().state();
    assert!((back.q[0] - 0.3).abs() < 1e-15 && back.v[0].abs() < 2e-15, "{back:?}");
    Ok(())
}

#[test]
fn tolerances_are_kept_with_as_many_orders_as_they_take() -> Result<(), Error> {
    let mut steps = Vec::new();
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
        let method = Taylor::with_tolerance(tolerance);
        let path = SPRING.integrate(State::at_rest([1.0]), 10.0, method)?;
        let off = (path.end().coordinate("x")? - 10.0_f64.cos()).abs();
        assert!(off < 10.0 * tolerance, "{tolerance:e}: {off:e}");
        steps.push(path.statistics().accepted);
    }
    assert!(steps.is_sorted_by(|more, fewer| more > fewer), "{steps:?}");
    Ok(())
}

#[test]
fn single_precision_is_as_exact_as_it_is() -> Result<(), Error> {
    let path = Spring { m: 1.0_f32, k: 1.0 }.integrate(State::at_rest([1.0]), 10.0, Taylor::default())?;
    let off = (path.end().coordinate("x")? - 10.0_f32.cos()).abs();
    assert!(off < 1e-6, "{off}");
    Ok(())
}

/// ẍ = u with an input that changes, and a state that is set.
#[test]
fn inputs_and_states_can_change() -> Result<(), Error> {
    let cart = DrivenSpring { m: 1.0, k: 0.0, c: 0.0, a: 2.0, w: 0.0 };
    let mut motion = Motion::new(cart, State::at_rest([0.0]), Taylor::default())?;
    assert_eq!(motion.advance_to(1.0), Ok(()));
    motion.system_mut().a = -2.0;
    assert_eq!(motion.advance_to(2.0), Ok(()));
    let State { q, v, .. } = motion.state();
    assert!((q[0] - 2.0).abs() <= 2.0 * f64::EPSILON && v[0].abs() <= 2.0 * f64::EPSILON, "{q} {v}");
    motion.set_state(State { t: 5.0, ..State::at_rest([1.0]) })?;
    assert_eq!(motion.advance_to(6.0), Ok(()));
    let State { q, v, .. } = motion.state();
    assert!(q[0].abs() <= 2.0 * f64::EPSILON && (v[0] + 2.0).abs() <= 2.0 * f64::EPSILON, "{q} {v}");
    Ok(())
}

/// A mass that falls into a centre: the time ends there.
#[test]
fn a_collision_ends_the_motion_with_its_time() {
    // From rest at r = 1 it takes π/√8.
    let result = Planet { mu: 1.0 }.integrate(State::at_rest([1.0, 0.0]), 2.0, Taylor::default());
    let Err(Error::Unfinished(ending)) = result else { panic!("{result:?}") };
    let off = ending.time() - std::f64::consts::PI / 8.0_f64.sqrt();
    assert!(off.abs() < 1e-9, "{ending:?}");
}

#[test]
fn a_longest_step_that_cannot_work_is_refused() {
    let error = SPRING.integrate(State::at_rest([1.0]), 1.0, Taylor::default().max_step(-1.0)).err();
    assert!(matches!(error, Some(Error::Setting { .. })), "{error:?}");
    let mut text = String::new();
    Method::<Spring<f64>>::identify(&Taylor::default(), &mut text).expect("a string takes all");
    assert!(text.starts_with("Taylor"));
}

/// ẍ = |(t − 1)² − d²|, which is negative without the bars between 1 − d and 1 + d only, well within a step.
#[test]
fn a_root_that_comes_down_to_zero_twice_in_a_step_is_seen() -> Result<(), Error> {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 + x * sqrt(((t - 1)^2 - d^2)^2))]
    struct Driven {
        d: f64,
    }
    for d in [0.3, 1e-2, 1e-3] {
        let driven = Driven { d };
        let path = driven.motion(State::at_rest([0.0])).by(Taylor::default()).towards(3.0)?;
        // ∫|s² − d²| from −1 to 2 is that without bars and twice the part that is negative.
        let expected = (8.0 + 1.0) / 3.0 - 3.0 * d * d + 2.0 * (4.0 / 3.0) * d.powi(3);
        let off = (path.end().velocity("x")? - expected).abs();
        assert!(off < 4e-14, "{d}: {off:e} {:?} {:?}", path.ending(), path.statistics());
    }
    Ok(())
}

/// A pulse in time.
#[derive(Lagrangian, Clone)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k*x^2/2)]
#[force(x: a*exp(-(t - c)^2/(2*w^2)))]
pub(crate) struct Pulse<T> {
    pub(crate) k: T,
    pub(crate) a: T,
    pub(crate) c: T,
    pub(crate) w: T,
}

/// No step passes over a force that is nothing where it begins: the acceleration at the start is 3.5·10⁻¹⁹⁶.
#[test]
fn a_start_far_before_a_pulse() -> Result<(), Error> {
    let pulse = Pulse { k: 0.0, a: 1.0, c: 1.5, w: 0.05 };
    let path = pulse.integrate(State::at_rest([0.0]), 3.0, Taylor::default())?;
    assert!((path.end().state().v[0] / (0.05 * TAU.sqrt()) - 1.0).abs() < 1e-12);
    Ok(())
}

/// A motion that is taken up again step by step sees it too: what the last step saw counts.
#[test]
fn a_pulse_after_many_short_steps() -> Result<(), Error> {
    let mut motion =
        Motion::new(Pulse { k: 0.0, a: 1.0, c: 9.0, w: 0.05 }, State::at_rest([0.0]), Taylor::default())?;
    for k in 1..=100 {
        assert_eq!(motion.advance_to(f64::from(k) * 0.01), Ok(()));
    }
    assert_eq!(motion.advance_to(12.0), Ok(()));
    assert!((motion.state().v[0] / (0.05 * TAU.sqrt()) - 1.0).abs() < 1e-9, "{}", motion.state());
    Ok(())
}
