//! The lengths of steps.

use lagrange_core::{Ending, prelude::*};

use crate::spring_of;
use crate::times::exact;

/// The lengths of the steps, and the end reached.
fn lengths(start: f64, end: f64, method: Dop853) -> Vec<f64> {
    let spring = spring_of(1.0);
    let path = spring.integrate(State::at_rest([1.0]).at_time(start), end, method).expect("a motion");
    assert_eq!(*path.ending(), Ending::Complete { time: end });
    let times: Vec<f64> = path.steps().map(|step| step.time()).collect();
    times.windows(2).map(|t| t[1] - t[0]).collect()
}

#[test]
fn no_step_is_longer_than_allowed() {
    for (start, end) in [(0.0, 1.0), (0.0, 1.005), (-0.3, 1.0), (1e3, 1e3 + 1.0), (1.7e9, 1.7e9 + 1.0)] {
        for longest in [0.01, 0.1, 0.1 + 1e-9, 0.3, 0.334, 0.5, 0.996] {
            for method in [Dop853::default(), Dop853::default().first_step(2.0)] {
                let lengths = lengths(start, end, method.max_step(longest));
                assert!(lengths.iter().all(|h| *h <= longest), "{lengths:?} from {start}, at most {longest}");
                // As many as it takes, one for the rounding of the time, and two that the estimate of the first costs.
                assert!(lengths.len() as f64 <= ((end - start) / longest).ceil() + 3.0);
                let [.., before, last] = lengths[..] else { continue };
                assert!(last >= 0.99 * before, "{lengths:?} ends with a tiny step");
            }
        }
    }
}

#[test]
fn fixed_steps_are_as_many_as_fit() {
    for (start, end, count) in [
        (0.0, 1.0, 10),
        (0.0, 0.3, 3),
        (0.1, 0.7, 6),
        (0.0, 10.0, 1000),
        (-10.0, 0.0, 7),
        (1e3, 1e3 + 1.0, 7),
        (1.7e9, 1.7e9 + 1.0, 10),
        (0.0, 1e4, 10_000),
    ] {
        let step = (end - start) / f64::from(count);
        let lengths = lengths(start, end, Dop853::default().fixed_step(step));
        assert_eq!(lengths.len(), count as usize, "from {start} to {end}");
        // Each end of a step is off by the distance of two numbers at most.
        let apart = 2.0 * f64::EPSILON * f64::max(start.abs(), end.abs());
        let off = lengths.iter().fold(0.0, |most, h| f64::max(most, (h - step).abs()));
        assert!(off <= 2.0 * apart, "from {start} to {end}: off by {off:e}");
    }
    let lengths = lengths(0.0, 1.0, Dop853::default().fixed_step(0.3));
    assert!(lengths.len() == 4 && (lengths[3] - 0.1).abs() < 1e-15, "{lengths:?}");
}

/// Before, rounding added up to a shorter motion.
#[test]
fn fixed_steps_arrive_with_their_order() {
    let (start, omega) = (1.7e9, 1e3);
    let spring = spring_of(omega);
    let error = |count: i32| {
        let end = start + 0.125;
        let method = Dop853::default().fixed_step(0.125 / f64::from(count));
        let path = spring.integrate(State::at_rest([1.0]).at_time(start), end, method).unwrap();
        (path.end().coordinate("x").unwrap() - exact(omega, start, end)).abs()
    };
    let order = (error(150) / error(300)).log2();
    assert!((7.5..8.7).contains(&order), "{order}");
}
