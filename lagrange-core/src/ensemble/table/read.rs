//! Parses the rows of a table.

use core::str::FromStr;

use super::row::{CANCELLED, COMPLETE, MemberEnding, MemberRow, header};
use crate::ensemble::fingerprint::Fingerprint;
use crate::error::{EnsembleError, Error};
use crate::number::Real;
use crate::statistics::Statistics;
use crate::system::State;
use crate::vector::{Array, Length, vector};

/// Column number, counted from 1, and the reason why its cell is rejected.
type Wrong = (usize, &'static str);

/// Complete rows of a table, each with its line number, counted from 1. Incomplete rows are skipped.
pub(crate) fn read<T: Real + FromStr, N: Length>(
    table: &str,
    names: &'static [&'static str],
    count: usize,
) -> Result<Vec<(usize, MemberRow<T, N>)>, Error> {
    let header = header(names);
    let mut rows = Vec::new();
    // Spreadsheets write a byte-order mark before the first line.
    let table = table.strip_prefix('\u{feff}').unwrap_or(table);
    for (line, text) in (1..).zip(table.lines()) {
        let text = text.strip_suffix('\r').unwrap_or(text);
        let read = match text.trim_start_matches(|digit: char| digit.is_ascii_digit()) {
            // A row cut off within its first number, followed by the header of the next table.
            rest if rest == header => Ok(None),
            _ if text.starts_with('m') => check_header::<N>(text, &header).map(|()| None),
            _ => row(text, count),
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

/// Reads a row; `None` if it is incomplete.
fn row<T: Real + FromStr, N: Length>(text: &str, count: usize) -> Result<Option<MemberRow<T, N>>, Wrong> {
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
        text => unquoted(text).ok_or((2 * N::COUNT + 10, UNREADABLE))?.as_str().into(),
    };
    let has_motion = !matches!(ending, MemberEnding::Failed(_)) || !cells[3].is_empty();
    let (state, statistics) = match has_motion {
        true => (Some(state(&cells)?), statistics::<N>(&cells)?),
        false => (None, Statistics::default()),
    };
    Ok(Some(MemberRow { index, fingerprint, state, statistics, ending }))
}

/// Cells between the two indices of a complete row; `None` if the row is incomplete.
fn whole<N: Length>(text: &str) -> Option<Vec<&str>> {
    let (index, rest) = text.split_once(',')?;
    let (rest, again) = rest.rsplit_once(',')?;
    let cells: Vec<&str> = rest.splitn(2 * N::COUNT + 9, ',').collect();
    let ending = cells.get(2 * N::COUNT + 8)?;
    let is_whole = if ending.starts_with('"') { unquoted(ending).is_some() } else { !ending.contains(',') };
    (index == again && is_whole).then_some(cells)
}

/// Text between the quotes, unescaped; `None` if the closing quote is missing or comes too early.
fn unquoted(text: &str) -> Option<String> {
    let inner = text.strip_prefix('"')?.strip_suffix('"')?;
    (!inner.replace("\"\"", "").contains('"')).then(|| inner.replace("\"\"", "\""))
}

fn state<T: Real + FromStr, N: Length>(cells: &[&str]) -> Result<State<T, N>, Wrong> {
    let number = |k: usize| {
        let number = cells[k].parse().ok().filter(|x: &T| x.is_finite());
        number.ok_or((k + 2, "it is no finite number"))
    };
    let zero = Array::filled(T::constant(0.0));
    let mut state = State { t: number(3)?, q: vector(zero), v: vector(zero) };
    for i in 0..N::COUNT {
        (state.q[i], state.v[i]) = (number(4 + i)?, number(4 + N::COUNT + i)?);
    }
    Ok(state)
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
