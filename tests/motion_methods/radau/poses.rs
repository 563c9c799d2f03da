//! A linkage that folds flat, and four hundred coordinates.

use lagrange_core::{Ending, prelude::*};

use crate::radau::stages::by_stages;

/// A linkage of four equal sides that folds flat: a bar, and a body with this inertia and arm of its weight, per mass.
#[derive(Clone, Lagrangian)]
#[coordinates(p: [2], q: [2])]
#[lagrangian(m[0]/6*dot(p_dot, p_dot) + m[1]*inertia/2*dot(q_dot, q_dot) - 9.81*(m[0]*p[1]/2 + m[1]*arm*q[1]))]
#[constraint(left: dot(p, p) = 1)]
#[constraint(right: (q[0] - 1)^2 + q[1]^2 = 1)]
#[constraint(coupler: dot(q - p, q - p) = 1)]
struct FourBar {
    m: [f64; 2],
    inertia: f64,
    arm: f64,
}

impl FourBar {
    /// Falls from the upright, by three, five and seven stages.
    fn falls(&self, tolerance: f64, end: f64) -> [Trajectory<&Self>; 3] {
        let start = State::new([0.0, 1.0, 1.0, 1.0], [1.0, 0.0, 1.0, 0.0]);
        let paths = by_stages(self, start, end, tolerance);
        // The bars stay parallel: the other branch, on which they cross, begins where they lie flat.
        let is_parallel = |state: &State<f64, 4>| (state.q[2] - state.q[0] - 1.0).abs() < 1e-5;
        assert!(
            paths.iter().all(|path| path.steps().all(|step| is_parallel(step.state()))),
            "another branch"
        );
        paths
    }
}

/// By themselves, a bar and a bob would swing at different rates, so that the coupler must push without bound where it lies
/// along both.
#[test]
fn a_pole_of_the_multipliers_ends_the_motion() {
    for m in [[1.0, 3.0], [3.0, 1.0], [1.0, 0.1], [1e-3, 2e-3]] {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            for path in (FourBar { m, inertia: 1.0, arm: 1.0 }).falls(tolerance, 3.0) {
                let ending = path.ending();
                let Ending::Unsolved { error, .. } = ending else { panic!("{m:?}, {tolerance}: {ending}") };
                assert!(
                    matches!(error, Error::UnboundedMultipliers { .. } | Error::DependentToFirstOrder { .. }),
                    "{m:?}, {tolerance}: {ending}"
                );
                let height = path.end().coordinate("p[1]").unwrap();
                assert!((0.0..0.5).contains(&height), "{m:?}, {tolerance}, at {height}: {ending}");
            }
        }
    }
}

/// A body that swings at the rate of the bar needs no push.
#[test]
fn a_pose_with_bounded_multipliers_is_crossed_on_its_branch() {
    let energy = |sample: &State<f64, 4>| sample.v[0].hypot(sample.v[1]).powi(2) / 3.0 + 9.81 * sample.q[1];
    for m in [[1.0, 3.0], [3.0, 1.0], [1.0, 0.1]] {
        for k in 6..26 {
            let tolerance = 10.0_f64.powf(-0.5 * f64::from(k));
            for path in (FourBar { m, inertia: 0.5, arm: 0.75 }).falls(tolerance, 1.0) {
                assert!(path.ending().is_complete(), "{m:?}, {tolerance}: {}", path.ending());
                // φ̈ = (3/2) g sin φ
                let off = (energy(path.end().state()) - energy(path.start().state())).abs();
                assert!(off < 100.0 * tolerance, "{m:?}, {tolerance}: {off:e}");
                assert!(path.end().coordinate("p[1]").unwrap() < 0.0);
            }
        }
    }
}

/// Complex matrices of 2.5 MB, which do not fit on the stack of a thread.
#[derive(Clone, Lagrangian)]
#[coordinates(x: [400])]
#[lagrangian(sum(i in 0..400, x_dot[i]^2/2 - x[i]^2/2))]
#[force(x[i in 0..400]: -c*x_dot[i])]
struct Many {
    c: f64,
}

#[test]
fn four_hundred_coordinates_fit_on_the_stack_of_a_thread() {
    let integrate = || {
        let many = Many { c: 1e6 };
        let mut motion = Motion::new(many, State::at_rest([1.0; 400]), Radau::with_tolerance(1e-4)).unwrap();
        motion.advance_to(1.0).unwrap();
        (motion.state().q[0], motion.state().q[399])
    };
    let thread = std::thread::Builder::new().stack_size(2 << 20).spawn(integrate).unwrap();
    let (first, last) = thread.join().unwrap();
    assert!((first - (-1e-6_f64).exp()).abs() < 1e-9 && first.to_bits() == last.to_bits());
}
