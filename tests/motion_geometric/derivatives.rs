//! Derivatives of motions along steps so long that their equations have several solutions, and with sin t where t is so large
//! that vector functions do not compute it.

use lagrange_core::linearized::{DifferentiableMethod, TrajectorySensitivity};
use lagrange_core::motion::Composition::KahanLi8;
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};
use lagrange_systems::{Pendulum, ShakenPendulum};

const PENDULUM: Pendulum<f64> = Pendulum { m: 1.0, l: 1.0, g: 1.0 };

/// Four steps of length `h`: ∂θ/∂θ by the derivatives and by differences. `None` where a motion ends before or is too rough
/// for differences.
fn four_steps<D>(method: fn(f64) -> D, [a, v, h]: [f64; 3]) -> Option<[f64; 2]>
where
    D: DifferentiableMethod<Pendulum<f64>>,
{
    let end = |a: f64| {
        let path = PENDULUM.integrate(State::new([a], [v]), 4.0 * h, method(h)).ok()?;
        Some(path.end().state().q[0])
    };
    let difference = |by: f64| Some((end(a + by)? - end(a - by)?) / (2.0 * by));
    let [wide, narrow] = [difference(1e-5)?, difference(1e-6)?];
    let start = State::new([a], [v]);
    let motion = PENDULUM.integrate_sensitivities(start, 4.0 * h, method(h), &["theta"]).ok()?;
    let found = motion.derivatives_at_end().ok()?.q[(0, 0)];
    ((wide - narrow).abs() < 1e-4 * (1.0 + narrow.abs())).then_some([found, narrow])
}

fn agree([found, expected]: [f64; 2], what: &dyn core::fmt::Debug) {
    let off = (found - expected).abs();
    assert!(off < 1e-2 * (1.0 + expected.abs()), "{what:?}: {found} for {expected}");
}

/// With an initial guess of its own, the iteration over dual numbers ended at another solution than that of the motion.
#[test]
fn derivatives_of_a_long_step_are_those_of_its_solution() {
    let starts = [
        [-2.960_187_758_422_65, 0.228_091_265_608_108, 2.462_354_378_005_185],
        [-2.870_589_062_510_054_7, -0.398_869_047_067_229_87, 2.381_757_816_288_044_6],
        [-2.860_339_691_856_517_6, -0.078_053_069_945_787_53, 2.588_406_162_765_571],
        [-2.924_780_688_686_938, -0.103_346_415_940_633_21, 2.597_781_809_571_078],
        [2.853_105_965_948_828_7, 0.031_749_994_009_550_7, 2.571_545_171_795_437],
        [-2.858_749_893_934_323, 0.015_974_731_741_398_518, 2.527_994_673_795_902_3],
    ];
    for start in starts {
        let found = four_steps(Gauss::<1>::with_step, start);
        agree(found.unwrap_or_else(|| panic!("no derivatives from {start:?}")), &start);
    }
}

#[test]
fn derivatives_of_random_long_steps_are_those_of_their_solutions() {
    let (mut random, mut compared) = (Random(7), 0);
    let count = cases([100, 300, 30_000]);
    for k in 0..count {
        let start = [random.between(-3.0, 3.0), random.between(-2.0, 2.0), random.between(2.0, 4.0)];
        let found = match k % 4 {
            0 => four_steps(Gauss::<1>::with_step, start),
            1 => four_steps(Gauss::<2>::with_step, start),
            2 => four_steps(Lobatto::<2>::with_step, start),
            _ => four_steps(Lobatto::<3>::with_step, start),
        };
        if let Some(found) = found {
            agree(found, &(k % 4, start));
            compared += 1;
        }
    }
    assert!(2 * compared > count, "{compared} of {count}");
}

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - 2*x^2)]
#[force(x: f*sin(t))]
struct Driven<T> {
    f: T,
}

/// The motion is linear in its start and in f, so that its derivatives add up to it, whatever the steps.
#[test]
fn derivatives_far_from_zero_add_up_to_the_motion() {
    fn check<D: DifferentiableMethod<Driven<f64>>>(method: D, far: f64) {
        let start = State::new([0.7], [-0.4]).at_time(far);
        let names = ["x", "x_dot", "f"];
        let motion = Driven { f: 1.5 }.integrate_sensitivities(start, far + 10.0, method, &names).unwrap();
        let end = motion.derivatives_at_end().unwrap();
        for (by, state) in [(&end.q, end.state.q[0]), (&end.v, end.state.v[0])] {
            let sum = by[0] * 0.7 - by[1] * 0.4 + by[2] * 1.5;
            assert!((sum - state).abs() < 1e-13, "{sum} for {state} from {far:e}");
        }
    }
    for far in [0.0, 1e6, 1e8, 3e9] {
        check(Verlet::with_step(0.1), far);
        check(Gauss::<1>::with_step(0.1), far);
        check(Gauss::<3>::with_step(0.1), far);
        check(Lobatto::<2>::with_step(0.1), far);
        check(Lobatto::<4>::with_step(0.1), far);
        check(DAlembert::with_step(0.1).composed(KahanLi8), far);
    }
}

/// A pivot that swings as sin t, at 10⁸, by another method.
#[test]
fn derivatives_far_from_zero_are_those_of_other_methods() {
    let system = ShakenPendulum { m: 1.0, g: 1.0, l: 1.0, a: 0.3, w: 1.0 };
    let names = ["x", "x_dot", "g", "a"];
    let start = system.make_consistent(&State::new([0.5, -0.7], [0.2, 0.0]).at_time(1e8)).unwrap().0;
    let end = |motion: TrajectorySensitivity<'_, ShakenPendulum<f64>>| {
        motion.derivatives_at_end().unwrap().q.clone()
    };
    let by = |method| system.integrate_sensitivities(start, 1e8 + 10.0, method, &names).unwrap();
    let exact = end(by(Dop853::with_tolerance(1e-11)));
    let dalembert = DAlembert::with_step(0.1).composed(KahanLi8);
    for found in [
        system.integrate_sensitivities(start, 1e8 + 10.0, Lobatto::<4>::with_step(0.05), &names),
        system.integrate_sensitivities(start, 1e8 + 10.0, dalembert, &names),
        system.integrate_sensitivities(start, 1e8 + 10.0, Taylor::default(), &names),
    ] {
        let off = (end(found.unwrap()) - &exact).amax();
        assert!(off < 1e-6, "{off:e}");
    }
}
