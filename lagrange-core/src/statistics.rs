//! Counts of steps and evaluations of an integration.

/// Counts of steps and evaluations of an integration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Statistics {
    /// Accepted steps.
    pub accepted: usize,
    /// Rejected steps, each repeated with a shorter step length.
    pub rejected: usize,
    /// Evaluations of the equations of motion.
    pub evaluations: usize,
    /// True if the constraints were independent in every evaluation.
    pub multipliers_are_unique: bool,
}

/// Counts of zero, with unique multipliers.
impl Default for Statistics {
    fn default() -> Self {
        Self { accepted: 0, rejected: 0, evaluations: 0, multipliers_are_unique: true }
    }
}

impl Statistics {
    /// Counts of this integration after those of an earlier one.
    pub(crate) fn after(self, earlier: &Self) -> Self {
        Self {
            accepted: earlier.accepted + self.accepted,
            rejected: earlier.rejected + self.rejected,
            evaluations: earlier.evaluations + self.evaluations,
            multipliers_are_unique: earlier.multipliers_are_unique && self.multipliers_are_unique,
        }
    }
}
