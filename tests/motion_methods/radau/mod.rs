//! Radau IIA: its order, stiff systems with and without constraints, redundant constraints, and what goes wrong.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod faults;
mod order;
mod stiff;

use lagrange_core::{Ending, Method, StateDerivatives, prelude::*};

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
    /// Falls from the upright, at this rate.
    fn falls(self, method: impl Method<Self>, end: f64) -> Trajectory<Self> {
        let start = State::new([0.0, 1.0, 1.0, 1.0], [1.0, 0.0, 1.0, 0.0]);
        let path = self.motion(start).by(method).towards(end).unwrap().into_owned();
        // The bars stay parallel: the other branch, on which they cross, begins where they lie flat.
        let is_parallel = |state: &State<f64, 4>| (state.q[2] - state.q[0] - 1.0).abs() < 1e-5;
        assert!(path.steps().all(|step| is_parallel(step.state())), "another branch");
        path
    }
}

/// By themselves, a bar and a bob would swing at different rates, so that the coupler must push without bound where it lies
/// along both.
#[test]
fn a_pole_of_the_multipliers_ends_the_motion() {
    for m in [[1.0, 3.0], [3.0, 1.0], [1.0, 0.1], [1e-3, 2e-3]] {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let [three, five] =
                [FourBar { m, inertia: 1.0, arm: 1.0 }, FourBar { m, inertia: 1.0, arm: 1.0 }];
            let method = Radau::with_tolerance(tolerance);
            for path in [three.falls(method, 3.0), five.falls(method.stages::<5>(), 3.0)] {
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
            let linkage = || FourBar { m, inertia: 0.5, arm: 0.75 };
            let method = Radau::with_tolerance(tolerance);
            let paths = [
                linkage().falls(method, 1.0),
                linkage().falls(method.stages::<5>(), 1.0),
                linkage().falls(method.stages::<7>(), 1.0),
            ];
            for path in paths {
                assert!(path.ending().is_complete(), "{m:?}, {tolerance}: {}", path.ending());
                // φ̈ = (3/2) g sin φ
                let off = (energy(path.end().state()) - energy(path.start().state())).abs();
                assert!(off < 100.0 * tolerance, "{m:?}, {tolerance}: {off:e}");
                assert!(path.end().coordinate("p[1]").unwrap() < 0.0);
            }
        }
    }
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
