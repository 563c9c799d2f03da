//! Converts table rows to Parquet columns and back.

use std::sync::Arc;

use super::file::{CROSSINGS, Column, END, FileFault, SAMPLES, Sheet, Values};
use crate::ensemble::fingerprint::Fingerprint;
use crate::ensemble::names::ColumnNames;
use crate::ensemble::table::{CROSSING, MemberCrossing, MemberRow, entries, entry, state_of};
use crate::linearized::Linearized;
use crate::number::Real;
use crate::statistics::Statistics;
use crate::system::{State, StateOf};
use crate::vector::{Element, Length};

/// Columns of these rows. `made` holds, for each row, the system and the initial state of its member.
pub(super) fn sheet<L: Linearized<Scalar: Real>>(
    rows: &[MemberRow<L::Scalar, L::N>],
    made: &[(L, StateOf<L>)],
    names: &ColumnNames,
) -> Sheet {
    let counts = [
        rows.iter().map(|row| usize::from(row.state.is_some())).collect(),
        rows.iter().map(|row| row.samples.len()).collect(),
        rows.iter().map(|row| row.crossings.len()).collect(),
    ];
    let mut columns = members(rows);
    columns.extend(states("start", names, made.iter().map(|(_, start)| start)));
    columns.extend(parameters(made));
    columns.extend(states(END, names, rows.iter().filter_map(|row| row.state.as_ref())));
    columns.extend(statistics(rows));
    columns.extend(states(SAMPLES, names, rows.iter().flat_map(|row| &row.samples)));
    columns.extend(quantities(rows, names));
    columns.extend(crossings(rows));
    let crossed = rows.iter().flat_map(|row| &row.crossings).map(|crossing| &crossing.state);
    columns.extend(states(CROSSINGS, names, crossed));
    Sheet { columns, counts }
}

fn column(group: &'static str, name: impl Into<String>, values: Values) -> Column {
    Column { group, name: name.into(), values }
}

fn integers(entries: impl Iterator<Item = usize>) -> Values {
    Values::Integers(entries.map(|x| x as i64).collect())
}

fn texts(entries: impl Iterator<Item = String>) -> Values {
    Values::Texts(entries.map(|text| text.into_bytes().into()).collect())
}

fn members<T: Element, N: Length>(rows: &[MemberRow<T, N>]) -> Vec<Column> {
    vec![
        column("", "member", integers(rows.iter().map(|row| row.index))),
        column("", "fingerprint", integers(rows.iter().map(|row| row.fingerprint.start as usize))),
        column("", "ending", texts(rows.iter().map(|row| row.ending.to_string()))),
    ]
}

fn parameters<L: Linearized<Scalar: Real>>(made: &[(L, StateOf<L>)]) -> impl Iterator<Item = Column> {
    let mut parameters = vec![Vec::new(); <L::P>::COUNT];
    for (system, _) in made {
        let mut columns = parameters.iter_mut();
        system.visit_parameters(&mut |_, x| columns.next().into_iter().for_each(|of| of.push(x.to_f64())));
    }
    let named = L::PARAMETERS.iter().zip(parameters);
    named.map(|(name, values)| column("parameters", *name, Values::Numbers(values)))
}

fn statistics<T: Element, N: Length>(rows: &[MemberRow<T, N>]) -> [Column; 4] {
    let ends = || rows.iter().filter(|row| row.state.is_some()).map(|row| &row.statistics);
    let are_unique = ends().map(|statistics| statistics.multipliers_are_unique).collect();
    [
        column(END, "accepted", integers(ends().map(|statistics| statistics.accepted))),
        column(END, "rejected", integers(ends().map(|statistics| statistics.rejected))),
        column(END, "evaluations", integers(ends().map(|statistics| statistics.evaluations))),
        column(END, "multipliers_are_unique", Values::Flags(are_unique)),
    ]
}

/// Columns of times, coordinates and velocities.
fn states<'s, T: Real, N: Length>(
    group: &'static str,
    names: &ColumnNames,
    states: impl Iterator<Item = &'s State<T, N>> + Clone,
) -> Vec<Column> {
    let numbers = |place: usize| states.clone().map(|state| entry(state, place).to_f64()).collect();
    let named = names.of_state().enumerate();
    named.map(|(place, name)| column(group, name, Values::Numbers(numbers(place)))).collect()
}

fn quantities<T: Real, N: Length>(rows: &[MemberRow<T, N>], names: &ColumnNames) -> Vec<Column> {
    let count = names.quantities.len();
    let numbers = |place: usize| {
        let of_row = |row: &'_ MemberRow<T, N>| {
            row.values.iter().skip(place).step_by(count).map(|x| x.to_f64()).collect::<Vec<_>>()
        };
        Values::Numbers(rows.iter().flat_map(of_row).collect())
    };
    let named = names.quantities.iter().enumerate();
    named.map(|(place, name)| column(SAMPLES, name, numbers(place))).collect()
}

fn crossings<T: Element, N: Length>(rows: &[MemberRow<T, N>]) -> Vec<Column> {
    let all = || rows.iter().flat_map(|row| &row.crossings);
    let values = [
        texts(all().map(|crossing| crossing.event.clone())),
        integers(all().map(|crossing| crossing.index)),
        integers(all().map(|crossing| crossing.count)),
        Values::Flags(all().map(|crossing| crossing.rising).collect()),
    ];
    CROSSING.into_iter().zip(values).map(|(name, values)| column(CROSSINGS, name, values)).collect()
}

/// Rows of a table, from the columns of a file and the fingerprint of member 0.
pub(super) fn rows<T: Real, N: Length>(
    sheet: &Sheet,
    first: Fingerprint,
    names: &Arc<ColumnNames>,
) -> Result<Vec<MemberRow<T, N>>, FileFault> {
    let [members, end, samples, crossings] = ["", END, SAMPLES, CROSSINGS].map(|name| sheet.group(name));
    let mut reader = Reader { members, end, samples, crossings, read: [0; 3], first, names };
    let [ends, samples, crossings] = &sheet.counts;
    let counts = ends.iter().zip(samples).zip(crossings).enumerate();
    let rows: Option<Vec<_>> = counts
        .map(|(k, ((ends, samples), crossings))| reader.row(k, [*ends, *samples, *crossings]))
        .collect();
    rows.ok_or(FileFault::Damaged("a number in it is none".into()))
}

/// Index and fingerprint of each member in a file whose member 0 has the fingerprint `first`.
pub(super) fn fingerprints(sheet: &Sheet, first: Fingerprint) -> impl Iterator<Item = (usize, Fingerprint)> {
    let members = sheet.group("");
    (0..).map_while(move |k| member(&members, k, first))
}

/// Index and fingerprint in row `k` of the columns of members.
fn member(members: &[&Values], k: usize, first: Fingerprint) -> Option<(usize, Fingerprint)> {
    let [index, start, ..] = members else { return None };
    Some((index.count(k)?, Fingerprint { start: start.count(k)?.try_into().ok()?, ..first }))
}

/// Columns of each group, read row by row.
struct Reader<'s> {
    members: Vec<&'s Values>,
    end: Vec<&'s Values>,
    samples: Vec<&'s Values>,
    crossings: Vec<&'s Values>,
    /// Numbers of entries of the last three groups that were read.
    read: [usize; 3],
    first: Fingerprint,
    names: &'s Arc<ColumnNames>,
}

impl Reader<'_> {
    /// Row `k`, which has this many ends, samples and crossings.
    fn row<T: Real, N: Length>(&mut self, k: usize, counts: [usize; 3]) -> Option<MemberRow<T, N>> {
        let [ends, samples, crossings] =
            [0, 1, 2].map(|group| self.read[group]..self.read[group] + counts[group]);
        self.read = [ends.end, samples.end, crossings.end];
        let (state_at_end, statistics) = match ends.is_empty() {
            true => (None, Statistics::default()),
            false => (Some(state(&self.end, ends.start)?), self.statistics::<N>(ends.start)?),
        };
        let quantities = self.samples.get(entries::<N>()..)?;
        let values = samples.clone().flat_map(|place| quantities.iter().map(move |of| of.number(place)));
        let (index, fingerprint) = member(&self.members, k, self.first)?;
        Some(MemberRow {
            index,
            fingerprint,
            state: state_at_end,
            statistics,
            ending: self.members[2].text(k)?.into(),
            values: values.map(|x| x.map(T::constant)).collect::<Option<_>>()?,
            samples: samples.map(|place| state(&self.samples, place)).collect::<Option<_>>()?,
            crossings: crossings.map(|place| self.crossing(place)).collect::<Option<_>>()?,
            names: self.names.clone(),
        })
    }

    fn statistics<N: Length>(&self, place: usize) -> Option<Statistics> {
        let [accepted, rejected, evaluations, are_unique] = self.end.get(entries::<N>()..)? else {
            return None;
        };
        Some(Statistics {
            accepted: accepted.count(place)?,
            rejected: rejected.count(place)?,
            evaluations: evaluations.count(place)?,
            multipliers_are_unique: are_unique.flag(place)?,
        })
    }

    fn crossing<T: Real, N: Length>(&self, place: usize) -> Option<MemberCrossing<T, N>> {
        let [event, index, count, rising, of_state @ ..] = &self.crossings[..] else { return None };
        Some(MemberCrossing {
            event: event.text(place)?.into(),
            index: index.count(place)?,
            count: count.count(place)?,
            rising: rising.flag(place)?,
            state: state(of_state, place)?,
        })
    }
}

/// State in the row `place` of the columns of time, coordinates and velocities.
fn state<T: Real, N: Length>(columns: &[&Values], place: usize) -> Option<State<T, N>> {
    let number = |k: usize| columns[k].number(place).filter(|x| x.is_finite()).map(T::constant).ok_or(());
    state_of(number).ok()
}
