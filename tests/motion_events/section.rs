//! Poincaré sections.

use lagrange_core::{Crossing, Dop853, nalgebra::Const, prelude::*};
use lagrange_random::cases;
use lagrange_systems::HenonHeiles;

/// On x = 0 with the energy 1/12, where motions are regular.
fn start() -> State<f64, 2> {
    let (y, y_dot) = (0.1_f64, 0.1_f64);
    let kinetic = 1.0 / 12.0 - (y * y / 2.0 - y.powi(3) / 3.0) - y_dot * y_dot / 2.0;
    State::new([0.0, y], [(2.0 * kinetic).sqrt(), y_dot])
}

fn end() -> f64 {
    cases([100, 1_000, 1_000]) as f64
}

/// The crossings until the end, in both directions.
fn section(method: Dop853) -> Vec<Crossing<f64, Const<2>>> {
    let mut event = HenonHeiles.event("section", |s| s.state().q[0]);
    let path = HenonHeiles.motion(start()).by(method).event(&mut event).towards(end()).expect("a start");
    path.crossings().to_vec()
}

#[test]
fn every_crossing_is_found_and_is_one() {
    let method = Dop853::with_tolerance(1e-12).max_steps(1_000_000);
    let (found, fine) = (section(method), section(method.max_step(0.015)));
    assert!(
        found.len() as f64 > 0.3 * end() && found.len() == fine.len(),
        "{} and {}",
        found.len(),
        fine.len()
    );
    for (k, (one, other)) in found.iter().zip(&fine).enumerate() {
        assert!((one.state.t - other.state.t).abs() < 1e-8 && one.rising == (k % 2 == 1));
        // x is the difference of terms of the size that it has within the step, about 0.05.
        assert!(one.state.q[0].abs() <= 8.0 * f64::EPSILON * 0.05, "{:e}", one.state.q[0]);
    }
}

/// Also where the time is counted from so far away that two numbers are a microsecond apart.
#[test]
fn the_function_is_zero_though_the_time_is_coarse() {
    let (from, method) = (1.7e9, Dop853::with_tolerance(1e-12));
    let mut event = HenonHeiles.event("section", |s| s.state().q[0]).rising();
    let mut motion = Motion::new(&HenonHeiles, start().at_time(from), method).unwrap();
    for _ in 0..20 {
        let crossing =
            motion.advance_to_event(from + 1e3, &mut [&mut event]).unwrap().expect("it comes back");
        assert!(crossing.state.q[0].abs() < 1e-16 && crossing.state == *motion.state());
    }
}

#[test]
fn an_iterator_gives_the_crossings_alone() {
    let method = Dop853::with_tolerance(1e-12);
    let mut event = HenonHeiles.event("section", |s| s.state().q[0]);
    let mut motion = Motion::new(&HenonHeiles, start(), method).unwrap();
    let found: Result<Vec<_>, _> = motion.crossings(end(), &mut [&mut event]).collect();
    assert_eq!(found.unwrap(), section(method));
    assert_eq!(motion.state().t, end());
    // The first error is the last item.
    let mut event = HenonHeiles.event("root", |s| s.state().q[0].sqrt());
    let mut motion = Motion::new(&HenonHeiles, start(), method).unwrap();
    let found: Vec<_> = motion.crossings(end(), &mut [&mut event]).collect();
    assert!(found.len() == 1 && found[0].is_err());
}
