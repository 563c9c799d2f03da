//! Times counted from far away: the span asked for is integrated, whatever the numbers near the start are.

use lagrange_core::{Ending, prelude::*};

use crate::spring_of;
use crate::times::{allowed, exact};

/// The start, ω and the end.
pub(crate) const FAR: [(f64, f64, f64); 5] = [
    (1.7e9, 1e3, 1.7e9 + 0.1),
    (1.7e9, 1e5, 1.7e9 + 1e-3),
    (100.0, 1e13, 100.0 + 1e-11),
    (-1.7e9, 1e5, -1.7e9 + 1e-3),
    (1e14, 1.0, 1e14 + 64.0),
];

pub(crate) const TOLERANCE: f64 = 1e-9;

/// What is checked of a trajectory, whatever its equations.
pub(crate) struct Motion {
    pub(crate) ending: Ending,
    pub(crate) accepted: usize,
    pub(crate) steps: Vec<(f64, f64)>,
    pub(crate) samples: Vec<(f64, f64)>,
    pub(crate) energy: lagrange_core::trajectory::Deviation<f64>,
}

macro_rules! motion {
    ($trajectory:expr) => {{
        let path = $trajectory.unwrap();
        Motion {
            ending: path.ending().clone(),
            accepted: path.statistics().accepted,
            steps: path.steps().map(|sample| (sample.time(), sample.state().q[0])).collect(),
            samples: path.samples(1000).map(|sample| (sample.time(), sample.state().q[0])).collect(),
            energy: *path.drift().iter().next().unwrap(),
        }
    }};
}

pub(crate) fn check((start, omega, end): (f64, f64, f64), motion: &Motion) {
    assert_eq!(motion.ending, Ending::Complete { time: end });
    let off = |places: &[(f64, f64)]| {
        places.iter().map(|(t, x)| (x - exact(omega, start, *t)).abs()).fold(0.0, f64::max)
    };
    let (at_steps, between) = (off(&motion.steps), off(&motion.samples));
    let bound = allowed(motion.accepted, TOLERANCE);
    assert!(at_steps <= bound, "ω = {omega:e} from {start:e}: off by {at_steps:e}");
    // The interpolants are of an order less.
    assert!(between <= bound + 1e-6, "ω = {omega:e} from {start:e}: off by {between:e} between");
    assert!(motion.steps.is_sorted_by(|a, b| a.0 < b.0) && motion.samples.len() == 1000);
    assert!(motion.energy.largest / motion.energy.start <= bound, "{:?}", motion.energy);
}

#[cfg(feature = "thorough")]
pub(crate) use motion;

#[test]
fn a_motion_far_from_zero_is_that_from_zero() {
    for case in FAR {
        let (start, omega, end) = case;
        let (spring, from) = (spring_of(omega), State::at_rest([1.0]).at_time(start));
        check(case, &motion!(spring.integrate(from, end, Dop853::default())));
        if start != 100.0 {
            check(case, &motion!(spring.integrate(from, end, Dopri5::default())));
        }
    }
}

/// Where numbers near the time are too far apart for the motion, that is said.
#[test]
fn what_times_cannot_resolve_ends_the_motion() {
    let spring = spring_of(1e9);
    let start = State::at_rest([1.0]).at_time(1.7e9);
    let path = spring.motion(start).towards(1.7e9 + 1.0).unwrap();
    assert!(matches!(path.ending(), Ending::StepTooSmall { time: 1.7e9, .. }), "{}", path.ending());
    // In a step of the fifth order ωt may grow by a twentieth, and from one number to the next it grows by a seventh.
    let far = State::at_rest([1.0]).at_time(100.0);
    let spring = spring_of(1e13);
    let path = spring.motion(far).by(Dopri5::default()).towards(100.0 + 1e-11).unwrap();
    assert!(matches!(path.ending(), Ending::StepTooSmall { time: 100.0, .. }), "{}", path.ending());
    let spring = spring_of(1.0);
    for method in [Dop853::default().max_step(1e-8), Dop853::default().fixed_step(1e-8)] {
        let path = spring.motion(start).by(method).towards(1.7e9 + 1.0).unwrap();
        assert_eq!(*path.ending(), Ending::TimeTooCoarse { time: 1.7e9, step: 1e-8 });
    }
}
