//! Tables of members as JSON lines: written and read.

use core::fmt::{self, Display, Formatter};
use core::slice;
use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Serialize;
use serde::de::IgnoredAny;

use super::fingerprint::Fingerprint;
use super::line::Line;
use super::names::ColumnNames;
use super::outcome::{Member, Outcome};
use super::row::{MemberRow, TWO_RESULTS};
use super::settings::Ensemble;
use crate::Lagrangian;
use crate::error::{EnsembleError, Error};
use crate::generic::{Element, StaticLength};
use crate::number::Real;

/// Prints each item as an object of JSON on a line of its own.
struct JsonLines<'m, R>(&'m [R]);

impl<R: Serialize> Display for JsonLines<'_, R> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.0
            .iter()
            .try_for_each(|row| writeln!(f, "{}", serde_json::to_string(row).map_err(|_| fmt::Error)?))
    }
}

impl<T: Real, N: StaticLength> Member<T, N> {
    /// The member's [row](MemberRow) as a line of JSON, to be written as soon as the member is finished.
    pub fn json_line(&self) -> impl Display + '_ {
        JsonLines(slice::from_ref(self))
    }
}

impl<T: Real, N: StaticLength> MemberRow<T, N> {
    /// The row as a line of JSON.
    pub fn json_line(&self) -> impl Display + '_ {
        JsonLines(slice::from_ref(self))
    }
}

impl<T: Real, N: StaticLength> Outcome<T, N> {
    /// Table as JSON lines, one [row](MemberRow) per member. Numbers have the fewest digits that read back to the same value.
    /// [`MemberTable`] reads the table.
    ///
    /// In Python, `pandas.DataFrame(json.loads(line)["samples"])` is the table of the samples of a member.
    pub fn json_lines(&self) -> impl Display + '_ {
        JsonLines(&self.members)
    }
}

/// A table of members, read back without integrating.
///
/// Accepts lines of [`Outcome::json_lines`] and [`Member::json_line`], in any order. Incomplete lines are dropped, even if
/// another row was appended to one: a row has all samples of its member, or it is none. If a member has several rows, the
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
/// let written = springs.integrate(1.0, Dop853::default())?.json_lines().to_string();
/// let torn = format!("{written}{written}{}", &written[..100]);
/// let table = MemberTable::read::<Spring<f64>>(&torn)?;
/// assert_eq!(table.to_string(), written);
/// for row in table.rows() {
///     assert_eq!(row.ending, MemberEnding::Complete);
///     println!("{}: {}", row.index, row.state.unwrap().q[0]);
/// }
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MemberTable<T: Element, N: StaticLength> {
    rows: Vec<MemberRow<T, N>>,
}

impl<T: Real, N: StaticLength> MemberTable<T, N> {
    /// Reads the rows of a table of systems `L`.
    ///
    /// # Errors
    /// [`EnsembleError::Resume`] if a line is no row of this system with these equations, if the rows are of different
    /// runs, or if two rows of a member that reached the end or an event have different numbers.
    pub fn read<L: Lagrangian<N = N, Scalar = T>>(table: &str) -> Result<Self, Error> {
        Self::of(table, L::COORDINATES, Fingerprint::of_system::<L>())
    }

    /// Reads the table of a system with these coordinates and this [hash](Fingerprint::system).
    fn of(table: &str, coordinates: &'static [&'static str], system: u32) -> Result<Self, Error> {
        let wrong = |line, reason: &str| EnsembleError::Resume { line, reason: reason.into() }.into();
        Self::gather(system, rows(table, coordinates)?, wrong)
    }

    /// Collects rows, each with its place in the source, and checks that all are of one run. `wrong` makes the error
    /// from the place of a row and the difference.
    pub(super) fn gather<X>(
        system: u32,
        rows: impl IntoIterator<Item = (X, MemberRow<T, N>)>,
        wrong: impl Fn(X, &str) -> Error,
    ) -> Result<Self, Error> {
        let mut kept: BTreeMap<usize, MemberRow<T, N>> = BTreeMap::new();
        let (mut first, mut names): (Option<Fingerprint>, Option<Arc<ColumnNames>>) = (None, None);
        for (place, row) in rows {
            let common = row.fingerprint.without_start();
            let known = kept.get_mut(&row.index);
            let run = first.get_or_insert(Fingerprint { system, ..common }).difference(&common);
            let start = known.as_ref().and_then(|known| known.fingerprint.difference(&row.fingerprint));
            if let Some(reason) = run.or(start) {
                return Err(wrong(place, reason));
            }
            // A row without samples does not name the quantities.
            if !row.samples.is_empty() && *names.get_or_insert_with(|| row.names.clone()) != row.names {
                return Err(wrong(place, "its quantities are others"));
            }
            match known {
                None => drop(kept.insert(row.index, row)),
                Some(known) if known.has_failed() => *known = row,
                Some(known) if known.contradicts(&row) => return Err(wrong(place, TWO_RESULTS)),
                Some(_) => {}
            }
        }
        let mut rows: Vec<_> = kept.into_values().collect();
        if let Some(names) = names {
            rows.iter_mut().for_each(|row| row.names = names.clone());
        }
        Ok(Self { rows })
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

impl<L: Lagrangian<Scalar: Real>, const HAS_DENSE_OUTPUT: bool> Ensemble<'_, L, HAS_DENSE_OUTPUT> {
    /// Skips the members that this table contains, and takes their rows over into the outcome. The table
    /// comes from [`Outcome::json_lines`] or from rows of [`Member::json_line`]; tables of several
    /// runs may be concatenated. Repeated calls add tables. If a member has several rows, the first counts.
    ///
    /// Members that are taken over have their samples, quantities and crossings. Members that failed are integrated again:
    /// with the same settings they fail in the same way, except at a limit on wall-clock time. Rows of another part are
    /// ignored. So are incomplete lines, even if another row was appended to one. A row is taken over only if its [`Fingerprint`] shows that it was computed from the same start and
    /// parameters, of the same equations, with the same method and settings (limits may differ) to the same end, with
    /// or without SIMD lanes as here, and under the same [tag](Self::tag). For this check all members of the table are
    /// made once more.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(x_dot^2/2 - k/2 * x^2)]
    /// struct Spring<T> { k: T }
    ///
    /// let springs = || Ensemble::from_fn(100, |n| (Spring { k: n as f64 }, State::at_rest([1.0])));
    /// let part = |k| springs().shard(k, 2).integrate(1.0, Dop853::default());
    /// let table = part(0)?.json_lines().to_string();
    /// let whole = springs().resume(&table)?.integrate(1.0, Dop853::default())?;
    /// assert_eq!(whole, part(0)?.merge(part(1)?)?);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`EnsembleError::Resume`] if a line is no row of this system, if the rows are of different runs, or if two rows of a
    /// member that reached the end or an event have different numbers. [`EnsembleError::NoSuchMember`] if the table
    /// contains a member that the ensemble does not have. [`integrate`](Self::integrate) returns [`EnsembleError::OtherRun`] for members of another run, end or start. It
    /// returns [`EnsembleError::Untagged`] if code that no fingerprint sees can change the members and there is no
    /// [tag](Self::tag).
    pub fn resume(self, table: &str) -> Result<Self, Error> {
        self.resume_from(MemberTable::read::<L>(table)?)
    }

    /// Skips the members of this table, like [`resume`](Self::resume), which parses the table as well.
    ///
    /// # Errors
    /// [`EnsembleError::NoSuchMember`] if the table contains a member that the ensemble does not have.
    pub fn resume_from(mut self, table: MemberTable<L::Scalar, L::N>) -> Result<Self, Error> {
        let count = self.plan.count;
        match table.rows().last() {
            Some(row) if row.index >= count => {
                Err(Error::Ensemble(EnsembleError::NoSuchMember { member: row.index, count }))
            }
            _ => {
                self.plan.done.extend(table.into_rows().filter(|row| !row.has_failed()));
                Ok(self)
            }
        }
    }
}

impl<T: Real, N: StaticLength> Display for MemberTable<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        JsonLines(&self.rows).fmt(f)
    }
}

/// Complete rows of a table, each with its line number, counted from 1. Incomplete rows are skipped.
pub(super) fn rows<T: Real, N: StaticLength>(
    table: &str,
    coordinates: &'static [&'static str],
) -> Result<Vec<(usize, MemberRow<T, N>)>, Error> {
    let mut names = Arc::new(ColumnNames::new(coordinates, Vec::new()));
    let mut rows = Vec::new();
    for (line, text) in (1..).zip(table.lines()) {
        let row = row(text, &mut names).map_err(|reason| EnsembleError::Resume { line, reason })?;
        rows.extend(row.map(|row| (line, row)));
    }
    Ok(rows)
}

/// Reads a row; `None` if its writer was interrupted.
fn row<T: Real, N: StaticLength>(
    text: &str,
    names: &mut Arc<ColumnNames>,
) -> Result<Option<MemberRow<T, N>>, String> {
    if !text.is_empty() && !text.starts_with('{') {
        return Err("a row is an object of JSON".into());
    }
    match serde_json::from_str::<Line<'_>>(text) {
        Ok(line) => line.into_row(names).map(Some).map_err(String::from),
        // An interrupted row has no closing brace, whatever was appended to it.
        Err(_) if serde_json::from_str::<IgnoredAny>(text).is_err() => Ok(None),
        Err(error) => Err(error.to_string().replace(" at line 1 column", " at column")),
    }
}

#[cfg(test)]
mod tests;
