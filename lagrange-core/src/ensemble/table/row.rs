//! One row of a table: its fields, its text.

use core::fmt::{self, Display, Formatter};
use std::borrow::Cow;

use crate::ensemble::fingerprint::Fingerprint;
use crate::ensemble::outcome::Member;
use crate::error::{Ending, EnsembleError, Error};
use crate::motion::record::Arrival;
use crate::names::Entry;
use crate::number::Real;
use crate::statistics::Statistics;
use crate::system::State;
use crate::vector::{Element, Length};

/// Data of one member in a table.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberRow<T: Element, N: Length> {
    /// Index of the member in the ensemble.
    pub index: usize,
    /// Hashes of the system, the run and the start.
    pub fingerprint: Fingerprint,
    /// Last state of the member; `None` if its motion did not start.
    pub state: Option<State<T, N>>,
    /// Numbers of steps and evaluations; zero if the motion did not start.
    pub statistics: Statistics,
    /// Reason why the motion ended at this state.
    pub ending: MemberEnding,
}

/// Reason why a member's motion ended, as a table stores it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MemberEnding {
    /// The motion reached the end.
    Complete,
    /// The observer ended the motion.
    Cancelled,
    /// A terminal event ended the motion.
    Event(
        /// Name of the event.
        String,
    ),
    /// The motion did not start or ended early because of an error.
    Failed(
        /// Message of the error.
        String,
    ),
}

impl Display for MemberEnding {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete => f.write_str(COMPLETE),
            Self::Cancelled => f.write_str(CANCELLED),
            Self::Event(name) => write!(f, "{EVENT}{name}"),
            Self::Failed(why) => f.write_str(why),
        }
    }
}

/// Parses the ending as a table writes it.
impl From<&str> for MemberEnding {
    fn from(text: &str) -> Self {
        match text {
            COMPLETE => Self::Complete,
            CANCELLED => Self::Cancelled,
            text => match text.strip_prefix(EVENT) {
                Some(name) => Self::Event(name.into()),
                None => Self::Failed(text.into()),
            },
        }
    }
}

impl<T: Real, N: Length> MemberRow<T, N> {
    /// True if an error, rather than the observer or an event, ended the motion early.
    pub fn has_failed(&self) -> bool {
        matches!(self.ending, MemberEnding::Failed(_))
    }

    /// Converts the row to a member of an ensemble with these events. Errors are kept as text only.
    pub(crate) fn into_member(self, events: &[&'static str]) -> Member<T, N> {
        let Self { index, fingerprint, state, statistics, ending } = self;
        let result = match (state, ending) {
            (None, ending) => Err(Error::Ensemble(EnsembleError::Elsewhere { said: ending.to_string() })),
            (Some(state), ending) => {
                let time = state.t.to_f64();
                let ending = match ending {
                    MemberEnding::Complete => Ending::Complete { time },
                    MemberEnding::Cancelled => Ending::Cancelled { time },
                    MemberEnding::Event(name) => match events.iter().find(|event| **event == name) {
                        Some(event) => Ending::Event { time, event },
                        None => Ending::Elsewhere { time, said: name },
                    },
                    MemberEnding::Failed(said) => Ending::Elsewhere { time, said },
                };
                Ok(Arrival {
                    state,
                    ending,
                    statistics,
                    samples: Vec::new(),
                    values: Vec::new(),
                    crossings: Vec::new(),
                })
            }
        };
        Member { index, fingerprint, result }
    }

    /// The row as a line of the table.
    pub fn csv(&self) -> impl Display + '_ {
        Line(Cow::Borrowed(self))
    }
}

pub(super) const COMPLETE: &str = "complete";
pub(super) const CANCELLED: &str = "cancelled";
pub(super) const EVENT: &str = "event: ";

pub(super) fn header(names: &'static [&'static str]) -> String {
    let velocities = names.iter().map(|name| Entry::Velocity(name).to_string());
    let first = ["member", "system", "run", "start", "t"];
    let names = first.into_iter().chain(names.iter().copied()).map(String::from).chain(velocities);
    let counts = ["accepted", "rejected", "evaluations", "multipliers_are_unique", "ending", "member_again"]
        .map(String::from);
    names.chain(counts).collect::<Vec<_>>().join(",")
}

/// Prints one line of the table. The index stands at both ends, so that a truncated line with another row appended is
/// not mistaken for the row of a third member.
pub(super) struct Line<'m, T: Real, N: Length>(pub(super) Cow<'m, MemberRow<T, N>>);

impl<T: Real, N: Length> Display for Line<'_, T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let MemberRow { index, fingerprint, state, statistics, ending } = &*self.0;
        let Fingerprint { system, run, start } = fingerprint;
        write!(f, "{index},{system},{run},{start}")?;
        match state {
            None => (0..2 * N::COUNT + 5).try_for_each(|_| write!(f, ","))?,
            Some(state) => {
                // `Debug` prints the fewest digits that read back to the same number.
                write!(f, ",{:?}", state.t)?;
                state.q.iter().chain(&state.v).try_for_each(|x| write!(f, ",{x:?}"))?;
                let Statistics { accepted, rejected, evaluations, multipliers_are_unique } = statistics;
                write!(f, ",{accepted},{rejected},{evaluations},{multipliers_are_unique}")?;
            }
        }
        match ending {
            MemberEnding::Complete | MemberEnding::Cancelled => writeln!(f, ",{ending},{index}"),
            ending => writeln!(f, ",{},{index}", quoted(&ending.to_string())),
        }
    }
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
