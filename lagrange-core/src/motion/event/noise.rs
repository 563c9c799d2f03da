//! The round-off of an event's function at a state.

use super::definition::AnyEvent;
use crate::number::{Real, Scalar, larger};
use crate::solution::limits::MARGIN;
use crate::solution::round_off::neighbours;
use crate::system::{StateOf, System};

/// Round-off of an event's function, below which it counts as zero. It is 16 times the largest change of the function
/// at eight states whose entries and time are off by one unit of round-off each, up or down at random. The entries are
/// not known more accurately, and the function's own rounding errors change along with them.
pub(crate) fn noise<L: System<Scalar: Real>>(
    event: &impl AnyEvent<L>,
    system: &L,
    state: &StateOf<L>,
) -> Result<L::Scalar, crate::error::Error> {
    noise_beside(event, system, state, state)
}

/// The same for entries that are known to a unit of round-off of those of `sizes`.
#[cold]
#[inline(never)]
pub(crate) fn noise_beside<L: System<Scalar: Real>>(
    event: &impl AnyEvent<L>,
    system: &L,
    state: &StateOf<L>,
    sizes: &StateOf<L>,
) -> Result<L::Scalar, crate::error::Error> {
    let value = event.value(system, state)?;
    let moved = |nearby| event.value(system, &nearby).unwrap_or(value);
    let differences =
        neighbours(state, sizes, L::Scalar::EPSILON).map(|nearby| Scalar::abs(moved(nearby) - value));
    Ok(differences.fold(L::Scalar::constant(0.0), larger) * L::Scalar::constant(MARGIN))
}
