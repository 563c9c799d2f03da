//! Results of the classification of constraints.

use crate::mechanics::Evidence;
use crate::symbolic::Id;

/// Integrability of a constraint: whether it is equivalent to one without velocities. A velocity constraint is the form
/// ω = Σ F_a dq_a + b dt in the space of (q, t).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Integrability {
    /// Holonomic as written: Φ(q, t) = 0.
    Holonomic,
    /// The rate of change of a function of (q, t), at least locally: dω = 0.
    Exact,
    /// Exact after multiplication by a function of (q, t): ω ∧ dω = 0, but dω ≠ 0.
    IntegratingFactor,
    /// Not integrable alone, but implied by the integrals of the whole set of constraints.
    Together,
    /// Not integrable, neither alone nor together with the other constraints.
    Nonholonomic,
    /// Undecided: no random point was found for a numerical test.
    Undecided,
}

impl Integrability {
    pub(super) fn is_integrable(self) -> bool {
        matches!(self, Self::Holonomic | Self::Exact | Self::IntegratingFactor | Self::Together)
    }
}

/// Verdict on the integrability of one constraint.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Classification {
    /// Verdict.
    pub integrability: Integrability,
    /// Evidence for the verdict.
    pub evidence: Evidence,
}

/// Integrals of a set of velocity constraints: functions of (q, t) that are constant along every admissible motion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Integrals {
    /// Number of integrals.
    pub count: usize,
    /// Number of independent velocity constraints, an upper bound of `count`.
    pub of: usize,
    /// Evidence for `count`.
    pub evidence: Evidence,
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
