//! A row of a table: all data of one member, with names and errors as text.

use core::fmt::{self, Display, Formatter};
use std::sync::Arc;

use super::fingerprint::Fingerprint;
use super::names::ColumnNames;
use super::outcome::Member;
use crate::error::{Ending, EnsembleError, Error};
use crate::generic::{Element, Length, State};
use crate::motion::Arrival;
use crate::number::Real;
use crate::{Crossing, Statistics};

/// Data of one member in a table.
///
/// With the feature `serde` it is serialized and deserialized as one object with the fields `member`, [`fingerprint`](Fingerprint), `ending`,
/// `end`, `statistics`, `samples` and `crossings`. The same object is a line of [JSON](super::Outcome::json_lines) and a row of a
/// Parquet file. States and samples are objects of numbers by name, `{"t":0.5,"x":0.7,"x_dot":-1.1,"energy":0.5}`. `end` is
/// null if the motion did not start. The ending is `complete`, `cancelled`, `event: ` and the event's name, or the message of
/// the error. Numbers are written as `f64`; NaN and infinities are the texts `"NaN"`, `"inf"` and `"-inf"`.
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
    /// States at the times of samples, up to the end of the motion.
    pub samples: Vec<State<T, N>>,
    /// Quantities of the samples: all of the first sample, all of the second, …
    pub values: Vec<T>,
    /// Crossings of events, in the order of the motion.
    pub crossings: Vec<MemberCrossing<T, N>>,
    pub(crate) names: Arc<ColumnNames>,
}

/// A crossing of an event, as a table stores it.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberCrossing<T: Element, N: Length> {
    /// Name of the event.
    pub event: String,
    /// Index of the event, in the order in which the events were given.
    pub index: usize,
    /// Number of this crossing among those of the event, counted from 1.
    pub count: usize,
    /// True if the event function rises through zero, false if it falls.
    pub rising: bool,
    /// State at the crossing.
    pub state: State<T, N>,
}

impl<T: Element, N: Length> From<&Crossing<T, N>> for MemberCrossing<T, N> {
    fn from(crossing: &Crossing<T, N>) -> Self {
        let &Crossing { event, index, count, rising, ref state } = crossing;
        Self { event: event.into(), index, count, rising, state: state.clone() }
    }
}

impl<T: Element, N: Length> MemberCrossing<T, N> {
    /// The crossing of one of these events; `None` if there is no such event.
    fn of(self, events: &[&'static str]) -> Option<Crossing<T, N>> {
        let Self { event: name, index, count, rising, state } = self;
        let event = events.get(index).copied().filter(|event| *event == name)?;
        Some(Crossing { event, index, count, rising, state })
    }
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

impl<T: Real, N: Length> Member<T, N> {
    /// The member's row of a table.
    pub fn row(&self) -> MemberRow<T, N> {
        let arrival = self.arrival();
        MemberRow {
            index: self.index,
            fingerprint: self.fingerprint,
            state: arrival.map(|arrival| arrival.state.clone()),
            statistics: arrival.map(|arrival| arrival.statistics).unwrap_or_default(),
            ending: match &self.result {
                Err(error) => MemberEnding::Failed(error.to_string()),
                Ok(Arrival { ending: Ending::Complete { .. }, .. }) => MemberEnding::Complete,
                Ok(Arrival { ending: Ending::Cancelled { .. }, .. }) => MemberEnding::Cancelled,
                Ok(Arrival { ending: Ending::Event { event, .. }, .. }) => {
                    MemberEnding::Event((*event).into())
                }
                Ok(Arrival { ending, .. }) => MemberEnding::Failed(ending.to_string()),
            },
            samples: arrival.map(|arrival| arrival.samples.clone()).unwrap_or_default(),
            values: arrival.map(|arrival| arrival.values.clone()).unwrap_or_default(),
            crossings: arrival.into_iter().flat_map(|arrival| &arrival.crossings).map(Into::into).collect(),
            names: self.names.clone(),
        }
    }
}

impl<T: Real, N: Length> MemberRow<T, N> {
    /// True if an error, rather than the observer or an event, ended the motion early.
    pub fn has_failed(&self) -> bool {
        matches!(self.ending, MemberEnding::Failed(_))
    }

    /// Values of a quantity at the samples; empty without samples.
    ///
    /// # Errors
    /// [`Error::UnknownName`].
    pub fn quantity(&self, name: &str) -> Result<impl Iterator<Item = T> + '_, Error> {
        self.names.values(name, &self.values)
    }

    /// Converts the row to a member of an ensemble with these events and names. Errors are kept as text only.
    ///
    /// # Errors
    /// [`EnsembleError::OtherRun`] if the row has other quantities or events.
    pub(crate) fn into_member(
        self,
        events: &[&'static str],
        names: &Arc<ColumnNames>,
    ) -> Result<Member<T, N>, Error> {
        let Self { index, fingerprint, state, statistics, ending, samples, values, crossings, names: found } =
            self;
        let differs = "its quantities or events are others";
        let other = Error::Ensemble(EnsembleError::OtherRun { member: index, differs });
        let crossings: Option<_> = crossings.into_iter().map(|crossing| crossing.of(events)).collect();
        let crossings = crossings.filter(|_| samples.is_empty() || *names == found).ok_or(other)?;
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
                Ok(Arrival { state, ending, statistics, samples, values, crossings, transitions: Vec::new() })
            }
        };
        Ok(Member { index, fingerprint, names: names.clone(), result })
    }

    /// True if both rows reached the end or an event, but not with the same bits. An observer may end a member at another
    /// time.
    pub(crate) fn contradicts(&self, other: &Self) -> bool {
        let is_repeatable = |ending: &_| matches!(ending, MemberEnding::Complete | MemberEnding::Event(_));
        let are_repeatable = [self, other].iter().all(|row| is_repeatable(&row.ending));
        // `Debug` prints numbers that read back to the same bits, and a NaN equals itself.
        are_repeatable && self.result() != other.result()
    }

    fn result(&self) -> String {
        let Self { state, statistics, ending, samples, values, crossings, .. } = self;
        format!("{:?}", (state, statistics, ending, samples, values, crossings))
    }
}

const COMPLETE: &str = "complete";
const CANCELLED: &str = "cancelled";
const EVENT: &str = "event: ";

pub(super) const TWO_RESULTS: &str = "an earlier row of the member has another result: other code, or a library with other roundings, was at work";
