//! Tables of members as comma-separated values: written and read.

mod read;
mod row;

use core::fmt::{self, Display, Formatter};
use core::str::FromStr;
use std::borrow::Cow;
use std::collections::BTreeMap;

use super::fingerprint::Fingerprint;
use super::outcome::{Member, Outcome};
use crate::error::{Ending, EnsembleError, Error};
use crate::motion::record::Arrival;
use crate::number::Real;
use crate::system::Lagrangian;
use crate::vector::{Element, Length};

pub(super) use read::read;
use row::{Line, header};
pub use row::{MemberEnding, MemberRow};

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
    /// [`Statistics`](crate::Statistics), `ending`, and `member_again`, which marks a line as complete. The fingerprint
    /// takes at most 33 bytes of a line.
    ///
    /// The ending is `complete`, `cancelled`, `event: ` and the event's name, or the message of the error. Numbers have
    /// the fewest digits that read back to the same value. [`MemberTable`] reads the table.
    pub fn csv(&self) -> impl Display + '_ {
        Lines { names: self.names, members: &self.members, line: Member::csv }
    }
}

/// A table of members, read back from its text without integrating.
///
/// Accepts the output of [`Outcome::csv`] and [`Member::csv`]: one table, several concatenated, or rows without a
/// header. Incomplete lines are dropped, even if another row was appended to one. If a member has several rows, the
/// first that did not fail counts; if all failed, the last. The `Display` writes the table with these rows, ordered by
/// member.
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
    names: &'static [&'static str],
    rows: Vec<MemberRow<T, N>>,
}

impl<T: Real, N: Length> MemberTable<T, N> {
    /// Reads the rows of a table of systems `L`.
    ///
    /// # Errors
    /// [`EnsembleError::Resume`] if a line is no row of this system with these equations, or if the rows are of
    /// different runs.
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
        names: &'static [&'static str],
        system: u32,
        count: usize,
    ) -> Result<Self, Error>
    where
        T: FromStr,
    {
        let wrong = |line, column, reason| Error::Ensemble(EnsembleError::Resume { line, column, reason });
        Self::gather(names, system, read(table, names, count)?, wrong)
    }

    /// Collects rows, each with its place in the source, and checks that all are of one run. `wrong` makes the error
    /// from the place of a row, the differing column and the difference.
    pub(super) fn gather<X>(
        names: &'static [&'static str],
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
        Lines { names: self.names, members: &self.rows, line: MemberRow::csv }.fmt(f)
    }
}

/// Prints the header, then one line per member.
struct Lines<'o, X, F> {
    names: &'static [&'static str],
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
