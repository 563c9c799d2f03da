//! Parses the rows of a table.

use core::str::FromStr;
use std::sync::Arc;

use super::cells::{read_lists, read_text, split, unescaped, unquoted};
use super::row::{
    CANCELLED, COMPLETE, CROSSING, MemberCrossing, MemberEnding, MemberRow, entries, header, state_of,
};
use crate::ensemble::fingerprint::Fingerprint;
use crate::ensemble::names::ColumnNames;
use crate::error::{EnsembleError, Error};
use crate::number::Real;
use crate::statistics::Statistics;
use crate::system::State;
use crate::vector::Length;

/// Column number, counted from 1, and the reason why its cell is rejected.
type Wrong = (usize, &'static str);

/// Complete rows of a table, each with its line number, counted from 1. Incomplete rows are skipped.
pub(crate) fn read<T: Real + FromStr, N: Length>(
    table: &str,
    coordinates: &'static [&'static str],
    count: usize,
) -> Result<Vec<(usize, MemberRow<T, N>)>, Error> {
    let mut names = Arc::new(ColumnNames { coordinates, quantities: Vec::new() });
    let header = header(&names);
    let mut rows = Vec::new();
    // Spreadsheets write a byte-order mark before the first line.
    let table = table.strip_prefix('\u{feff}').unwrap_or(table);
    for (line, text) in (1..).zip(table.lines()) {
        let text = text.strip_suffix('\r').unwrap_or(text);
        let read = match text.trim_start_matches(|digit: char| digit.is_ascii_digit()) {
            // A row cut off within its first number, followed by the header of the next table.
            rest if rest == header => Ok(None),
            _ if text.starts_with('m') => check_header::<N>(text, &header).map(|()| None),
            _ => row(text, count, &mut names),
        };
        let row =
            read.map_err(|(column, reason)| Error::Ensemble(EnsembleError::Resume { line, column, reason }))?;
        rows.extend(row.map(|row| (line, row)));
    }
    Ok(rows)
}

/// Accepts the header, or a truncated header, even if another line was appended to it.
fn check_header<N: Length>(text: &str, header: &str) -> Result<(), Wrong> {
    let is_same = |(a, b): &(char, char)| a == b;
    let common: usize = text.chars().zip(header.chars()).take_while(is_same).map(|(a, _)| a.len_utf8()).sum();
    let starts_line = |rest: &str| rest.is_empty() || rest == header || whole::<N>(rest).is_some();
    match text[..common].char_indices().any(|(k, c)| starts_line(&text[k + c.len_utf8()..])) {
        true => Ok(()),
        false => Err((1 + text[..common].matches(',').count(), "its columns are others")),
    }
}

/// Reads a row; `None` if it is incomplete. `names` are those of the row before, and become those of this row.
fn row<T: Real + FromStr, N: Length>(
    text: &str,
    count: usize,
    names: &mut Arc<ColumnNames>,
) -> Result<Option<MemberRow<T, N>>, Wrong> {
    let (index, _) = text.split_once(',').unwrap_or((text, ""));
    if !index.chars().all(|digit| digit.is_ascii_digit()) || text.starts_with(',') {
        return Err((1, "a row starts with the index of a member"));
    }
    let Some(cells) = whole::<N>(text) else { return Ok(None) };
    let index = index.parse().ok().filter(|index| *index < count).ok_or((1, "there is no such member"))?;
    let fingerprint =
        Fingerprint { system: cell(&cells, 0)?, run: cell(&cells, 1)?, start: cell(&cells, 2)? };
    let ending = match cells[2 * N::COUNT + 8] {
        text @ (COMPLETE | CANCELLED) => text.into(),
        text => {
            let text = unquoted(text).and_then(|text| unescaped(&text));
            text.ok_or((2 * N::COUNT + 10, UNREADABLE))?.as_str().into()
        }
    };
    let has_motion = !matches!(ending, MemberEnding::Failed(_)) || !cells[3].is_empty();
    let (state, statistics) = match has_motion {
        true => (Some(state(&cells)?), statistics::<N>(&cells)?),
        false => (None, Statistics::default()),
    };
    let [samples, crossings] = [9, 10].map(|k| lists(&cells, 2 * N::COUNT + k));
    let (samples, values) = read_samples(&samples?, names).ok_or((2 * N::COUNT + 11, UNREADABLE))?;
    let crossings = read_crossings(&crossings?, names).ok_or((2 * N::COUNT + 12, UNREADABLE))?;
    let names = names.clone();
    Ok(Some(MemberRow { index, fingerprint, state, statistics, ending, samples, values, crossings, names }))
}

/// Text of an object of lists; empty for an empty cell.
fn lists(cells: &[&str], k: usize) -> Result<String, Wrong> {
    match cells[k] {
        "" => Ok(String::new()),
        cell => unquoted(cell).ok_or((k + 2, UNREADABLE)),
    }
}

/// Samples and their quantities; `names` receives the names of the quantities.
fn read_samples<T: Real + FromStr, N: Length>(
    object: &str,
    names: &mut Arc<ColumnNames>,
) -> Option<(Vec<State<T, N>>, Vec<T>)> {
    if object.is_empty() {
        return Some((Vec::new(), Vec::new()));
    }
    let lists = read_lists(object)?;
    let (of_state, quantities) = lists.split_at_checked(entries::<N>())?;
    if !quantities.iter().map(|(name, _)| name).eq(&names.quantities) {
        let quantities = quantities.iter().map(|(name, _)| name.clone()).collect();
        *names = Arc::new(ColumnNames { coordinates: names.coordinates, quantities });
    }
    let samples = read_states(of_state, names)?;
    let is_even = quantities.iter().all(|(_, items)| items.len() == samples.len());
    let values = (0..samples.len()).flat_map(|k| quantities.iter().map(move |(_, items)| number(items[k])));
    let values: Option<Vec<T>> = if is_even { values.collect() } else { None };
    Some((samples, values?))
}

fn read_crossings<T: Real + FromStr, N: Length>(
    object: &str,
    names: &ColumnNames,
) -> Option<Vec<MemberCrossing<T, N>>> {
    if object.is_empty() {
        return Some(Vec::new());
    }
    let lists = read_lists(object)?;
    let (own, of_state) = lists.split_at_checked(CROSSING.len())?;
    let states = read_states(of_state, names)?;
    let is_even = own.iter().all(|(_, items)| items.len() == states.len());
    if !is_even || !own.iter().map(|(name, _)| name.as_str()).eq(CROSSING) {
        return None;
    }
    let crossing = |(k, state)| {
        let cell = |list: usize| own[list].1[k];
        Some(MemberCrossing {
            event: read_text(cell(0))?,
            index: cell(1).parse().ok()?,
            count: cell(2).parse().ok()?,
            rising: cell(3).parse().ok()?,
            state,
        })
    };
    states.into_iter().enumerate().map(crossing).collect()
}

fn read_states<T: Real + FromStr, N: Length>(
    lists: &[(String, Vec<&str>)],
    names: &ColumnNames,
) -> Option<Vec<State<T, N>>> {
    let count = lists.first()?.1.len();
    let is_whole = lists.iter().all(|(_, items)| items.len() == count)
        && lists.iter().map(|(name, _)| name).eq(&names.of_state().collect::<Vec<_>>());
    let entry = |k: usize, list: usize| number(lists[list].1[k]).filter(T::is_finite).ok_or(());
    let states = (0..count).map(|k| state_of(|list| entry(k, list)).ok());
    if is_whole { states.collect() } else { None }
}

/// A number of JSON; `null` is NaN.
fn number<T: Real + FromStr>(item: &str) -> Option<T> {
    match item {
        "null" => Some(T::constant(f64::NAN)),
        item => item.parse().ok(),
    }
}

/// Cells between the two indices of a complete row; `None` if the row is incomplete.
fn whole<N: Length>(text: &str) -> Option<Vec<&str>> {
    let mut cells = split(text).filter(|cells| cells.len() == entries::<N>() + 12)?;
    (cells.remove(0) == cells.pop()?).then_some(cells)
}

fn state<T: Real + FromStr, N: Length>(cells: &[&str]) -> Result<State<T, N>, Wrong> {
    state_of(|k| {
        let number = cells[3 + k].parse().ok().filter(|x: &T| x.is_finite());
        number.ok_or((k + 5, "it is no finite number"))
    })
}

fn statistics<N: Length>(cells: &[&str]) -> Result<Statistics, Wrong> {
    Ok(Statistics {
        accepted: cell(cells, 2 * N::COUNT + 4)?,
        rejected: cell(cells, 2 * N::COUNT + 5)?,
        evaluations: cell(cells, 2 * N::COUNT + 6)?,
        multipliers_are_unique: cell(cells, 2 * N::COUNT + 7)?,
    })
}

const UNREADABLE: &str = "it cannot be read";

fn cell<V: FromStr>(cells: &[&str], k: usize) -> Result<V, Wrong> {
    cells[k].parse().map_err(|_| (k + 2, UNREADABLE))
}
