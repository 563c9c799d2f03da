//! Converts table rows to Parquet columns and back.

use super::file::{Column, END, FileFault, Values};
use crate::ensemble::fingerprint::Fingerprint;
use crate::ensemble::table::MemberRow;
use crate::linearized::Linearized;
use crate::names::Entry;
use crate::number::Real;
use crate::statistics::Statistics;
use crate::system::{State, StateOf};
use crate::vector::{Array, Length, vector};

/// Columns of these rows. `made` holds, for each row, the system and the initial state of its member.
pub(super) fn columns<L: Linearized<Scalar: Real>>(
    rows: &[MemberRow<L::Scalar, L::N>],
    made: &[(L, StateOf<L>)],
) -> Vec<Column> {
    let integers = |group, name: &str, values: Vec<i64>| Column {
        group,
        name: name.into(),
        values: Values::Integers(values),
    };
    let endings = rows.iter().map(|row| row.ending.to_string().into_bytes().into()).collect();
    let mut columns = vec![
        integers("", "member", rows.iter().map(|row| row.index as i64).collect()),
        integers("", "fingerprint", rows.iter().map(|row| i64::from(row.fingerprint.start)).collect()),
        Column { group: "", name: "ending".into(), values: Values::Texts(endings) },
    ];
    columns.extend(states::<L>("start", &made.iter().map(|(_, start)| start).collect::<Vec<_>>()));
    let mut parameters = vec![Vec::new(); <L::P>::COUNT];
    for (system, _) in made {
        let mut columns = parameters.iter_mut();
        system.visit_parameters(&mut |_, x| columns.next().into_iter().for_each(|of| of.push(x.to_f64())));
    }
    columns.extend(L::PARAMETERS.iter().zip(parameters).map(|(name, values)| Column {
        group: "parameters",
        name: (*name).into(),
        values: Values::Numbers(values),
    }));
    let ends = || rows.iter().filter_map(|row| Some((row.state.as_ref()?, &row.statistics)));
    columns.extend(states::<L>(END, &ends().map(|(state, _)| state).collect::<Vec<_>>()));
    let count = |name, of: fn(&Statistics) -> usize| {
        integers(END, name, ends().map(|(_, statistics)| of(statistics) as i64).collect())
    };
    columns.extend([
        count("accepted", |statistics| statistics.accepted),
        count("rejected", |statistics| statistics.rejected),
        count("evaluations", |statistics| statistics.evaluations),
    ]);
    let flags = ends().map(|(_, statistics)| statistics.multipliers_are_unique).collect();
    let name = "multipliers_are_unique".into();
    columns.push(Column { group: END, name, values: Values::Flags(flags) });
    columns
}

/// Rows of a table, from its columns, the flags `has_end` and the fingerprint of member 0.
pub(super) fn rows<T: Real, N: Length, P: Length>(
    (columns, has_end, first): &(Vec<Column>, Vec<bool>, Fingerprint),
) -> Result<Vec<MemberRow<T, N>>, FileFault> {
    let [members, starts, endings] = &columns[..3] else {
        return Err(FileFault::Other("it has no rows".into()));
    };
    let end = &columns[3 + 2 * N::COUNT + 1 + P::COUNT..];
    let mut ends = 0..;
    let row = |k: usize| -> Option<MemberRow<T, N>> {
        let place = if has_end[k] { ends.next() } else { None };
        let count = |column: usize, place: usize| end[2 * N::COUNT + 1 + column].values.integer(place);
        let statistics = |place: usize| {
            Some(Statistics {
                accepted: count(0, place)?.try_into().ok()?,
                rejected: count(1, place)?.try_into().ok()?,
                evaluations: count(2, place)?.try_into().ok()?,
                multipliers_are_unique: end[2 * N::COUNT + 4].values.flag(place)?,
            })
        };
        let (state, statistics) = match place {
            Some(place) => (Some(state(end, place)?), statistics(place)?),
            None => (None, Statistics::default()),
        };
        Some(MemberRow {
            index: members.values.integer(k)?.try_into().ok()?,
            fingerprint: Fingerprint { start: starts.values.integer(k)?.try_into().ok()?, ..*first },
            state,
            statistics,
            ending: endings.values.text(k)?.into(),
        })
    };
    let rows: Option<Vec<_>> = (0..has_end.len()).map(row).collect();
    rows.ok_or(FileFault::Damaged("a number in it is none".into()))
}

/// Columns of times, coordinates and velocities.
fn states<L: Linearized<Scalar: Real>>(
    group: &'static str,
    states: &[&StateOf<L>],
) -> impl Iterator<Item = Column> {
    let column = move |name: String, entry: &dyn Fn(&StateOf<L>) -> L::Scalar| Column {
        group,
        name,
        values: Values::Numbers(states.iter().map(|state| entry(state).to_f64()).collect()),
    };
    let names = L::COORDINATES;
    let coordinates: Vec<_> =
        (0..<L::N>::COUNT).map(|i| column(names[i].into(), &|state| state.q[i])).collect();
    let velocity = |i: usize| Entry::Velocity(names[i]).to_string();
    let velocities: Vec<_> = (0..<L::N>::COUNT).map(|i| column(velocity(i), &|state| state.v[i])).collect();
    core::iter::once(column("t".into(), &|state| state.t)).chain(coordinates).chain(velocities)
}

/// State in the row `place` of the columns of time, coordinates and velocities.
fn state<T: Real, N: Length>(columns: &[Column], place: usize) -> Option<State<T, N>> {
    let number = |k: usize| columns[k].values.number(place).filter(|x| x.is_finite()).map(T::constant);
    let zero = vector(Array::filled(T::constant(0.0)));
    let mut state = State { t: number(0)?, q: zero, v: zero };
    for i in 0..N::COUNT {
        (state.q[i], state.v[i]) = (number(1 + i)?, number(1 + N::COUNT + i)?);
    }
    Some(state)
}
