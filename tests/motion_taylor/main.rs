//! Taylor's method against closed solutions, published values, conservation laws and another method.

mod classics;
mod constrained;
mod control;
mod drift;
mod events;
mod functions;
mod short_ranged;
mod singular;
mod supplied;
mod systems;
mod units;

use lagrange_core::{Method, StateOf, TaylorSeries, nalgebra::Const, prelude::*};

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
