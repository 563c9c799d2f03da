//! What it took to compute a trajectory.

/// What an integration took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Statistics {
    /// Steps taken.
    pub accepted: usize,
    /// Steps tried and repeated shorter.
    pub rejected: usize,
    /// Evaluations of the equations of motion.
    pub evaluations: usize,
    /// Whether the constraints were independent in every evaluation.
    pub multipliers_are_unique: bool,
}

/// Of nothing done yet.
impl Default for Statistics {
    fn default() -> Self {
        Self { accepted: 0, rejected: 0, evaluations: 0, multipliers_are_unique: true }
    }
}
