//! Errors of an ensemble as a whole.

use core::fmt::{self, Debug, Display, Formatter};

use alloc::string::String;

use crate::error::Error;

/// Reason why an ensemble cannot be integrated, resumed or merged.
#[non_exhaustive]
#[derive(Clone, PartialEq)]
pub enum EnsembleError {
    /// The requested shard of an ensemble does not exist.
    Shard {
        /// Index of the requested shard, counted from 0.
        shard: usize,
        /// Number of shards.
        of: usize,
    },
    /// The outcomes to merge belong to different ensembles.
    Merge {
        /// Difference between the ensembles.
        reason: &'static str,
    },
    /// A member to resume from belongs to another run, whose results must not be mixed with this run.
    OtherRun {
        /// Index of the member.
        member: usize,
        /// Difference between the runs.
        differs: &'static str,
    },
    /// The rows to resume from depend on code that no fingerprint covers, and the run has no
    /// [tag](crate::Ensemble::tag).
    Untagged {
        /// Kind of code: an event, a controller, ….
        code: String,
    },
    /// A member failed in another process, which reported the error as text.
    Elsewhere {
        /// Text of the error.
        said: String,
    },
    /// A Parquet file of a table cannot be read or written, or does not belong to the table.
    #[cfg(feature = "parquet")]
    Parquet {
        /// Path of the file or directory.
        file: String,
        /// Reason of the failure.
        reason: String,
    },
    /// The MPI ranks cannot integrate this ensemble together.
    Ranks {
        /// First rank at fault.
        rank: usize,
        /// Reason of the failure.
        reason: &'static str,
    },
    /// The ensemble has no member of this index.
    NoSuchMember {
        /// Index requested.
        member: usize,
        /// Number of members.
        count: usize,
    },
    /// A quantity has the name of another, or of an entry of the state. Both would be columns of one name in a table.
    QuantityName {
        /// Name of the quantity.
        name: String,
    },
    /// The table of finished members belongs to another system, or to several runs.
    Resume {
        /// Line of the table, counted from 1.
        line: usize,
        /// Reason of the mismatch.
        reason: String,
    },
}

impl core::error::Error for EnsembleError {}

impl From<EnsembleError> for Error {
    fn from(error: EnsembleError) -> Self {
        Self::Ensemble(error)
    }
}

impl Display for EnsembleError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shard { shard, of } => {
                write!(
                    f,
                    "there is no part {shard} of {of}: parts are counted from 0, and there is at least one"
                )
            }
            Self::Merge { reason } => write!(f, "the outcomes are not parts of one ensemble: {reason}"),
            Self::OtherRun { member, differs } => write!(
                f,
                "member {member} of the table to resume from is of another run: {differs}; resume with what made the table, or begin a new one"
            ),
            Self::Untagged { code } => write!(
                f,
                "{code} may have been another when the rows to resume from were made, and nothing in them tells: name it in both runs by `.tag(\"…\")` on the ensemble, and anew whenever it changes; `.tag(\"\")` takes over rows of a run without a tag"
            ),
            Self::Elsewhere { said } => f.write_str(said),
            #[cfg(feature = "parquet")]
            Self::Parquet { file, reason } => write!(f, "{file}, of a table of members: {reason}"),
            Self::Ranks { rank, reason } => {
                write!(f, "the ranks cannot do this ensemble together: on rank {rank} {reason}")
            }
            Self::NoSuchMember { member, count } => {
                write!(f, "there is no member {member}: the ensemble has {count}, counted from 0")
            }
            Self::QuantityName { name } => write!(
                f,
                "the quantity `{name}` has the name of another quantity, of the time, of a coordinate or of a velocity: give it a name of its own"
            ),
            Self::Resume { line, reason } => {
                write!(f, "line {line} of the table of members does not belong there: {reason}")
            }
        }
    }
}

/// Prints the sentence of `Display`, since `main` prints a returned error by `Debug`.
impl Debug for EnsembleError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(self, f)
    }
}
