//! What kind of constraint it is: whether it restricts positions, or only velocities.

use core::fmt::{self, Display, Formatter};

use super::evidence::Evidence;

/// Whether a constraint can be integrated to one that holds no velocities.
///
/// A velocity constraint Σ F_a q̇_a + b = 0 is the form ω = Σ F_a dq_a + b dt in the space of (q, t), and motions
/// are curves along which ω = 0 and t increases. Integrable means that they stay on surfaces I(q, t) = constant.
/// All this is judged where the holonomic constraints hold, for parameters and functions in general: a
/// parameter that happens to be zero can make a nonholonomic constraint integrable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Integrability {
    /// Written as Φ(q, t) = 0.
    Holonomic,
    /// A velocity constraint that is the rate of change of a function of (q, t), at least locally: dω = 0.
    Exact,
    /// A velocity constraint that becomes exact when it is multiplied by some function of (q, t): ω ∧ dω = 0
    /// (Frobenius), but dω is not zero.
    IntegratingFactor,
    /// Not integrable alone, but the set of constraints has integrals of which this one is a consequence.
    Together,
    /// Not integrable, with or without the others.
    Nonholonomic,
    /// No random point was found at which it could be judged.
    Undecided,
}

impl Integrability {
    /// Whether the constraint restricts the positions: it was written so, or can be integrated.
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

/// The kind of one constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Classification {
    /// The verdict.
    pub integrability: Integrability,
    /// How sure it is.
    pub evidence: Evidence,
}

/// The verdict and its evidence, as in `nonholonomic (as far as 8 random points show)`.
impl Display for Classification {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.integrability, self.evidence)
    }
}

impl Classification {
    /// No verdict.
    pub const UNDECIDED: Self = Self { integrability: Integrability::Undecided, evidence: Evidence::Held(0) };
}

/// How many of the velocity constraints, as a set, can be integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Extent {
    /// The set is integrable: its constraints amount to as many holonomic ones.
    All,
    /// Some combinations of the constraints are integrable, others are not.
    Some,
    /// The constraints leave every configuration within reach that the holonomic ones leave.
    None,
}

/// The integrals of a set of velocity constraints: independent functions I(q, t), beside those that the
/// holonomic constraints fix, that are constant along every motion that the constraints allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Integrals {
    /// How many there are.
    pub count: usize,
    /// How many velocity constraints are independent: the most there could be.
    pub of: usize,
    /// How sure the count is.
    pub evidence: Evidence,
}

impl Integrals {
    /// Where there is no velocity constraint.
    pub const VOID: Self = Self { count: 0, of: 0, evidence: Evidence::Proved };

    /// All, some or none of the constraints; all where there are none.
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
