//! Motions that are steered, limited in time, and given broken input.

mod allocations;
mod faults;
mod saturation;
mod steered;
mod times;

// The same on lanes, in momenta, across contacts and in single precision.
#[cfg(feature = "thorough")]
mod allocations_of_runs;
#[cfg(feature = "thorough")]
mod both_ways;
#[cfg(feature = "thorough")]
mod classical;
#[cfg(feature = "thorough")]
mod single_precision;

use core::ops::ControlFlow;

use lagrange_core::prelude::*;
use lagrange_systems::Spring;

/// A bob on a rod of the length √`square`, which shrinks to nothing at the time `square`/`shrinks`, pushed along the
/// horizontal.
#[derive(Clone, Copy, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: x^2 + y^2 = square - shrinks*t)]
#[force(x: u)]
struct Rod {
    m: f64,
    g: f64,
    square: f64,
    shrinks: f64,
    u: f64,
}

const ROD: Rod = Rod { m: 1.0, g: 9.81, square: 1.0, shrinks: 0.0, u: 0.0 };

/// A start on [`ROD`].
fn swinging() -> State<f64, 2> {
    State::new([0.6, -0.8], [0.8, 0.6])
}

/// A spring with this angular frequency.
fn spring_of<T: Scalar>(omega: T) -> Spring<T> {
    Spring { m: T::constant(1.0), k: omega * omega }
}

/// What progress that cancels a motion returns.
fn stop_if(stops: bool) -> ControlFlow<()> {
    if stops { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
