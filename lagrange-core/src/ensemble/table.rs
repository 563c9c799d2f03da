//! Outcomes written as comma-separated values, and read back.

mod read;

use core::fmt::{self, Display, Formatter};
use core::str::FromStr;
use std::borrow::Cow;
use std::collections::BTreeMap;

use super::Arrival;
use super::fingerprint::Fingerprint;
use super::outcome::{Member, Outcome};
use crate::error::{Ending, EnsembleError, Error};
use crate::names::Entry;
use crate::number::Real;
use crate::statistics::Statistics;
use crate::system::{Lagrangian, State};
pub(super) use read::read;

impl<T: Real, const N: usize> Member<T, N> {
    /// Its row of a table.
    pub fn row(&self) -> MemberRow<T, N> {
        let arrival = self.arrival();
        MemberRow {
            index: self.index,
            fingerprint: self.fingerprint,
            state: arrival.map(|arrival| arrival.state),
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
        }
    }

    /// Its row of the table [`Outcome::csv`], to be written as soon as the member is done.
    pub fn csv(&self) -> impl Display + '_ {
        Line(Cow::Owned(self.row()))
    }
}

impl<T: Real, const N: usize> Outcome<T, N> {
    /// A table as comma-separated values, one line a member: `member`, its [`Fingerprint`] as `system`, `run` and `start`,
    /// `t`, coordinates `x` and velocities `x_dot` of the last state, the [`Statistics`], `ending`, and `member_again`, by
    /// which a line written to its end is known. The fingerprint takes at most 33 bytes of a line.
    ///
    /// The ending is `complete`, `cancelled`, `event: ` and its name, or what went wrong. Numbers are the shortest that read
    /// back the same. [`MemberTable`] reads it.
    pub fn csv(&self) -> impl Display + '_ {
        Lines { names: &self.names, members: &self.members, line: Member::csv }
    }
}

/// A table of members, cleaned and read back without a motion being run.
///
/// It takes what [`Outcome::csv`] and [`Member::csv`] wrote: one table, several in a row, rows alone. Lines that were not
/// written to their ends are left out, also where another row was appended to one. Of several rows of one member the first
/// that arrived counts (nothing went wrong with it), and the last where none did. Its `Display` is the table
/// with those rows, by member.
///
/// ```
/// # use lagrange_core::prelude::*;
/// use lagrange_core::ensemble::{MemberEnding, MemberTable};
/// # #[derive(Lagrangian)]
/// # #[coordinates(x)]
/// # #[lagrangian(x_dot^2/2 - k/2 * x^2)]
/// # struct Spring<T> { k: T }
/// # let springs = Ensemble::from_fn(3, |n| (Spring { k: n as f64 }, State::at_rest([1.0])));
/// let written = springs.integrate(1.0, Dop853::default())?.csv().to_string();
/// let torn = format!("{written}{written}2,17");
/// let table = MemberTable::read::<Spring<f64>, 0>(&torn)?;
/// assert_eq!(table.to_string(), written);
/// for row in table.rows() {
///     assert_eq!(row.ending, MemberEnding::Complete);
///     println!("{}: {}", row.index, row.state.unwrap().q[0]);
/// }
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MemberTable<T, const N: usize> {
    names: [&'static str; N],
    rows: Vec<MemberRow<T, N>>,
}

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

impl<T: Real, const N: usize> MemberTable<T, N> {
    /// The rows of a table of systems `L`.
    ///
    /// # Errors
    /// [`EnsembleError::Resume`] for what is no row of this system, equations and all, and where rows are of different runs.
    pub fn read<L, const M: usize>(table: &str) -> Result<Self, Error>
    where
        L: Lagrangian<N, M, Scalar = T>,
        T: FromStr,
    {
        Self::of(table, L::COORDINATES, Fingerprint::of_system::<L, N, M>(), usize::MAX)
    }

    /// Of an ensemble of so many members of a system with these coordinates and this [hash](Fingerprint::system).
    pub(super) fn of(table: &str, names: [&'static str; N], system: u32, count: usize) -> Result<Self, Error>
    where
        T: FromStr,
    {
        let wrong = |line, column, reason| Error::Ensemble(EnsembleError::Resume { line, column, reason });
        Self::gather(names, system, read(table, &names, count)?, wrong)
    }

    /// Of rows with their places, all of one run. `wrong` says that a column of the row in a place is of another.
    pub(super) fn gather<X>(
        names: [&'static str; N],
        system: u32,
        rows: impl IntoIterator<Item = (X, MemberRow<T, N>)>,
        wrong: impl Fn(X, usize, &'static str) -> Error,
    ) -> Result<Self, Error> {
        let mut kept: BTreeMap<usize, MemberRow<T, N>> = BTreeMap::new();
        let mut first: Option<Fingerprint> = None;
        for (place, row) in rows {
            let common = row.fingerprint.without_start();
            let known = kept.get_mut(&row.index);
            let run = first.get_or_insert(Fingerprint { system, ..common }).difference(&common);
            let start = known.as_ref().and_then(|known| known.fingerprint.difference(&row.fingerprint));
            if let Some((column, reason)) = run.or(start) {
                return Err(wrong(place, column, reason));
            }
            match known {
                None => drop(kept.insert(row.index, row)),
                Some(known) if known.has_failed() => *known = row,
                Some(_) => {}
            }
        }
        Ok(Self { names, rows: kept.into_values().collect() })
    }

    /// The rows, by member.
    pub fn rows(&self) -> &[MemberRow<T, N>] {
        &self.rows
    }

    /// The row of the member of this index, if there is one.
    pub fn get(&self, index: usize) -> Option<&MemberRow<T, N>> {
        self.rows.get(self.rows.binary_search_by_key(&index, |row| row.index).ok()?)
    }

    pub(super) fn into_rows(self) -> impl Iterator<Item = MemberRow<T, N>> {
        self.rows.into_iter()
    }
}

impl<T: Real, const N: usize> Display for MemberTable<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Lines { names: &self.names, members: &self.rows, line: MemberRow::csv }.fmt(f)
    }
}

impl<T: Real, const N: usize> MemberRow<T, N> {
    /// Whether something other than the observer or an event kept it from the end.
    pub fn has_failed(&self) -> bool {
        matches!(self.ending, MemberEnding::Failed(_))
    }

    /// The member that it is the row of, in an ensemble with these events. What went wrong is known in words only.
    pub(super) fn into_member(self, events: &[&'static str]) -> Member<T, N> {
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

const COMPLETE: &str = "complete";
const CANCELLED: &str = "cancelled";
const EVENT: &str = "event: ";

/// The whole table.
struct Lines<'o, X, F, const N: usize> {
    names: &'o [&'static str; N],
    members: &'o [X],
    line: F,
}

impl<'o, X, D: Display, F: Fn(&'o X) -> D, const N: usize> Display for Lines<'o, X, F, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", header(self.names))?;
        self.members.iter().try_for_each(|member| write!(f, "{}", (self.line)(member)))
    }
}

fn header<const N: usize>(names: &[&'static str; N]) -> String {
    let velocities = names.iter().map(|name| Entry::Velocity(name).to_string());
    let first = ["member", "system", "run", "start", "t"];
    let names = first.into_iter().chain(names.iter().copied()).map(String::from).chain(velocities);
    let counts = ["accepted", "rejected", "evaluations", "multipliers_are_unique", "ending", "member_again"]
        .map(String::from);
    names.chain(counts).collect::<Vec<_>>().join(",")
}

/// One line of it. The index stands at both ends: a line that was not written to its end, and the row that is then
/// appended to it, do not pass for a row of a third member.
struct Line<'m, T: Real, const N: usize>(Cow<'m, MemberRow<T, N>>);

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

#[cfg(test)]
mod tests;
