//! Outcomes as comma-separated values, and back.

use core::fmt::{self, Display, Formatter};
use core::str::FromStr;

use super::{Arrival, Member};
use crate::eliminate::vector;
use crate::names::Entry;
use crate::{Ending, Error, Real, State, Statistics};

/// The whole table.
pub(super) struct Csv<'o, T, const N: usize> {
    pub(super) members: &'o [Member<T, N>],
    pub(super) names: &'o [&'static str; N],
}

impl<T: Real, const N: usize> Display for Csv<'_, T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", header(self.names))?;
        self.members.iter().try_for_each(|member| write!(f, "{}", Row(member)))
    }
}

fn header<const N: usize>(names: &[&'static str; N]) -> String {
    let velocities = names.iter().map(|name| Entry::Velocity(name).to_string());
    let names = ["member", "t"].into_iter().chain(names.iter().copied()).map(String::from).chain(velocities);
    let counts =
        ["accepted", "rejected", "evaluations", "multipliers_are_unique", "ending"].map(String::from);
    names.chain(counts).collect::<Vec<_>>().join(",")
}

/// One line of it.
pub(super) struct Row<'m, T, const N: usize>(pub(super) &'m Member<T, N>);

impl<T: Real, const N: usize> Display for Row<'_, T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0.index)?;
        match &self.0.result {
            Err(error) => {
                (0..2 * N + 5).try_for_each(|_| write!(f, ","))?;
                writeln!(f, ",{}", quoted(&error.to_string()))
            }
            Ok(Arrival { state, ending, statistics }) => {
                // `Debug` of a number is its shortest form that reads back the same.
                write!(f, ",{:?}", state.t)?;
                state.q.iter().chain(&state.v).try_for_each(|x| write!(f, ",{x:?}"))?;
                let Statistics { accepted, rejected, evaluations, multipliers_are_unique } = statistics;
                write!(f, ",{accepted},{rejected},{evaluations},{multipliers_are_unique},")?;
                match ending {
                    Ending::Complete { .. } => writeln!(f, "complete"),
                    Ending::Cancelled { .. } => writeln!(f, "cancelled"),
                    other => writeln!(f, "{}", quoted(&other.to_string())),
                }
            }
        }
    }
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// The members of a table that need not be done again, with their lines.
pub(super) fn read<T: Real + FromStr, const N: usize>(
    table: &str,
    names: &[&'static str; N],
    count: usize,
) -> Result<Vec<(usize, Member<T, N>)>, Error> {
    let header = header(names);
    let mut members = Vec::new();
    for (line, text) in (1..).zip(table.split_inclusive('\n')) {
        // A line that was not written to its end is no line.
        let Some(text) = text.strip_suffix('\n') else { break };
        let text = text.strip_suffix('\r').unwrap_or(text);
        let wrong = |reason| Error::Resume { line, reason };
        if text.starts_with("member,") {
            if text != header {
                return Err(wrong("its coordinates are others"));
            }
            continue;
        }
        if let Some(member) = row(text).ok_or(wrong("it is no row of such a table"))? {
            if member.index >= count {
                return Err(wrong("there is no such member"));
            }
            members.push((line, member));
        }
    }
    Ok(members)
}

/// The member of a row, `Some(None)` if it failed; `None` for what is no row.
fn row<T: Real + FromStr, const N: usize>(text: &str) -> Option<Option<Member<T, N>>> {
    let mut cells = text.splitn(2 * N + 7, ',');
    let index = cells.next()?.parse().ok()?;
    let cells: Vec<&str> = cells.collect();
    let (numbers, rest) = cells.split_at_checked(2 * N + 1)?;
    let [accepted, rejected, evaluations, unique, ending] = rest else { return None };
    if ending.starts_with('"') {
        return Some(None);
    }
    let state: State<T, N> = state(numbers)?;
    let statistics = Statistics {
        accepted: accepted.parse().ok()?,
        rejected: rejected.parse().ok()?,
        evaluations: evaluations.parse().ok()?,
        multipliers_are_unique: unique.parse().ok()?,
    };
    let ending = ending_of(ending, state.t.to_f64())?;
    Some(Some(Member { index, result: Ok(Arrival { state, ending, statistics }) }))
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
