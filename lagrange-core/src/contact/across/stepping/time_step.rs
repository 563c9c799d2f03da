//! A step of a motion across contacts.

use core::fmt::{self, Debug, Formatter};

use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::system::{Lagrangian, Solution, SolutionOf, StateOf, lookup};
use crate::vector::{Entrywise, Vector, zeros};

/// A step of a motion: what is known at its end.
pub struct TimeStep<L: Lagrangian> {
    /// State at the end of the step. Coordinates satisfy gaps and constraints there; velocities satisfy them where the
    /// impulses act, within the step.
    pub state: StateOf<L>,
    /// Impulses Λ of all constraints, contacts and friction in the step: momenta change by WᵀΛ.
    pub impulses: Vector<L::Scalar, L::M>,
    /// How often the impulses were found, as forces change with the velocities.
    pub iterations: usize,
    /// What the balance of momentum is off by, as a part of its largest term, both in units of the root of an energy.
    pub residual: L::Scalar,
    /// Mean accelerations and multipliers of the step.
    pub(super) means: SolutionOf<L>,
}

impl<L: Lagrangian<Scalar: Real>> TimeStep<L> {
    /// The start of a motion.
    pub(super) fn start(state: StateOf<L>) -> Self {
        let residual = L::Scalar::constant(0.0);
        Self { state, impulses: zeros(), iterations: 0, residual, means: Solution::unknown() }
    }

    /// Accelerations and multipliers of a step between two states, as means.
    pub(super) fn means(
        [before, after]: [&StateOf<L>; 2],
        impulses: &Vector<L::Scalar, L::M>,
    ) -> SolutionOf<L> {
        let length = after.t - before.t;
        Solution::given(
            after.v.minus(&before.v).each(|v| v / length),
            impulses.each(|impulse| impulse / length),
        )
    }
}

impl<L: Lagrangian> TimeStep<L> {
    /// Returns the impulse of a contact, a friction or a constraint in the step. The friction of a contact `floor` is
    /// `floor_friction`.
    ///
    /// # Errors
    /// [`Error::UnknownName`] if there is none of this name.
    pub fn impulse(&self, name: &str) -> Result<L::Scalar, Error> {
        lookup::index::<L>(L::CONSTRAINTS, "constraint", name).map(|row| self.impulses[row])
    }
}

impl<L: Lagrangian> Clone for TimeStep<L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lagrangian> Copy for TimeStep<L> {}

impl<L: Lagrangian> Debug for TimeStep<L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { state, impulses, iterations, residual, .. } = self;
        let mut text = f.debug_struct("TimeStep");
        text.field("state", state).field("impulses", impulses);
        text.field("iterations", iterations).field("residual", residual).finish()
    }
}
