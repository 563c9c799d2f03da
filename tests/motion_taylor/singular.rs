//! Poses at which constraints become dependent: the motion goes on as it would without them, or ends with a word.

use std::f64::consts::PI;

use lagrange_core::error::Row;
use lagrange_core::nalgebra::{Const, SVector};
use lagrange_core::{TaylorSeries, prelude::*};
use lagrange_systems::Pendulum;

/// Windows: verticals about (i, 0), between which couplers hang; rods of length and mass 1, by their ends. When all rods are
/// level the couplers' constraints depend on the others', and each corner could stay behind.
macro_rules! windows {
    ($name:ident, $n:literal, $corners:literal) => {
        #[derive(Lagrangian)]
        #[coordinates(x: [$corners], y: [$corners])]
        #[lagrangian(sum(i in 0..$corners, (x_dot[i]^2 + y_dot[i]^2)/6 - g*y[i]/2)
                    + sum(i in 0..$n, (x_dot[i]^2 + y_dot[i]^2 + x_dot[i]*x_dot[i+1] + y_dot[i]*y_dot[i+1]
                        + x_dot[i+1]^2 + y_dot[i+1]^2)/6 - g*(y[i] + y[i+1])/2))]
        #[constraint(vertical[i in 0..$corners]: (x[i] - i)^2 + y[i]^2 = 1)]
        #[constraint(coupler[i in 0..$n]: (x[i+1] - x[i])^2 + (y[i+1] - y[i])^2 = 1)]
        struct $name {
            g: f64,
        }
    };
}
windows!(Window, 1, 2);
windows!(TwoWindows, 2, 3);

/// Four bars, of 4, 1, 2 and 3, by the angles of three: they fold flat.
#[derive(Lagrangian)]
#[coordinates(a, b, c)]
#[lagrangian(a_dot^2/6 + a_dot^2 + 4*b_dot^2/3 + 2*a_dot*b_dot*cos(a - b) + 9*c_dot^2/2
    - g*(sin(a)/2 + 2*(sin(a) + sin(b)) + 9*sin(c)/2))]
#[constraint(x: cos(a) + 2*cos(b) - 3*cos(c) = 4)]
#[constraint(y: sin(a) + 2*sin(b) - 3*sin(c) = 0)]
struct Linkage {
    g: f64,
}

const END: f64 = 10.0;
const GRAVITIES: [f64; 8] = [9.5, 9.58, 9.66, 9.73, 9.81, 9.89, 9.97, 10.05];
const TOLERANCES: [f64; 9] = [f64::EPSILON, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-6];

/// A step across a pose may be off by 10⁻¹⁰ of the velocity, which is up to 6: over ten seconds that makes 6·10⁻⁹ of place, of
/// one such step, and two of the eight may add up.
const ACROSS: f64 = 1e-8;

/// How long each tolerance leads from upright, and how far from what the reduced pendulum does then.
fn windows<L, const N: usize>(windows: &L, n: usize, g: f64) -> Result<Vec<(f64, f64)>, Error>
where
    L: TaylorSeries<N = Const<N>, Scalar = f64>,
{
    let upright = core::array::from_fn(|i| if i <= n { i as f64 } else { 1.0 });
    let start = State::new(upright, core::array::from_fn(|i| if i <= n { 1.0 } else { 0.0 }));
    // The couplers stay level by themselves: n + 1 rods turn about their ends, and carry n masses at the others.
    let (number, upright) = (n as f64, State::new([PI], [-1.0]));
    let [inertia, weight] = [(number + 1.0) / 3.0 + number, (number + 1.0) / 2.0 + number];
    let reduced = Pendulum { m: inertia, l: 1.0, g: weight * g / inertia };
    let pendulum = reduced.integrate(upright, END, Dop853::with_tolerance(1e-14))?;
    let each = TOLERANCES.map(|tolerance| {
        let path = windows.motion(start).by(Taylor::with_tolerance(tolerance)).towards(END)?;
        let (time, end) = (path.ending().time(), *path.end().state());
        let (cosine, down) = pendulum.at(time)?.state().q[0].sin_cos();
        let expected = |i: usize| if i <= n { i as f64 + cosine } else { -down };
        let off = (0..N).map(|i| (end.q[i] - expected(i)).abs()).fold(0.0, f64::max);
        println!("{g}, {tolerance:e}: to {time}, {off:e} off, {} steps", path.statistics().accepted);
        Ok((time, off))
    });
    each.into_iter().collect()
}

/// None goes wrong without a word; so many of all tolerances with any gravity lead to the end, which below 10⁻¹¹ is up to how
/// numbers are rounded, and all from 10⁻¹⁰ on but one.
fn assert_goes_on(
    at_least: usize,
    motions: impl Fn(f64) -> Result<Vec<(f64, f64)>, Error>,
) -> Result<(), Error> {
    let (mut through, mut through_coarse) = (0, 0);
    for g in GRAVITIES {
        for ((time, off), tolerance) in motions(g)?.into_iter().zip(TOLERANCES) {
            let allowed = (1e3 * tolerance).max(ACROSS);
            assert!(off < allowed, "{g}, {tolerance:e}: {off:e} off, and no word");
            through += usize::from(time == END);
            through_coarse += usize::from(time == END && tolerance > 1e-11);
        }
    }
    assert!(through >= at_least && through_coarse >= 3 * GRAVITIES.len() - 1, "{through}, {through_coarse}");
    Ok(())
}

#[test]
fn windows_are_stepped_across() -> Result<(), Error> {
    let of = GRAVITIES.len() * TOLERANCES.len();
    assert_goes_on(of * 2 / 3, |g| windows(&Window { g }, 1, g))?;
    assert_goes_on(of / 2, |g| windows(&TwoWindows { g }, 2, g))
}

/// Here a whole row of the Jacobian vanishes, whatever the others are: below 10⁻¹⁰ the motion ends there.
#[test]
fn a_linkage_that_folds_keeps_its_energy_as_far_as_it_goes() -> Result<(), Error> {
    let (mut through, mut motions) = (0, 0);
    for g in GRAVITIES.into_iter().step_by(3) {
        motions += 2;
        let linkage = Linkage { g };
        let start = State::at_rest([1.0, 0.762_873_910_257_525, 2.306_798_799_395_277]);
        let (start, _) = linkage.make_consistent(&start)?;
        for tolerance in TOLERANCES {
            let path = linkage.motion(start).by(Taylor::with_tolerance(tolerance)).towards(END)?;
            let (change, end) =
                (linkage.energy(path.end().state()) - linkage.energy(&start), path.ending().time());
            println!("{g}, {tolerance:e}: to {end}, energy {change:e}");
            assert!(change.abs() < (1e3 * tolerance).max(1e-9), "{g}, {tolerance:e}: {change:e}");
            through += usize::from(tolerance >= 1e-9 && end == END);
        }
    }
    assert!(through >= motions - 1, "{through} of {motions}");
    Ok(())
}

/// Across singular poses, too, where a step is as long as its sum needs.
#[test]
fn no_step_is_longer_than_allowed() -> Result<(), Error> {
    let longest = 2e-3;
    let start = State::new([0.0, 1.0, 1.0, 1.0], [1.0, 1.0, 0.0, 0.0]);
    let path = Window { g: 9.81 }.motion(start).by(Taylor::default().max_step(longest)).towards(1.0)?;
    let times: Vec<f64> = path.steps().map(|step| step.state().t).collect();
    for pair in times.windows(2) {
        assert!(pair[1] - pair[0] < longest * (1.0 + 1e-9), "{pair:?}");
    }
    Ok(())
}

/// Folded flat, no first derivative says which way it goes on; beside that pose they do.
#[test]
fn no_motion_starts_at_a_singular_pose() -> Result<(), Error> {
    let linkage = Linkage { g: 9.81 };
    for turn in [0.0, 2.0 * PI, -20.0 * PI] {
        let flat = State::at_rest([PI + turn, turn, PI + turn]);
        let error = linkage.check_consistent(&flat).unwrap_err();
        assert!(matches!(error, Error::NoGradient { constraint: Row::Constraint("x"), .. }), "{error:?}");
        // a = 2b + 3c of y, and of x, to second order, a² = 2b² + 3c².
        let b = 6.0_f64.sqrt() - 3.0;
        let beside = flat.q - SVector::from([2.0 * b + 3.0, b, 1.0]) * 0.1;
        let (beside, _) = linkage.make_consistent(&State { q: beside, ..flat })?;
        linkage.integrate(beside, 1e-3, Dop853::default())?;
    }
    Ok(())
}
