//! One row of a table.

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

/// What a table says of one member.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberRow<T, const N: usize> {
    /// Its index in the ensemble.
    pub index: usize,
    /// Of which run it is.
    pub fingerprint: Fingerprint,
    /// Its last state; none where it has no motion.
    pub state: Option<State<T, N>>,
    /// Steps and evaluations; zero where it has no motion.
    pub statistics: Statistics,
    /// Why there is no later state.
    pub ending: MemberEnding,
}

/// Why a member's motion ends where it does, as a table says it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MemberEnding {
    /// The end was reached.
    Complete,
    /// The observer ended it.
    Cancelled,
    /// It met an event at which it was to end.
    Event(
        /// Its name.
        String,
    ),
    /// Something kept it from the end.
    Failed(
        /// What it was, in words.
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

/// As a table has it.
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

impl<T: Real, const N: usize> MemberRow<T, N> {
    /// Whether something other than the observer or an event kept it from the end.
    pub fn has_failed(&self) -> bool {
        matches!(self.ending, MemberEnding::Failed(_))
    }

    /// The member that it is the row of, in an ensemble with these events. What went wrong is known in words only.
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

    /// As a row of the table.
    pub fn csv(&self) -> impl Display + '_ {
        Line(Cow::Borrowed(self))
    }
}

pub(super) const COMPLETE: &str = "complete";
pub(super) const CANCELLED: &str = "cancelled";
pub(super) const EVENT: &str = "event: ";

pub(super) fn header<const N: usize>(names: &[&'static str; N]) -> String {
    let velocities = names.iter().map(|name| Entry::Velocity(name).to_string());
    let first = ["member", "system", "run", "start", "t"];
    let names = first.into_iter().chain(names.iter().copied()).map(String::from).chain(velocities);
    let counts = ["accepted", "rejected", "evaluations", "multipliers_are_unique", "ending", "member_again"]
        .map(String::from);
    names.chain(counts).collect::<Vec<_>>().join(",")
}

/// One line of it. The index stands at both ends: a line that was not written to its end, and the row that is then
/// appended to it, do not pass for a row of a third member.
pub(super) struct Line<'m, T: Real, const N: usize>(pub(super) Cow<'m, MemberRow<T, N>>);

impl<T: Real, const N: usize> Display for Line<'_, T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let MemberRow { index, fingerprint, state, statistics, ending } = &*self.0;
        let Fingerprint { system, run, start } = fingerprint;
        write!(f, "{index},{system},{run},{start}")?;
        match state {
            None => (0..2 * N + 5).try_for_each(|_| write!(f, ","))?,
            Some(state) => {
                // `Debug` of a number is its shortest form that reads back the same.
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
