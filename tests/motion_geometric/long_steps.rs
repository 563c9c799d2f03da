//! Derivatives along steps so long that their equations have several solutions.

use lagrange_core::linearized::DifferentiableMethod;
use lagrange_core::prelude::*;

use lagrange_random::{Random, cases};

#[derive(Clone, Lagrangian)]
#[coordinates(a)]
#[lagrangian(a_dot^2/2 + g*cos(a))]
struct Pendulum<T> {
    g: T,
}

const PENDULUM: Pendulum<f64> = Pendulum { g: 1.0 };

/// Four steps of length `h`: ∂a/∂a by the derivatives and by differences. `None` where a motion ends before or is too rough
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
    let motion = PENDULUM.integrate_sensitivities(start, 4.0 * h, method(h), &["a"]).ok()?;
    let found = motion.end().ok()?.q[(0, 0)];
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
