//! Steps: how they are chosen, what lies within, where they end, and what goes wrong.

use lagrange_core::{Ending, Method, prelude::*};

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k*x^2/2)]
struct Spring<T> {
    k: T,
}

#[test]
fn equilibria_take_one_step() -> Result<(), Error> {
    let path = Spring { k: 4.0 }.integrate(State::at_rest([0.0]), 1e6, Taylor::default())?;
    assert_eq!((path.statistics().accepted, path.end().coordinate("x")?), (1, 0.0));
    Ok(())
}

#[test]
fn a_step_is_the_series_between_its_ends() -> Result<(), Error> {
    let path = Spring { k: 4.0 }.integrate(State::at_rest([0.3]), 10.0, Taylor::default())?;
    assert!(path.statistics().accepted < 40, "{:?}", path.statistics());
    for i in 0..=1000 {
        let t = f64::from(i) * 0.01;
        let state = *path.at(t)?.state();
        let (x, v) = (0.3 * (2.0 * t).cos(), -0.6 * (2.0 * t).sin());
        assert!((state.q[0] - x).abs() < 2e-15 && (state.v[0] - v).abs() < 4e-15, "at {t}");
    }
    Ok(())
}

#[test]
fn backwards_leads_to_the_start() -> Result<(), Error> {
    let spring = Spring { k: 4.0 };
    let there = *spring.integrate(State::at_rest([0.3]), 10.0, Taylor::default())?.end().state();
    let back = *spring.integrate(there, 0.0, Taylor::default())?.end().state();
    assert!((back.q[0] - 0.3).abs() < 1e-15 && back.v[0].abs() < 2e-15, "{back:?}");
    Ok(())
}

#[test]
fn tolerances_are_kept_with_as_many_orders_as_they_take() -> Result<(), Error> {
    let mut steps = Vec::new();
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12, 1e-15] {
        let method = Taylor::with_tolerance(tolerance);
        let path = Spring { k: 1.0 }.integrate(State::at_rest([1.0]), 10.0, method)?;
        let off = (path.end().coordinate("x")? - 10.0_f64.cos()).abs();
        assert!(off < 10.0 * tolerance, "{tolerance:e}: {off:e}");
        steps.push(path.statistics().accepted);
    }
    assert!(steps.is_sorted_by(|more, fewer| more > fewer), "{steps:?}");
    Ok(())
}

#[test]
fn single_precision_is_as_exact_as_it_is() -> Result<(), Error> {
    let path = Spring { k: 1.0_f32 }.integrate(State::at_rest([1.0]), 10.0, Taylor::default())?;
    let off = (path.end().coordinate("x")? - 10.0_f32.cos()).abs();
    assert!(off < 1e-6, "{off}");
    Ok(())
}

/// ẍ = u with an input that changes, and a state that is set.
#[test]
fn inputs_and_states_can_change() -> Result<(), Error> {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2)]
    #[force(x: u)]
    struct Cart {
        u: f64,
    }
    let mut motion = Motion::new(Cart { u: 2.0 }, State::at_rest([0.0]), Taylor::default())?;
    assert_eq!(motion.advance_to(1.0), Ok(()));
    motion.system_mut().u = -2.0;
    assert_eq!(motion.advance_to(2.0), Ok(()));
    let State { q, v, .. } = motion.state();
    assert!((q[0] - 2.0).abs() <= 2.0 * f64::EPSILON && v[0].abs() <= 2.0 * f64::EPSILON, "{q} {v}");
    motion.set_state(State { t: 5.0, ..State::at_rest([1.0]) })?;
    assert_eq!(motion.advance_to(6.0), Ok(()));
    let State { q, v, .. } = motion.state();
    assert!(q[0].abs() <= 2.0 * f64::EPSILON && (v[0] + 2.0).abs() <= 2.0 * f64::EPSILON, "{q} {v}");
    Ok(())
}

#[test]
fn events_are_found_on_the_series() -> Result<(), Error> {
    let spring = Spring { k: 1.0 };
    let mut crossing = spring.event("through the middle", |sample| sample.coordinate("x"));
    let path =
        spring.motion(State::at_rest([1.0])).by(Taylor::default()).event(&mut crossing).towards(100.0)?;
    let times: Vec<f64> = path.crossings().iter().map(|crossing| crossing.state.t).collect();
    assert_eq!(times.len(), 32);
    for (k, time) in times.iter().enumerate() {
        let expected = std::f64::consts::PI * (k as f64 + 0.5);
        assert!((time - expected).abs() < 4e-16 * 100.0, "{time} {expected}");
    }
    Ok(())
}

/// A mass that falls into a centre: the time ends there.
#[test]
fn a_collision_ends_the_motion_with_its_time() {
    #[derive(Lagrangian)]
    #[coordinates(r)]
    #[lagrangian(r_dot^2/2 + 1/r)]
    struct Fall;
    // From rest at r = 1 it takes π/√8.
    let result = Fall.integrate(State::at_rest([1.0]), 2.0, Taylor::default());
    let Err(Error::Unfinished(ending)) = result else { panic!("{result:?}") };
    let off = ending.time() - std::f64::consts::PI / 8.0_f64.sqrt();
    assert!(off.abs() < 1e-9, "{ending:?}");
}

#[test]
fn settings_that_cannot_work_are_refused() {
    let start = State::at_rest([1.0]);
    for method in [
        Taylor::with_tolerance(0.0),
        Taylor::default().max_step(-1.0),
        Taylor::default().relative_tolerance(f64::NAN),
    ] {
        let error = Spring { k: 1.0 }.integrate(start, 1.0, method).err();
        assert!(matches!(error, Some(Error::Setting { .. })), "{error:?}");
    }
    let mut text = String::new();
    Method::<Spring<f64>>::identify(&Taylor::default(), &mut text).expect("a string takes all");
    assert!(text.starts_with("Taylor"));
}

#[test]
fn a_limit_on_steps_keeps_what_was_computed() -> Result<(), Error> {
    let spring = Spring { k: 1.0 };
    let method = Taylor::default().max_steps(10);
    let path = spring.motion(State::at_rest([1.0])).by(method).towards(1e6)?;
    assert!(matches!(path.ending(), Ending::StepLimit { steps: 10, .. }), "{:?}", path.ending());
    let last = path.end();
    assert!((last.coordinate("x")? - last.time().cos()).abs() < 1e-14);
    Ok(())
}

/// m v̇ = −m g − c v √v² upwards and down: v = w tan(φ₀ − g t/w) to the top, then −w tanh(g t/w), with w = √(m g/c).
#[test]
fn drag_by_the_root_of_a_square_turns_with_the_velocity() -> Result<(), Error> {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - g*x)]
    #[force(x: -c * x_dot * sqrt(x_dot^2))]
    struct Thrown {
        g: f64,
        c: f64,
    }
    let (g, c, v) = (9.81, 0.7, 3.0_f64);
    let terminal = (g / c).sqrt();
    let up = terminal / g * (v / terminal).atan();
    let thrown = Thrown { g, c };
    let path = thrown.motion(State::new([0.0], [v])).by(Taylor::default()).towards(2.0)?;
    let expected = -terminal * (g * (2.0 - up) / terminal).tanh();
    let off = (path.end().velocity("x")? - expected).abs();
    assert!(off < 4e-14, "{off:e} {:?} {:?}", path.ending(), path.statistics());
    Ok(())
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

/// A potential |sin x|, by no even power that one could see: about the kink its root is rounding errors.
#[test]
fn a_kink_that_numbers_do_not_resolve_ends_the_motion() -> Result<(), Error> {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - sqrt(1 - cos(x)^2))]
    struct Valley;
    let path = Valley.motion(State::at_rest([1.0])).by(Taylor::default()).towards(20.0)?;
    let end = path.end();
    let (x, v) = (end.coordinate("x")?, end.velocity("x")?);
    let off = v * v / 2.0 + x.sin().abs() - 1.0_f64.sin();
    assert!(matches!(path.ending(), Ending::NotFinite { .. }) && x.abs() < 1e-7, "{:?}", path.ending());
    assert!(off.abs() < 1e-8, "{off:e}");
    Ok(())
}

/// A motion that has left the domain of its equations is set back into it.
#[test]
fn what_was_no_number_is_forgotten() -> Result<(), Error> {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 + x^(3/2))]
    struct Slope;
    let mut motion = Motion::new(Slope, State::new([1.0], [-1.0]), Taylor::default())?;
    for _ in 0..3 {
        motion.set_state(State::new([0.0], [-1.0]))?;
        assert!(motion.advance_to(1.0).is_err());
        motion.set_state(State::new([1.0], [2.0 / 5.0_f64.sqrt()]))?;
        assert_eq!(motion.advance_to(0.5), Ok(()));
        let state = motion.state();
        let off = state.v[0].powi(2) / 2.0 - state.q[0].powf(1.5) - (0.4 - 1.0);
        assert!(off.abs() < 1e-14, "{off:e}");
    }
    Ok(())
}
