//! Taylor's method against closed solutions, published values, conservation laws and another method.

mod classics;
mod control;
mod events;
mod functions;
mod systems;
mod units;

// Random walks of rounding errors, motions on lanes and at singular poses, bodies in
// frames, functions that are supplied.
#[cfg(feature = "thorough")]
mod bodies;
#[cfg(feature = "thorough")]
mod constrained;
#[cfg(feature = "thorough")]
mod drift;
#[cfg(feature = "thorough")]
mod short_ranged;
#[cfg(feature = "thorough")]
mod singular;
#[cfg(feature = "thorough")]
mod supplied;

use lagrange_core::{Method, StateOf, TaylorSeries, nalgebra::Const, prelude::*};
use lagrange_systems::{SphericalPendulum, Spring};

const SPRING: Spring<f64> = Spring { m: 1.0, k: 1.0 };

/// A bob on a rod in space, with this gravity.
fn spherical(g: f64) -> SphericalPendulum<f64> {
    SphericalPendulum { m: 1.0, g, l: 1.0 }
}

/// The state at the end, by Taylor's method to round-off.
fn end<L>(system: &L, start: StateOf<L>, end: f64) -> Result<StateOf<L>, Error>
where
    L: TaylorSeries<Scalar = f64>,
{
    let path = system.integrate(start, end, Taylor::default())?;
    assert_eq!(path.ending().time(), end, "{:?}", path.ending());
    Ok(*path.end().state())
}

/// The largest difference from what `Dop853` gives.
fn difference<L, const N: usize>(system: &L, start: State<f64, N>, until: f64) -> Result<f64, Error>
where
    L: TaylorSeries<N = Const<N>, Scalar = f64>,
    Dop853: Method<L>,
{
    let ours = end(system, start, until)?;
    let path = system.integrate(start, until, Dop853::with_tolerance(1e-14))?;
    let theirs = *path.end().state();
    let off = (ours.q - theirs.q).abs().max().max((ours.v - theirs.v).abs().max());
    println!("{}: {off:e}", L::NAME);
    Ok(off)
}
