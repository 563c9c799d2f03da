//! One row of a table: its fields, its text.

use core::fmt::{self, Display, Formatter};
use std::borrow::Cow;
use std::sync::Arc;

use super::cells::{Lists, Number, escaped, quoted, text};
use crate::ensemble::fingerprint::Fingerprint;
use crate::ensemble::names::ColumnNames;
use crate::ensemble::outcome::Member;
use crate::error::{Ending, EnsembleError, Error};
use crate::motion::record::Arrival;
use crate::number::Real;
use crate::solution::crossing::Crossing;
use crate::statistics::Statistics;
use crate::system::State;
use crate::vector::{Array, Element, Length, vector};

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
        let Crossing { event, index, count, rising, state } = *crossing;
        Self { event: event.into(), index, count, rising, state }
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
        are_repeatable && self.csv().to_string() != other.csv().to_string()
    }

    /// The row as a line of the table.
    pub fn csv(&self) -> impl Display + '_ {
        Line(Cow::Borrowed(self))
    }
}

pub(super) const COMPLETE: &str = "complete";
pub(super) const CANCELLED: &str = "cancelled";
pub(super) const EVENT: &str = "event: ";

pub(super) fn header(names: &ColumnNames) -> String {
    let first = ["member", "system", "run", "start"].map(String::from).into_iter().chain(names.of_state());
    let counts = ["accepted", "rejected", "evaluations", "multipliers_are_unique", "ending"];
    let lists = ["samples", "crossings", "member_again"];
    first.chain(counts.into_iter().chain(lists).map(String::from)).collect::<Vec<_>>().join(",")
}

/// Number of entries of a state: time, coordinates, velocities.
pub(crate) const fn entries<N: Length>() -> usize {
    1 + 2 * N::COUNT
}

/// An entry of a state.
pub(crate) fn entry<T: Real, N: Length>(state: &State<T, N>, place: usize) -> T {
    match place.checked_sub(1) {
        None => state.t,
        Some(i) if i < N::COUNT => state.q[i],
        Some(i) => state.v[i - N::COUNT],
    }
}

/// The state with these entries.
pub(crate) fn state_of<T: Real, N: Length, E>(
    mut entry: impl FnMut(usize) -> Result<T, E>,
) -> Result<State<T, N>, E> {
    let zero = vector(Array::<T, N>::filled(T::constant(0.0)));
    let mut state = State { t: entry(0)?, q: zero, v: zero };
    for (k, x) in (1..).zip(state.q.iter_mut().chain(&mut state.v)) {
        *x = entry(k)?;
    }
    Ok(state)
}

/// Names of the columns of a crossing before those of its state.
pub(crate) const CROSSING: [&str; 4] = ["event", "event_index", "event_count", "event_rising"];

/// Prints one line of the table. The index stands at both ends, so that a truncated line with another row appended is
/// not mistaken for the row of a third member.
pub(super) struct Line<'m, T: Real, N: Length>(pub(super) Cow<'m, MemberRow<T, N>>);

impl<T: Real, N: Length> Display for Line<'_, T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let MemberRow { index, fingerprint, state, statistics, ending, .. } = &*self.0;
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
            MemberEnding::Complete | MemberEnding::Cancelled => write!(f, ",{ending}")?,
            ending => write!(f, ",{}", quoted(&escaped(&ending.to_string(), "")))?,
        }
        writeln!(f, ",{},{},{index}", self.0.samples_cell(), self.0.crossings_cell())
    }
}

impl<T: Real, N: Length> MemberRow<T, N> {
    /// Samples and quantities as an object of lists; empty without samples.
    fn samples_cell(&self) -> String {
        if self.samples.is_empty() {
            return String::new();
        }
        let (mut lists, names) = (Lists::default(), &self.names);
        push_states(&mut lists, names, &self.samples);
        let count = names.quantities.len();
        for (place, name) in names.quantities.iter().enumerate() {
            lists.push(name, self.values.iter().skip(place).step_by(count).map(|x| Number(*x)));
        }
        lists.cell()
    }

    /// Crossings as an object of lists; empty without crossings.
    fn crossings_cell(&self) -> String {
        let of = &self.crossings;
        if of.is_empty() {
            return String::new();
        }
        let [event, index, count, rising] = CROSSING;
        let mut lists = Lists::default();
        lists.push(event, of.iter().map(|crossing| text(&crossing.event)));
        lists.push(index, of.iter().map(|crossing| crossing.index));
        lists.push(count, of.iter().map(|crossing| crossing.count));
        lists.push(rising, of.iter().map(|crossing| crossing.rising));
        push_states(&mut lists, &self.names, &of.iter().map(|crossing| crossing.state).collect::<Vec<_>>());
        lists.cell()
    }
}

fn push_states<T: Real, N: Length>(lists: &mut Lists, names: &ColumnNames, states: &[State<T, N>]) {
    for (place, name) in names.of_state().enumerate() {
        lists.push(&name, states.iter().map(|state| Number(entry(state, place))));
    }
}
