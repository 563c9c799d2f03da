//! Results of the classification of constraints.

use crate::mechanics::Evidence;
use crate::symbolic::Id;

/// Class of a constraint, as documented for the enumeration of the same name in lagrange-core.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Integrability {
    Holonomic,
    Exact,
    IntegratingFactor,
    Together,
    Nonholonomic,
    Undecided,
}

impl Integrability {
    pub(super) fn is_integrable(self) -> bool {
        matches!(self, Self::Holonomic | Self::Exact | Self::IntegratingFactor | Self::Together)
    }
}

/// Class of one constraint.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Classification {
    pub(crate) integrability: Integrability,
    pub(crate) evidence: Evidence,
}

/// Number of integrals of the velocity constraints as a set: `count` of `of` independent constraints are integrable.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Integrals {
    pub(crate) count: usize,
    pub(crate) of: usize,
    pub(crate) evidence: Evidence,
}

/// Classes of all constraints, and their integrals.
#[derive(Clone, Debug)]
pub(crate) struct Kinds {
    pub(crate) classes: Vec<Classification>,
    /// `None` if undecided.
    pub(crate) integrals: Option<Integrals>,
    /// For each constraint, the function whose time derivative it is, as written or times a factor; `None` if not
    /// found.
    pub(crate) functions: Vec<Option<Id>>,
}
