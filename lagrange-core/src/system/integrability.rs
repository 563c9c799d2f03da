//! Classification of constraints: restrictions of positions, or only of velocities.

use core::fmt::{self, Display, Formatter};

use super::evidence::Evidence;

/// Integrability of a constraint: whether it is equivalent to one without velocities.
///
/// A velocity constraint Σ F_a q̇_a + b = 0 is the form ω = Σ F_a dq_a + b dt in the space of (q, t). Motions
/// are curves along which ω = 0 and t increases. Integrable means that they stay on surfaces I(q, t) =
/// constant. The verdict holds where the holonomic constraints are satisfied, for generic parameters and
/// functions: a parameter that happens to be zero can make a nonholonomic constraint integrable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Integrability {
    /// Holonomic as written: Φ(q, t) = 0.
    Holonomic,
    /// A velocity constraint that is, at least locally, the rate of change of a function of (q, t): dω = 0.
    Exact,
    /// A velocity constraint that is exact after multiplication by a function of (q, t): ω ∧ dω = 0
    /// (Frobenius), but dω ≠ 0.
    IntegratingFactor,
    /// Not integrable alone, but implied by the integrals of the whole set of constraints.
    Together,
    /// Not integrable, neither alone nor together with the other constraints.
    Nonholonomic,
    /// Undecided: no random point was found for a numerical test.
    Undecided,
}

impl Integrability {
    /// True if the constraint restricts positions: it is holonomic as written or integrable.
    pub const fn is_integrable(self) -> bool {
        matches!(self, Self::Holonomic | Self::Exact | Self::IntegratingFactor | Self::Together)
    }
}

impl Display for Integrability {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Holonomic => "holonomic",
            Self::Exact => "integrable",
            Self::IntegratingFactor => "integrable with a factor",
            Self::Together => "integrable together with the others",
            Self::Nonholonomic => "nonholonomic",
            Self::Undecided => "whether it can be integrated is not decided",
        })
    }
}

/// Classification of one constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Classification {
    /// Verdict on the integrability.
    pub integrability: Integrability,
    /// Evidence for the verdict.
    pub evidence: Evidence,
}

/// Formats verdict and evidence, as in `nonholonomic (as far as 8 random points show)`.
impl Display for Classification {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.integrability, self.evidence)
    }
}

impl Classification {
    /// Classification without a verdict.
    pub const UNDECIDED: Self = Self { integrability: Integrability::Undecided, evidence: Evidence::Held(0) };
}

/// Integrability of the velocity constraints as a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Extent {
    /// The set is integrable: it is equivalent to the same number of holonomic constraints.
    All,
    /// Some combinations of the constraints are integrable, others are not.
    Some,
    /// No combination is integrable: the velocity constraints restrict the reachable configurations no further
    /// than the holonomic ones.
    None,
}

/// Integrals of a set of velocity constraints: functions I(q, t) that are constant along every admissible
/// motion. They are independent of one another and of the functions that the holonomic constraints fix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Integrals {
    /// Number of integrals.
    pub count: usize,
    /// Number of independent velocity constraints, an upper bound of `count`.
    pub of: usize,
    /// Evidence for `count`.
    pub evidence: Evidence,
}

impl Integrals {
    /// Value for a system without velocity constraints: zero integrals of zero constraints, proved.
    pub const VOID: Self = Self { count: 0, of: 0, evidence: Evidence::Proved };

    /// Returns the extent of integrability: `All` if there are no velocity constraints.
    pub const fn extent(self) -> Extent {
        if self.count == self.of {
            Extent::All
        } else if self.count == 0 {
            Extent::None
        } else {
            Extent::Some
        }
    }
}
