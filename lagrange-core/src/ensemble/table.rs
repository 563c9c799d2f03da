//! Outcomes as comma-separated values, and back.

use core::fmt::{self, Display, Formatter};
use core::str::FromStr;

use super::outcome::{Arrival, Member, Outcome};
use crate::error::Error;
use crate::names::Entry;
use crate::number::Real;
use crate::number::array::vector;
use crate::system::State;
use crate::trajectory::{Ending, Statistics};

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
        Lines { members: &self.members, names: &self.names }
    }
}

/// The whole table.
struct Lines<'o, T, const N: usize> {
    members: &'o [Member<T, N>],
    names: &'o [&'static str; N],
}

impl<T: Real, const N: usize> Display for Lines<'_, T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", header(self.names))?;
        self.members.iter().try_for_each(|member| write!(f, "{}", Line(member)))
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

/// The members of a table that need not be done again.
pub(super) fn read<T: Real + FromStr, const N: usize>(
    table: &str,
    names: &[&'static str; N],
    count: usize,
) -> Result<Vec<Member<T, N>>, Error> {
    let header = header(names);
    let mut members = Vec::new();
    for (line, text) in (1..).zip(table.split_inclusive('\n')) {
        let Some(text) = text.strip_suffix('\n') else { break };
        let text = text.strip_suffix('\r').unwrap_or(text);
        let read = match text.starts_with("member,") {
            true if text == header => Ok(None),
            true => Err("its columns are others"),
            false => row(text, count),
        };
        members.extend(read.map_err(|reason| Error::Resume { line, reason })?);
    }
    Ok(members)
}

/// The member of a row; none if it failed, or if the row was not written to its end.
fn row<T: Real + FromStr, const N: usize>(
    text: &str,
    count: usize,
) -> Result<Option<Member<T, N>>, &'static str> {
    const WRONG: &str = "it is no row of such a table";
    if !text.starts_with(|first: char| first.is_ascii_digit()) {
        return Err(WRONG);
    }
    let Some((index, cells)) = whole::<N>(text) else { return Ok(None) };
    if index >= count {
        return Err("there is no such member");
    }
    if cells.last().is_some_and(|ending| ending.starts_with('"')) {
        return Ok(None);
    }
    let arrival = arrival(&cells).ok_or(WRONG)?;
    Ok(Some(Member { index, result: Ok(arrival) }))
}

/// The cells between the two indices of a row that was written to its end.
fn whole<const N: usize>(text: &str) -> Option<(usize, Vec<&str>)> {
    let (index, rest) = text.split_once(',')?;
    let (rest, again) = rest.rsplit_once(',')?;
    let cells: Vec<&str> = rest.splitn(2 * N + 6, ',').collect();
    let ending = cells.get(2 * N + 5)?;
    let is_whole = index == again && (ending.starts_with('"') || !ending.contains(','));
    is_whole.then_some((index.parse().ok()?, cells))
}

fn arrival<T: Real + FromStr, const N: usize>(cells: &[&str]) -> Option<Arrival<T, N>> {
    let (numbers, rest) = cells.split_at_checked(2 * N + 1)?;
    let [accepted, rejected, evaluations, unique, ending] = rest else { return None };
    let state: State<T, N> = state(numbers)?;
    let statistics = Statistics {
        accepted: accepted.parse().ok()?,
        rejected: rejected.parse().ok()?,
        evaluations: evaluations.parse().ok()?,
        multipliers_are_unique: unique.parse().ok()?,
    };
    let ending = ending_of(ending, state.t.to_f64())?;
    Some(Arrival { state, ending, statistics })
}

/// t, q and q̇.
fn state<T: Real + FromStr, const N: usize>(cells: &[&str]) -> Option<State<T, N>> {
    let numbers: Option<Vec<T>> = cells.iter().map(|cell| cell.parse().ok()).collect();
    let numbers = numbers?;
    let (t, rest) = numbers.split_first()?;
    let (q, v) = rest.split_at_checked(N)?;
    Some(State { t: *t, q: vector(q.try_into().ok()?), v: vector(v.try_into().ok()?) })
}

fn ending_of(text: &str, time: f64) -> Option<Ending> {
    match text {
        "complete" => Some(Ending::Complete { time }),
        "cancelled" => Some(Ending::Cancelled { time }),
        _ => None,
    }
}
