//! Serialization of vectors, and deserialization of numbers with an explanation for the `null` that JSON writes for NaN and infinity.

use alloc::string::ToString;
use alloc::vec::Vec;
use core::fmt::{self, Display};
use core::marker::PhantomData;

use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::vector::{Element, Numbers};

pub(crate) fn number<'de, D: Deserializer<'de>, T: Deserialize<'de>>(from: D) -> Result<T, D::Error> {
    T::deserialize(from).map_err(explained)
}

/// A vector, as the sequence of its numbers.
pub(crate) mod numbers {
    use super::*;

    pub(crate) fn serialize<S, T, V>(numbers: &V, to: S) -> Result<S::Ok, S::Error>
    where
        S: Serializer,
        T: Element + Serialize,
        V: Numbers<T>,
    {
        let entries = numbers.entries();
        if V::COUNT.is_none() {
            return to.collect_seq(entries);
        }
        let mut sequence = to.serialize_tuple(entries.len())?;
        entries.iter().try_for_each(|x| sequence.serialize_element(x))?;
        sequence.end()
    }

    pub(crate) fn deserialize<'de, D, T, V>(from: D) -> Result<V, D::Error>
    where
        D: Deserializer<'de>,
        T: Element + Deserialize<'de>,
        V: Numbers<T>,
    {
        let visitor = Sequence(PhantomData);
        let found = match V::COUNT {
            Some(count) => from.deserialize_tuple(count, visitor),
            None => from.deserialize_seq(visitor),
        };
        found.map_err(explained)
    }
}

struct Sequence<T, V>(PhantomData<(T, V)>);

impl<'de, T: Element + Deserialize<'de>, V: Numbers<T>> Visitor<'de> for Sequence<T, V> {
    type Value = V;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match V::COUNT {
            Some(count) => write!(f, "{count} numbers"),
            None => f.write_str("numbers"),
        }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<V, A::Error> {
        let (mut found, wanted) = (Vec::new(), V::COUNT.unwrap_or(usize::MAX));
        while found.len() < wanted
            && let Some(x) = sequence.next_element()?
        {
            found.push(x);
        }
        let mut count = found.len();
        while sequence.next_element::<IgnoredAny>()?.is_some() {
            count += 1;
        }
        match V::COUNT.is_none_or(|wanted| wanted == count) {
            true => Ok(V::from_entries(&found)),
            false => Err(A::Error::invalid_length(count, &self)),
        }
    }
}

/// Adds an explanation to an error about `null`. The original message comes last, because `serde_json` reads the line
/// and column from the end.
fn explained<E: Error + Display>(error: E) -> E {
    match error.to_string() {
        said if said.contains("null") => E::custom(format_args!(
            "a number was NaN or infinite when it was written, for which JSON has `null` alone: {said}"
        )),
        _ => error,
    }
}
