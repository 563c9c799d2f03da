//! The verdicts on constraints.

use crate::mechanics::Evidence;
use crate::symbolic::Id;

/// As the enumeration of the same name in lagrange-core, which documents it.
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

/// The verdict on one constraint.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Classification {
    pub(crate) integrability: Integrability,
    pub(crate) evidence: Evidence,
}

/// The verdict on the velocity constraints as a set.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Integrals {
    pub(crate) count: usize,
    pub(crate) of: usize,
    pub(crate) evidence: Evidence,
}

/// The verdicts on all constraints.
#[derive(Clone, Debug)]
pub(crate) struct Kinds {
    pub(crate) classes: Vec<Classification>,
    /// `None` where it could not be decided.
    pub(crate) integrals: Option<Integrals>,
    /// For each constraint the function whose rate it is, as written or times a factor, where it was found.
    pub(crate) functions: Vec<Option<Id>>,
}
