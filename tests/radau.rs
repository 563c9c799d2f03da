//! Radau IIA: its order, stiff systems with and without constraints, redundant constraints, and what goes wrong.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

use core::ops::ControlFlow;
use std::f64::consts::FRAC_PI_2;
use std::time::Duration;

use lagrange_core::nalgebra::Const;
use lagrange_core::{Ending, Method, StateDerivatives, TaylorSeries, prelude::*};

#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + 9.81*(2*cos(a) + cos(b)))]
#[dissipation(c/2*(a_dot^2 + b_dot^2))]
struct DoublePendulum {
    c: f64,
}

/// A bob on a spring.
#[derive(Clone, Lagrangian)]
#[coordinates(r, a)]
#[lagrangian((r_dot^2 + r^2*a_dot^2)/2 + 9.81*r*cos(a) - 50*(r - 1)^2)]
#[dissipation(r_dot^2/20)]
struct Elastic;

/// A bob on a rod whose pivot is shaken along the horizontal.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(dot(r_dot, r_dot)/2 - 9.81*r[1])]
#[constraint(rod: (r[0] - sin(3*t)/50)^2 + r[1]^2 = 1)]
struct Shaken;

/// A blade on a slope.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian((x_dot^2 + y_dot^2 + theta_dot^2)/2 + x)]
#[constraint(blade: x_dot*sin(theta) - y_dot*cos(theta) = 0)]
struct Blade;

fn off<const N: usize>(state: &State<f64, N>, exact: &State<f64, N>) -> f64 {
    (state.q - exact.q).amax().max((state.v - exact.v).amax())
}

/// A method with this tolerance and first step.
type MethodOf<P> = fn(f64, f64) -> P;

/// Error after this many equal steps, each a run of its own, with the least tolerance 10^(−k/4) at which all of them are accepted at
/// once; and this k, from `least` on. Without a limit on the error, the tolerance still decides how well a step is solved.
fn in_equal_steps<L, P: Method<L>, const N: usize>(
    (count, least): (u32, u32),
    method: MethodOf<P>,
    (system, start, end): (&L, State<f64, N>, &State<f64, N>),
) -> Option<(u32, f64)>
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    let step = end.t / f64::from(count);
    let run = |tolerance: f64| {
        (1..=count).try_fold(start, |state, k| {
            let time = if k == count { end.t } else { step * f64::from(k) };
            let path = system.integrate(state, time, method(tolerance, 1.01 * step)).ok()?;
            let counts = path.statistics();
            ((counts.accepted, counts.rejected) == (1, 0)).then(|| *path.end().state())
        })
    };
    let of = |k: u32| Some((k, off(&run(10.0_f64.powf(-0.25 * f64::from(k)))?, end)));
    (least..60).rev().find_map(of)
}

/// Asserts the order, the slope of log error over log number of equal steps, between errors of 10⁻² and 10³ times the least.
fn is_of_order<L, P: Method<L>, const N: usize>(
    order: f64,
    name: &str,
    method: MethodOf<P>,
    (system, start, end): (&L, State<f64, N>, f64),
) where
    L: TaylorSeries<N = Const<N>, Scalar = f64>,
{
    let exact = *system.integrate(start, end, Taylor::default()).unwrap().end().state();
    let (mut points, mut least_power) = (Vec::new(), 4);
    for k in 15.. {
        let count = 2.0_f64.powf(0.15 * f64::from(k)).round();
        // Few steps are accepted at no tolerance.
        if let Some((power, error)) =
            in_equal_steps((count as u32, least_power), method, (system, start, &exact))
        {
            points.push((count, error));
            least_power = power;
        }
        // From here on the tolerance is round-off.
        if least_power == 59 {
            break;
        }
    }
    let least = points.iter().map(|point| point.1).fold(f64::INFINITY, f64::min);
    let is_between = |point: &&(f64, f64)| point.1 < 1e-2 && point.1 > 1e3 * least;
    let points: Vec<_> = points.iter().filter(is_between).map(|(n, e)| (n.log2(), e.log2())).collect();
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (n, e) = (mean(|point| point.0), mean(|point| point.1));
    let slope = points.iter().map(|point| (point.0 - n) * (point.1 - e)).sum::<f64>()
        / points.iter().map(|point| (point.0 - n).powi(2)).sum::<f64>();
    println!("{name}: order {:.2} of {count} numbers of steps, least error {least:.1e}", -slope);
    assert!(count > 5.0 && -slope > order - 0.3, "{name}: order {} of {count}", -slope);
    assert!(least < 1e-10, "{name}: {least:e}");
}

fn are_of_order<P>(order: f64, method: MethodOf<P>, end: f64)
where
    P: Method<Elastic> + Method<Shaken> + Method<Blade>,
{
    is_of_order(order, "bob on a spring", method, (&Elastic, State::new([1.1, 1.0], [0.0, 0.3]), end));
    is_of_order(order, "rod with a shaken pivot", method, (&Shaken, Shaken::start(), end));
    is_of_order(order, "blade", method, (&Blade, State::new([0.0; 3], [1.0, 0.0, 1.5]), end));
}

impl Shaken {
    fn start() -> State<f64, 2> {
        Self.make_consistent(&State::at_rest([0.6, -0.8])).unwrap().0
    }
}

#[test]
fn their_orders_are_five_nine_and_thirteen() {
    are_of_order(5.0, |tolerance, step| Radau::with_tolerance(tolerance).first_step(step), 3.0);
    let nine = |tolerance, step| Radau::with_tolerance(tolerance).first_step(step).stages::<5>();
    are_of_order(9.0, nine, 3.0);
    let thirteen = |tolerance, step| Radau::with_tolerance(tolerance).first_step(step).stages::<7>();
    are_of_order(13.0, thirteen, 6.0);
}

/// A spring in honey.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[dissipation(c/2*x_dot^2)]
struct Slow {
    c: f64,
}

impl Slow {
    /// The motion from rest at 1, in closed form.
    fn at(&self, t: f64) -> State<f64, 1> {
        let root = (self.c * self.c / 4.0 - 1.0).sqrt();
        let fast = -self.c / 2.0 - root;
        let slow = 1.0 / fast;
        let [a, b] = [fast / (fast - slow), -slow / (fast - slow)];
        let (x, y) = (a * (slow * t).exp(), b * (fast * t).exp());
        State::new([x + y], [slow * x + fast * y]).at_time(t)
    }
}

#[test]
fn stiff_damping_takes_few_steps() {
    let slow = Slow { c: 1e6 };
    for (tolerance, steps) in [(1e-6, 30), (1e-9, 50), (1e-12, 150)] {
        let path = slow.integrate(State::at_rest([1.0]), 1e6, Radau::with_tolerance(tolerance)).unwrap();
        assert!(off(path.end().state(), &slow.at(1e6)) < tolerance.max(1e-12), "{tolerance}");
        assert!(path.statistics().accepted < steps, "{:?}", path.statistics());
        // Dense output, from the steep start on.
        for t in [1e-5, 1e-2, 10.0, 3e3, 7e5] {
            let error = off(path.at(t).unwrap().state(), &slow.at(t));
            assert!(error < 30.0 * tolerance.powf(0.75), "{error:e} at {t}, tolerance {tolerance}");
        }
    }
    // Backwards in time the spring flees from its end, and is followed.
    let end = slow.at(2e-6);
    let path = slow.integrate(end, 0.0, Radau::default()).unwrap();
    let back = off(path.end().state(), &slow.at(0.0));
    assert!(back < 1e-7, "{back:e}");
}

/// A pendulum in honey, by its angle from the horizontal and by a rod.
#[derive(Clone, Lagrangian)]
#[coordinates(a)]
#[lagrangian(a_dot^2/2 - 9.81*sin(a))]
#[dissipation(c/2*a_dot^2)]
struct Angle {
    c: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - 9.81*y)]
#[constraint(rod: x^2 + y^2 = 1)]
#[constraint(again: a*x^2 + b*y^2 = 1)]
#[dissipation(c/2*(x_dot^2 + y_dot^2))]
struct Rods {
    a: f64,
    b: f64,
    c: f64,
}

/// The stiff component lies along the constraint, which turns by 90°; the constraint is there twice.
#[test]
fn stiff_motions_on_redundant_constraints_take_few_steps() {
    let (angle, rods) = (Angle { c: 1e6 }, Rods { a: 1.0, b: 1.0, c: 1e6 });
    let reference = angle.integrate(State::at_rest([0.0]), 3e5, Radau::with_tolerance(1e-13)).unwrap();
    let path = rods.integrate(State::at_rest([1.0, 0.0]), 3e5, Radau::with_tolerance(1e-9)).unwrap();
    assert!(path.statistics().accepted < 200, "{:?}", path.statistics());
    assert!(!path.statistics().multipliers_are_unique);
    for k in 0..=100 {
        let t = 3e3 * f64::from(k);
        let (state, a) = (*path.at(t).unwrap().state(), reference.at(t).unwrap().coordinate("a").unwrap());
        assert!((state.q[0] - a.cos()).abs().max((state.q[1] - a.sin()).abs()) < 1e-6, "at {t}");
    }
    let a = reference.end().coordinate("a").unwrap();
    assert!(
        (a + FRAC_PI_2).abs() < 0.2
            && off(path.end().state(), &State::new([a.cos(), a.sin()], [0.0; 2])) < 1e-5
    );
}

/// Bobs on stiff springs, and on rods.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [2], s: [2])]
#[define(stretch = (norm(r) - 1)^2 + (norm(s - r) - 1)^2)]
#[define(rate = dot(r, r_dot)^2/dot(r, r) + dot(s - r, s_dot - r_dot)^2/dot(s - r, s - r))]
#[lagrangian((dot(r_dot, r_dot) + dot(s_dot, s_dot))/2 - 9.81*(r[1] + s[1]) - k/2*stretch)]
#[dissipation(c/2*rate)]
struct Springs {
    k: f64,
    c: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(r: [2], s: [2])]
#[lagrangian((dot(r_dot, r_dot) + dot(s_dot, s_dot))/2 - 9.81*(r[1] + s[1]))]
#[constraint(upper: dot(r, r) = 1)]
#[constraint(lower: dot(s - r, s - r) = 1)]
struct TwoRods;

/// The limit of stiff springs are rods; tensions F up to 100 leave errors of the order F/k. With the derivatives at the start of
/// each step alone, it takes thousands of steps.
#[test]
fn stiff_springs_that_swing_take_few_steps() {
    let start = State::at_rest([1.0, 0.0, 2.0, 0.0]);
    let exact = *TwoRods.integrate(start, 1.0, Taylor::default()).unwrap().end().state();
    for (k, c) in [(1e10, 0.0), (1e10, 1e6)] {
        let springs = Springs { k, c };
        for (tolerance, most) in [(1e-4, [400, 200, 150]), (1e-6, [400, 200, 150]), (1e-9, [800, 200, 150])] {
            let method = Radau::with_tolerance(tolerance);
            let paths = [
                springs.integrate(start, 1.0, method).unwrap(),
                springs.integrate(start, 1.0, method.stages::<5>()).unwrap(),
                springs.integrate(start, 1.0, method.stages::<7>()).unwrap(),
            ];
            for (path, most) in paths.iter().zip(most) {
                let error = (path.end().state().q - exact.q).amax();
                assert!(error < tolerance + 2e-8, "{k}, {c}, {tolerance}: {error:e}");
                let steps = path.statistics().accepted + path.statistics().rejected;
                assert!(steps < most, "{k}, {c}, {tolerance}: {:?}", path.statistics());
            }
        }
    }
}

/// Dry friction, all but a jump at rest: the bob swings, and sticks.
#[derive(Clone, Lagrangian)]
#[coordinates(a)]
#[lagrangian(a_dot^2/2 + 9.81*cos(a))]
#[dissipation(3*sqrt(a_dot^2 + 1e-12))]
struct Sticking;

/// Friction holds it at a constant rate. Guesses far beyond the step before miss that rate: with them it took 100,000 steps.
#[test]
fn a_motion_that_sticks_takes_few_steps() {
    let start = State::new([1.0], [2.0]);
    let exact = *Sticking.integrate(start, 3.0, Radau::with_tolerance(1e-12)).unwrap().end().state();
    for tolerance in [1e-4, 1e-6, 1e-9] {
        let method = Radau::with_tolerance(tolerance);
        let paths = [
            Sticking.integrate(start, 3.0, method).unwrap(),
            Sticking.integrate(start, 3.0, method.stages::<5>()).unwrap(),
            Sticking.integrate(start, 3.0, method.stages::<7>()).unwrap(),
        ];
        for path in paths {
            assert!(off(path.end().state(), &exact) < tolerance, "{tolerance}");
            assert!(path.statistics().accepted < 300, "{tolerance}: {:?}", path.statistics());
        }
    }
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

#[test]
fn what_goes_wrong_is_said() {
    let (pendulum, start) = (DoublePendulum { c: 0.0 }, State::new([1.0, 0.5], [0.0, 0.3]));
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused =
            |method: Radau| matches!(pendulum.integrate(start, 1.0, method), Err(Error::Setting { .. }));
        assert!(refused(Radau::with_tolerance(wrong)) && refused(Radau::default().max_step(wrong)));
        assert!(
            refused(Radau::default().first_step(wrong))
                && refused(Radau::default().absolute_tolerance(wrong))
        );
    }
    let ending = |method| pendulum.motion(start).by(method).towards(10.0).unwrap().ending().clone();
    assert!(matches!(ending(Radau::default().max_steps(5)), Ending::StepLimit { steps: 5, .. }));
    assert!(matches!(ending(Radau::default().wall_time(Duration::ZERO)), Ending::WallTimeLimit { .. }));
    let broken = pendulum.event("broken", |sample| if sample.time() > 0.3 { f64::NAN } else { 1.0 });
    let path = pendulum.motion(start).by(Radau::default()).event(broken).towards(1.0).unwrap();
    assert!(matches!(path.ending(), Ending::EventNotFinite { .. }));
    let stop = |_| ControlFlow::Break(());
    let path = pendulum.motion(start).by(Radau::default()).on_progress(stop).towards(1.0).unwrap();
    assert!(matches!(path.ending(), Ending::Cancelled { .. }));
    // Tolerances at and below round-off come to an end, one way or the other.
    let path = pendulum.motion(start).by(Radau::with_tolerance(1e-16)).towards(1.0).unwrap();
    assert!(
        off(
            path.end().state(),
            pendulum
                .integrate(start, path.end().time(), Dop853::with_tolerance(1e-14))
                .unwrap()
                .end()
                .state()
        ) < 1e-11
    );
}

/// A root that ends, and a stone that falls on a star.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - sqrt(1 - x))]
struct Cliff;

#[derive(Clone, Lagrangian)]
#[coordinates(r)]
#[lagrangian(r_dot^2/2 + 1/r)]
struct Stone;

#[test]
fn singular_motions_end_where_they_are_singular() {
    let path = Cliff.motion(State::new([0.0], [0.5])).by(Radau::default()).towards(10.0).unwrap();
    assert!(path.ending().is_failure() && path.end().coordinate("x").unwrap() > 0.99, "{}", path.ending());
    let path = Stone.motion(State::at_rest([1.0])).by(Radau::default()).towards(10.0).unwrap();
    let fall = FRAC_PI_2 / 2.0_f64.sqrt();
    assert!(path.ending().is_failure() && (path.end().time() - fall).abs() < 1e-6, "{}", path.ending());
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
