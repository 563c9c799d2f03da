//! Serialized form of a row: JSON lines, Parquet files and messages of MPI hold this object.

use core::fmt::{self, Formatter};
use std::borrow::Cow;
use std::sync::Arc;

use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::fingerprint::Fingerprint;
use super::names::ColumnNames;
use super::outcome::Member;
use super::row::{MemberCrossing, MemberRow};
use crate::Statistics;
use crate::generic::{Array, State, StaticLength};
use crate::number::Real;
use crate::vector::vector;

/// A row, as serde writes and reads it.
#[derive(Serialize, Deserialize)]
pub(super) struct Line<'r> {
    member: usize,
    fingerprint: Fingerprint,
    ending: String,
    end: Option<NamedNumbers<'r>>,
    statistics: Statistics,
    samples: Vec<NamedNumbers<'r>>,
    crossings: Vec<CrossingLine<'r>>,
}

/// A crossing, as serde writes and reads it.
#[derive(Serialize, Deserialize)]
struct CrossingLine<'r> {
    event: Cow<'r, str>,
    index: usize,
    count: usize,
    rising: bool,
    state: NamedNumbers<'r>,
}

/// Numbers by name, in the order of their columns: an object.
#[derive(Default)]
pub(super) struct NamedNumbers<'r>(Vec<(Cow<'r, str>, f64)>);

/// A number, for formats without NaN and infinities: these are the texts "NaN", "inf" and "-inf".
pub(super) struct Number(pub(super) f64);

impl<'r> Line<'r> {
    pub(super) fn of<T: Real, N: StaticLength>(row: &'r MemberRow<T, N>) -> Self {
        let MemberRow { state, samples, values, crossings, names, .. } = row;
        // Without quantities there are no values, and each sample has an empty chunk of them.
        let values = values.chunks(names.quantities.len().max(1)).chain(core::iter::repeat(&[][..]));
        let sample = |(state, values): (&State<T, N>, &[T])| {
            let mut numbers = NamedNumbers::of(names, state);
            numbers.0.extend(NamedNumbers::named(&names.quantities, values.iter().copied()).0);
            numbers
        };
        let crossing = |crossing: &'r MemberCrossing<T, N>| CrossingLine {
            event: Cow::Borrowed(&crossing.event),
            index: crossing.index,
            count: crossing.count,
            rising: crossing.rising,
            state: NamedNumbers::of(names, &crossing.state),
        };
        Self {
            member: row.index,
            fingerprint: row.fingerprint,
            ending: row.ending.to_string(),
            end: state.as_ref().map(|state| NamedNumbers::of(names, state)),
            statistics: row.statistics,
            samples: samples.iter().zip(values).map(sample).collect(),
            crossings: crossings.iter().map(crossing).collect(),
        }
    }

    /// The row of this line. `names` are those of the row before, and become those of this row.
    ///
    /// # Errors
    /// The reason why the line is no row of this system.
    pub(super) fn into_row<T: Real, N: StaticLength>(
        self,
        names: &mut Arc<ColumnNames>,
    ) -> Result<MemberRow<T, N>, &'static str> {
        let Self { member, fingerprint, ending, end, statistics, samples, crossings } = self;
        if let Some(sample) = samples.first() {
            sample.name_quantities::<N>(names);
        }
        let (states, values) = read_samples(&samples, names)?;
        let crossing = |crossing: CrossingLine<'_>| {
            let CrossingLine { event, index, count, rising, state } = crossing;
            Ok(MemberCrossing {
                event: event.into(),
                index,
                count,
                rising,
                state: read_state(&state.0, names)?,
            })
        };
        Ok(MemberRow {
            index: member,
            fingerprint,
            state: end.map(|end| read_state(&end.0, names)).transpose()?,
            statistics,
            ending: ending.as_str().into(),
            samples: states,
            values,
            crossings: crossings.into_iter().map(crossing).collect::<Result<_, _>>()?,
            names: names.clone(),
        })
    }
}

/// States of samples, and the values of their quantities.
fn read_samples<T: Real, N: StaticLength>(
    samples: &[NamedNumbers<'_>],
    names: &ColumnNames,
) -> Result<(Vec<State<T, N>>, Vec<T>), &'static str> {
    let (mut states, mut values) = (Vec::with_capacity(samples.len()), Vec::new());
    for NamedNumbers(sample) in samples {
        let (of_state, of_quantities) = sample.split_at_checked(entries::<N>()).ok_or(OTHER_COLUMNS)?;
        states.push(read_state(of_state, names)?);
        if !of_quantities.iter().map(|(name, _)| name).eq(&names.quantities) {
            return Err(OTHER_COLUMNS);
        }
        values.extend(of_quantities.iter().map(|(_, x)| T::constant(*x)));
    }
    Ok((states, values))
}

/// The state of these numbers. All must be finite and in the order of their names.
fn read_state<T: Real, N: StaticLength>(
    numbers: &[(Cow<'_, str>, f64)],
    names: &ColumnNames,
) -> Result<State<T, N>, &'static str> {
    if numbers.len() != entries::<N>() || !numbers.iter().map(|(name, _)| name).eq(&names.state) {
        return Err(OTHER_COLUMNS);
    }
    let numbers = numbers.iter().map(|(_, x)| T::constant(*x));
    if !numbers.clone().all(|x| x.is_finite()) {
        return Err("a number of a state is not finite");
    }
    let zero = Array::<T, N>::filled(T::constant(0.0));
    let mut state = State { t: T::constant(0.0), q: vector(zero), v: vector(zero) };
    let entries = [&mut state.t].into_iter().chain(&mut state.q).chain(&mut state.v);
    entries.zip(numbers).for_each(|(entry, x)| *entry = x);
    Ok(state)
}

const OTHER_COLUMNS: &str = "its columns are others";

/// Number of entries of a state: time, coordinates, velocities.
const fn entries<N: StaticLength>() -> usize {
    1 + 2 * N::COUNT
}

impl<'r> NamedNumbers<'r> {
    /// Numbers of a state.
    pub(super) fn of<T: Real, N: StaticLength>(names: &'r ColumnNames, state: &State<T, N>) -> Self {
        Self::named(&names.state, [&state.t].into_iter().chain(&state.q).chain(&state.v).copied())
    }

    pub(super) fn named<S: AsRef<str>, T: Real>(
        names: &'r [S],
        numbers: impl IntoIterator<Item = T>,
    ) -> Self {
        let named = names.iter().zip(numbers);
        Self(named.map(|(name, x)| (Cow::Borrowed(name.as_ref()), x.to_f64())).collect())
    }

    fn names(&self) -> impl Iterator<Item = &Cow<'r, str>> {
        self.0.iter().map(|(name, _)| name)
    }

    /// Makes the quantities of this sample those of `names`.
    fn name_quantities<N: StaticLength>(&self, names: &mut Arc<ColumnNames>) {
        let quantities = || self.names().skip(entries::<N>());
        if !quantities().eq(&names.quantities) {
            let quantities = quantities().map(ToString::to_string).collect();
            *names = Arc::new(ColumnNames { quantities, state: names.state.clone() });
        }
    }
}

impl Serialize for NamedNumbers<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_map(self.0.iter().map(|(name, x)| (name, Number(*x))))
    }
}

impl<'de> Deserialize<'de> for NamedNumbers<'_> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_map(Self::default())
    }
}

impl<'de> Visitor<'de> for NamedNumbers<'_> {
    type Value = Self;

    fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("an object of numbers")
    }

    fn visit_map<A: MapAccess<'de>>(mut self, mut numbers: A) -> Result<Self, A::Error> {
        while let Some((name, Number(x))) = numbers.next_entry::<String, _>()? {
            self.0.push((name.into(), x));
        }
        Ok(self)
    }
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        if self.0.is_finite() { to.serialize_f64(self.0) } else { to.collect_str(&self.0) }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(Self(f64::NAN))
    }
}

impl Visitor<'_> for Number {
    type Value = Self;

    fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("a number")
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<Self, E> {
        Ok(Self(x))
    }

    fn visit_i64<E: Error>(self, x: i64) -> Result<Self, E> {
        Ok(Self(x as f64))
    }

    fn visit_u64<E: Error>(self, x: u64) -> Result<Self, E> {
        Ok(Self(x as f64))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Self, E> {
        text.parse().map(Self).map_err(E::custom)
    }
}

impl<T: Real, N: StaticLength> Serialize for MemberRow<T, N> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        Line::of(self).serialize(to)
    }
}

impl<'de, T: Real, N: StaticLength> Deserialize<'de> for MemberRow<T, N> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let line = Line::deserialize(from)?;
        let state = line.end.iter().flat_map(NamedNumbers::names).map(ToString::to_string).collect();
        line.into_row(&mut Arc::new(ColumnNames { state, quantities: Vec::new() })).map_err(D::Error::custom)
    }
}

impl<T: Real, N: StaticLength> Serialize for Member<T, N> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        self.row().serialize(to)
    }
}
