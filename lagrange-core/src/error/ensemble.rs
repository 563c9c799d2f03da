//! What can go wrong with an ensemble as a whole.

use core::fmt::{self, Debug, Display, Formatter};

use super::Error;

/// Why an ensemble cannot be integrated, resumed or put together.
#[non_exhaustive]
#[derive(Clone, PartialEq)]
pub enum EnsembleError {
    /// A part of an ensemble that does not exist.
    Shard {
        /// Which part was asked for, counted from 0.
        shard: usize,
        /// How many parts there are.
        of: usize,
    },
    /// Outcomes of different ensembles, which are no parts of one.
    Merge {
        /// In what they differ.
        reason: &'static str,
    },
    /// A member taken over from another run, which is not to be mixed with this one.
    OtherRun {
        /// The index of the member.
        member: usize,
        /// In what the runs differ.
        differs: &'static str,
    },
    /// Rows to resume from, where code that no fingerprint sees decides about them and the run has no
    /// [tag](crate::Ensemble::tag).
    Untagged {
        /// The code: an event, a controller, ….
        code: String,
    },
    /// What went wrong with a member in another process, which told it in words.
    Elsewhere {
        /// Its words.
        said: String,
    },
    /// A file of a table in Parquet that cannot be read or written, or does not belong there.
    #[cfg(feature = "parquet")]
    Parquet {
        /// The file, or the directory.
        file: String,
        /// What is wrong.
        reason: String,
    },
    /// The ranks of MPI cannot do this ensemble together.
    Ranks {
        /// The first rank at fault.
        rank: usize,
        /// Why not.
        reason: &'static str,
    },
    /// A member asked for that the ensemble does not have.
    NoSuchMember {
        /// Its index.
        member: usize,
        /// How many members there are.
        count: usize,
    },
    /// A table of members that are done, but not of this system, or of several runs.
    Resume {
        /// The line, counted from 1.
        line: usize,
        /// The column, counted from 1.
        column: usize,
        /// What is wrong there.
        reason: &'static str,
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
            Self::Resume { line, column, reason } => write!(
                f,
                "line {line}, column {column} of the table of members does not belong there: {reason}"
            ),
        }
    }
}

/// The sentence of its `Display`: `main` prints an error that it returns by this.
impl Debug for EnsembleError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(self, f)
    }
}
