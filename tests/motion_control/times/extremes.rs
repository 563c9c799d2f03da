//! Spans and starts near the ends of the numbers.

use lagrange_core::{Ending, motion::Progress, prelude::*};

use crate::times::{allowed, exact};
use crate::{spring_of, stop_if};

#[test]
fn spans_of_all_sizes_are_integrated() {
    // Velocities are about ω: their squares and those of ω are numbers.
    for exponent in [-150, -100, -12, 12, 100, 150] {
        let scale = 10_f64.powi(exponent);
        let (omega, end) = (1.0 / scale, 20.0 * scale);
        let spring = spring_of(omega);
        let method = Dop853::default().absolute_tolerance(1e-9 * omega.min(1.0));
        let path = spring.integrate(State::at_rest([1.0]), end, method).unwrap();
        assert_eq!(*path.ending(), Ending::Complete { time: end });
        let off = path.end().coordinate("x").unwrap() - exact(omega, 0.0, end);
        assert!(off.abs() <= allowed(path.statistics().accepted, 1e-9), "{scale:e}: off by {off:e}");
        assert!(path.statistics().rejected <= 10, "{scale:e}: {:?}", path.statistics());
    }
}

#[test]
fn spans_of_all_sizes_are_integrated_in_single_precision() {
    for scale in [1e-18_f32, 1e-15, 1e-9, 1e9, 1e15, 1e18] {
        let (omega, end) = (1.0 / scale, 20.0 * scale);
        let spring = spring_of(omega);
        let method = Dop853::with_tolerance(1e-5).absolute_tolerance(1e-5 * f64::from(omega.min(1.0)));
        let path = spring.integrate(State::at_rest([1.0]), end, method).unwrap();
        assert!(path.ending().is_complete(), "{}", path.ending());
        let off =
            f64::from(path.end().coordinate("x").unwrap()) - exact(f64::from(omega), 0.0, f64::from(end));
        assert!(off.abs() <= allowed(path.statistics().accepted, 1e-5), "{scale:e}: off by {off:e}");
        assert!(path.statistics().rejected <= 10, "{scale:e}: {:?}", path.statistics());
    }
}

#[test]
fn a_free_body_goes_anywhere_in_time() {
    let most = f64::MAX;
    for (start, end) in [
        (0.0, 1e-300),
        (0.0, 1e-320),
        (0.0, 5e-324),
        (-5e-324, 5e-324),
        (1e-300, 2e-300),
        (0.0, 1e300),
        (0.0, most),
        (1e308, 1.5e308),
        (-1.5e308, -1e308),
        (-1e308, 1.5e308),
        (-most, most),
        (1.0, 1.0 + f64::EPSILON),
        (most * (1.0 - f64::EPSILON), most),
    ] {
        for v in [0.0, 1e-10, 1.0] {
            let start_state = State::new([1.0], [v]).at_time(start);
            let free = spring_of(0.0);
            let path = match free.integrate(start_state, end, Dop853::default()) {
                // x overflows on the way
                Err(Error::Unfinished(_)) if v == 1.0 && end - start > 1e307 => continue,
                path => path.unwrap(),
            };
            assert_eq!(*path.ending(), Ending::Complete { time: end }, "from {start:e}, v = {v}");
            let expected = 1.0 + (v * (end / 2.0 - start / 2.0)) * 2.0;
            let off = (path.end().coordinate("x").unwrap() / expected - 1.0).abs();
            assert!(off < 1e-13, "from {start:e} to {end:e} with {v}: off by {off:e}");
            assert!(path.statistics().accepted < 5000 && path.statistics().rejected < 5);
            let times: Vec<f64> = path.steps().map(|step| step.time()).collect();
            assert!(times.is_sorted_by(|a, b| a < b));
            assert!(path.samples(11).count() == 11 && path.samples(11).all(|s| s.state().q[0].is_finite()));
            let table = path.csv(5).to_string();
            let is_finite = !table.contains("NaN") && !table.contains("inf");
            assert!(is_finite && table.lines().count() == 6, "{table}");
        }
    }
}

#[test]
fn nothing_but_the_start_is_left_of_no_span() {
    for t in [0.0, -0.0, 1.7e9, f64::MAX, f64::MIN, 5e-324] {
        let spring = spring_of(1.0);
        for method in
            [Dop853::default(), Dop853::default().max_step(1e-30), Dop853::default().fixed_step(1.0)]
        {
            let path = spring.integrate(State::new([1.0], [2.0]).at_time(t), t, method).unwrap();
            assert_eq!(*path.ending(), Ending::Complete { time: t });
            assert_eq!((path.steps().count(), path.samples(3).count()), (1, 3));
            assert!(path.drift().iter().all(|quantity| quantity.largest == 0.0));
        }
    }
}

/// An end so far away that it means none, for a motion that is left when something happens.
#[test]
fn an_end_that_is_never_reached_does_no_harm() {
    for end in [1e17, 1e100, 1e300, f64::MAX] {
        let spring = spring_of(1.0);
        for method in [Dop853::default(), Dop853::default().max_step(0.5), Dop853::default().first_step(1e3)]
        {
            let watch = |progress: Progress| stop_if(progress.time > 20.0);
            let path = spring.motion(State::at_rest([1.0])).by(method).on_progress(watch).to(end).unwrap();
            assert!(matches!(path.ending(), Ending::Cancelled { .. }), "{}", path.ending());
            let off = path.end().coordinate("x").unwrap() - path.end().time().cos();
            assert!(off.abs() <= allowed(path.statistics().accepted, 1e-9), "to {end:e}: off by {off:e}");
            assert!(path.statistics().rejected < 20, "{:?}", path.statistics());
        }
    }
}
