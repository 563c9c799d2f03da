//! Tables of members as comma-separated values: written and read.

mod cells;
mod read;
mod row;

use core::fmt::{self, Display, Formatter};
use core::str::FromStr;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::fingerprint::Fingerprint;
use super::names::ColumnNames;
use super::outcome::{Member, Outcome};
use crate::error::{Ending, EnsembleError, Error};
use crate::motion::record::Arrival;
use crate::number::Real;
use crate::system::Lagrangian;
use crate::vector::{Element, Length};

pub(super) use read::read;
#[cfg(feature = "parquet")]
pub(super) use row::CROSSING;
use row::{Line, header};
pub use row::{MemberCrossing, MemberEnding, MemberRow};
#[cfg(any(feature = "parquet", feature = "mpi"))]
pub(super) use row::{entries, entry, state_of};

impl<T: Real, N: Length> Member<T, N> {
    /// The member's row of a table.
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
            samples: arrival.map(|arrival| arrival.samples.clone()).unwrap_or_default(),
            values: arrival.map(|arrival| arrival.values.clone()).unwrap_or_default(),
            crossings: arrival.into_iter().flat_map(|arrival| &arrival.crossings).map(Into::into).collect(),
            names: self.names.clone(),
        }
    }

    /// The member's row of the table [`Outcome::csv`], to be written as soon as the member is finished.
    pub fn csv(&self) -> impl Display + '_ {
        Line(Cow::Owned(self.row()))
    }
}

impl<T: Real, N: Length> Outcome<T, N> {
    /// Table as comma-separated values, one line per member. The columns are `member`, its [`Fingerprint`] as `system`,
    /// `run` and `start`, `t`, coordinates `x` and velocities `x_dot` of the last state, the
    /// [`Statistics`](crate::Statistics), `ending`, `samples`, `crossings`, and `member_again`, which marks a line as
    /// complete. The fingerprint takes at most 33 bytes of a line.
    ///
    /// The ending is `complete`, `cancelled`, `event: ` and the event's name, or the message of the error, with line breaks
    /// as `\u000a` and `\` as `\\`. Numbers have the fewest digits that read back to the same value. [`MemberTable`] reads
    /// the table.
    ///
    /// Samples and crossings are JSON, an object of lists: `{"t":[0.0,0.5],"x":[1.0,0.7],"x_dot":[0.0,-1.1],"energy":[0.5,0.5]}`
    /// has two samples with the quantity `energy`. Lists of crossings are `event` (its name), `event_index`, `event_count`,
    /// `event_rising` and the state. A cell is empty if there is nothing in it. NaN is `null`, infinities are ±`1e999`.
    /// In Python, `pandas.DataFrame(json.loads(cell))` is the table of the samples of a member.
    pub fn csv(&self) -> impl Display + '_ {
        Lines { names: &self.names, members: &self.members, line: Member::csv }
    }
}

/// A table of members, read back from its text without integrating.
///
/// Accepts the output of [`Outcome::csv`] and [`Member::csv`]: one table, several concatenated, or rows without a
/// header. Incomplete lines are dropped, even if another row was appended to one: a row has all samples of its member, or it
/// is none. If a member has several rows, the first that did not fail counts; if all failed, the last. The `Display`
/// writes the table with these rows, ordered by member.
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
/// let table = MemberTable::read::<Spring<f64>>(&torn)?;
/// assert_eq!(table.to_string(), written);
/// for row in table.rows() {
///     assert_eq!(row.ending, MemberEnding::Complete);
///     println!("{}: {}", row.index, row.state.unwrap().q[0]);
/// }
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MemberTable<T: Element, N: Length> {
    names: Arc<ColumnNames>,
    rows: Vec<MemberRow<T, N>>,
}

impl<T: Real, N: Length> MemberTable<T, N> {
    /// Reads the rows of a table of systems `L`.
    ///
    /// # Errors
    /// [`EnsembleError::Resume`] if a line is no row of this system with these equations, if the rows are of different
    /// runs, or if two rows of a member that reached the end or an event have different numbers.
    pub fn read<L>(table: &str) -> Result<Self, Error>
    where
        L: Lagrangian<N = N, Scalar = T>,
        T: FromStr,
    {
        Self::of(table, L::COORDINATES, Fingerprint::of_system::<L>(), usize::MAX)
    }

    /// Reads the table of an ensemble of `count` members of a system with the coordinates `names` and the
    /// [hash](Fingerprint::system) `system`.
    pub(super) fn of(
        table: &str,
        coordinates: &'static [&'static str],
        system: u32,
        count: usize,
    ) -> Result<Self, Error>
    where
        T: FromStr,
    {
        let wrong = |line, column, reason| Error::Ensemble(EnsembleError::Resume { line, column, reason });
        Self::gather(coordinates, system, read(table, coordinates, count)?, wrong)
    }

    /// Collects rows, each with its place in the source, and checks that all are of one run. `wrong` makes the error
    /// from the place of a row, the differing column and the difference.
    pub(super) fn gather<X>(
        coordinates: &'static [&'static str],
        system: u32,
        rows: impl IntoIterator<Item = (X, MemberRow<T, N>)>,
        wrong: impl Fn(X, usize, &'static str) -> Error,
    ) -> Result<Self, Error> {
        let mut kept: BTreeMap<usize, MemberRow<T, N>> = BTreeMap::new();
        let (mut first, mut names): (Option<Fingerprint>, Option<Arc<ColumnNames>>) = (None, None);
        for (place, row) in rows {
            let common = row.fingerprint.without_start();
            let known = kept.get_mut(&row.index);
            let run = first.get_or_insert(Fingerprint { system, ..common }).difference(&common);
            let start = known.as_ref().and_then(|known| known.fingerprint.difference(&row.fingerprint));
            if let Some((column, reason)) = run.or(start) {
                return Err(wrong(place, column, reason));
            }
            // A line of a member without samples does not name the quantities.
            let names_quantities = !row.samples.is_empty() || !row.names.quantities.is_empty();
            if names_quantities && *names.get_or_insert_with(|| row.names.clone()) != row.names {
                return Err(wrong(place, 2 * N::COUNT + 11, "its quantities are others"));
            }
            match known {
                None => drop(kept.insert(row.index, row)),
                Some(known) if known.has_failed() => *known = row,
                Some(known) if known.contradicts(&row) => return Err(wrong(place, 1, TWO_RESULTS)),
                Some(_) => {}
            }
        }
        let names = names.unwrap_or_else(|| Arc::new(ColumnNames { coordinates, quantities: Vec::new() }));
        kept.values_mut().for_each(|row| row.names = names.clone());
        Ok(Self { names, rows: kept.into_values().collect() })
    }

    /// Rows in ascending order of member.
    pub fn rows(&self) -> &[MemberRow<T, N>] {
        &self.rows
    }

    /// The row of the member of this index; `None` if the table has none.
    pub fn get(&self, index: usize) -> Option<&MemberRow<T, N>> {
        self.rows.get(self.rows.binary_search_by_key(&index, |row| row.index).ok()?)
    }

    pub(super) fn into_rows(self) -> impl Iterator<Item = MemberRow<T, N>> {
        self.rows.into_iter()
    }
}

impl<T: Real, N: Length> Display for MemberTable<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Lines { names: &self.names, members: &self.rows, line: MemberRow::csv }.fmt(f)
    }
}

pub(super) const TWO_RESULTS: &str = "an earlier row of the member has another result: other code, or a library with other roundings, was at work";

/// Prints the header, then one line per member.
struct Lines<'o, X, F> {
    names: &'o ColumnNames,
    members: &'o [X],
    line: F,
}

impl<'o, X, D: Display, F: Fn(&'o X) -> D> Display for Lines<'o, X, F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", header(self.names))?;
        self.members.iter().try_for_each(|member| write!(f, "{}", (self.line)(member)))
    }
}

#[cfg(test)]
mod tests;
