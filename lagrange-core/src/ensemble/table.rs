//! Outcomes as comma-separated values, and back.

use core::fmt::{self, Display, Formatter};
use core::str::FromStr;

use super::outcome::{Arrival, Member, Outcome};
use crate::ending::Ending;
use crate::error::Error;
use crate::names::Entry;
use crate::number::{Real, vector};
use crate::statistics::Statistics;
use crate::system::State;

impl<T: Real, const N: usize> Member<T, N> {
    /// Its row of the table [`Outcome::csv`], to be written as soon as the member is done.
    pub fn csv(&self) -> impl Display + '_ {
        Line(self)
    }
}

impl<T: Real, const N: usize> Outcome<T, N> {
    /// A table as comma-separated values, one line a member: `member`, `t`, coordinates `x` and velocities `x_dot` of
    /// the last state, the [`Statistics`], `ending`, and `member_again`, by which a line written to its end is known.
    ///
    /// The ending is `complete`, `cancelled` or what went wrong. Numbers are the shortest that read back the same.
    pub fn csv(&self) -> impl Display + '_ {
        Lines(self)
    }
}

/// The whole table.
struct Lines<'o, T, const N: usize>(&'o Outcome<T, N>);

impl<T: Real, const N: usize> Display for Lines<'_, T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", header(&self.0.names))?;
        self.0.members.iter().try_for_each(|member| write!(f, "{}", Line(member)))
    }
}

fn header<const N: usize>(names: &[&'static str; N]) -> String {
    let velocities = names.iter().map(|name| Entry::Velocity(name).to_string());
    let names = ["member", "t"].into_iter().chain(names.iter().copied()).map(String::from).chain(velocities);
    let counts = ["accepted", "rejected", "evaluations", "multipliers_are_unique", "ending", "member_again"]
        .map(String::from);
    names.chain(counts).collect::<Vec<_>>().join(",")
}

/// One line of it. The index stands at both ends: a line that was not written to its end, and the row that is then
/// appended to it, do not pass for a row of a third member.
struct Line<'m, T, const N: usize>(&'m Member<T, N>);

impl<T: Real, const N: usize> Display for Line<'_, T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let index = self.0.index;
        write!(f, "{index}")?;
        match &self.0.result {
            Err(error) => {
                (0..2 * N + 5).try_for_each(|_| write!(f, ","))?;
                write!(f, ",{}", quoted(&error.to_string()))?;
            }
            Ok(Arrival { state, ending, statistics }) => {
                // `Debug` of a number is its shortest form that reads back the same.
                write!(f, ",{:?}", state.t)?;
                state.q.iter().chain(&state.v).try_for_each(|x| write!(f, ",{x:?}"))?;
                let Statistics { accepted, rejected, evaluations, multipliers_are_unique } = statistics;
                write!(f, ",{accepted},{rejected},{evaluations},{multipliers_are_unique},")?;
                match ending {
                    Ending::Complete { .. } => write!(f, "complete")?,
                    Ending::Cancelled { .. } => write!(f, "cancelled")?,
                    other => write!(f, "{}", quoted(&other.to_string()))?,
                }
            }
        }
        writeln!(f, ",{index}")
    }
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// The column, counted from 1, and what is wrong there.
type Wrong = (usize, &'static str);

/// The members of a table that need not be done again.
pub(super) fn read<T: Real + FromStr, const N: usize>(
    table: &str,
    names: &[&'static str; N],
    count: usize,
) -> Result<Vec<Member<T, N>>, Error> {
    let header = header(names);
    let mut members = Vec::new();
    // Spreadsheets write a mark before the first line.
    let table = table.strip_prefix('\u{feff}').unwrap_or(table);
    for (line, text) in (1..).zip(table.lines()) {
        let text = text.strip_suffix('\r').unwrap_or(text);
        let read = match text.trim_start_matches(|digit: char| digit.is_ascii_digit()) {
            // A row that was cut in its first number, and the header of the next table.
            rest if rest == header => Ok(None),
            _ if text.starts_with('m') => check_header::<N>(text, &header).map(|()| None),
            _ => row(text, count),
        };
        members.extend(read.map_err(|(column, reason)| Error::Resume { line, column, reason })?);
    }
    Ok(members)
}

/// The header, or the beginning of one that was not written to its end, also where another line was appended to it.
fn check_header<const N: usize>(text: &str, header: &str) -> Result<(), Wrong> {
    let is_same = |(a, b): &(char, char)| a == b;
    let common: usize = text.chars().zip(header.chars()).take_while(is_same).map(|(a, _)| a.len_utf8()).sum();
    let starts_line = |rest: &str| rest.is_empty() || rest == header || whole::<N>(rest).is_some();
    match text[..common].char_indices().any(|(k, c)| starts_line(&text[k + c.len_utf8()..])) {
        true => Ok(()),
        false => Err((1 + text[..common].matches(',').count(), "its columns are others")),
    }
}

/// The member of a row; none if it failed, or if the row was not written to its end.
fn row<T: Real + FromStr, const N: usize>(text: &str, count: usize) -> Result<Option<Member<T, N>>, Wrong> {
    let (index, _) = text.split_once(',').unwrap_or((text, ""));
    if !index.chars().all(|digit| digit.is_ascii_digit()) || text.starts_with(',') {
        return Err((1, "a row starts with the index of a member"));
    }
    let Some(cells) = whole::<N>(text) else { return Ok(None) };
    let index = index.parse().ok().filter(|index| *index < count).ok_or((1, "there is no such member"))?;
    if cells.last().is_some_and(|ending| ending.starts_with('"')) {
        return Ok(None);
    }
    Ok(Some(Member { index, result: Ok(arrival(&cells)?) }))
}

/// The cells between the two indices of a row that was written to its end.
fn whole<const N: usize>(text: &str) -> Option<Vec<&str>> {
    let (index, rest) = text.split_once(',')?;
    let (rest, again) = rest.rsplit_once(',')?;
    let cells: Vec<&str> = rest.splitn(2 * N + 6, ',').collect();
    let ending = cells.get(2 * N + 5)?;
    (index == again && (ending.starts_with('"') || !ending.contains(','))).then_some(cells)
}

fn arrival<T: Real + FromStr, const N: usize>(cells: &[&str]) -> Result<Arrival<T, N>, Wrong> {
    let number = |k: usize| {
        let number = cells[k].parse().ok().filter(|x: &T| x.is_finite());
        number.ok_or((k + 2, "it is no finite number"))
    };
    let mut state =
        State { t: number(0)?, q: vector([T::constant(0.0); N]), v: vector([T::constant(0.0); N]) };
    for i in 0..N {
        (state.q[i], state.v[i]) = (number(1 + i)?, number(1 + N + i)?);
    }
    let statistics = Statistics {
        accepted: cell(cells, 2 * N + 1)?,
        rejected: cell(cells, 2 * N + 2)?,
        evaluations: cell(cells, 2 * N + 3)?,
        multipliers_are_unique: cell(cells, 2 * N + 4)?,
    };
    let time = state.t.to_f64();
    let ending = match cells[2 * N + 5] {
        "complete" => Ending::Complete { time },
        "cancelled" => Ending::Cancelled { time },
        _ => return Err((2 * N + 7, UNREADABLE)),
    };
    Ok(Arrival { state, ending, statistics })
}

const UNREADABLE: &str = "it cannot be read";

fn cell<V: FromStr>(cells: &[&str], k: usize) -> Result<V, Wrong> {
    cells[k].parse().map_err(|_| (k + 2, UNREADABLE))
}

#[cfg(test)]
mod tests;
