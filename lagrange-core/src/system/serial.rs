//! Serialization of vectors, and deserialization of numbers with an explanation for the `null` that JSON writes for NaN and infinity.

use alloc::string::ToString;
use alloc::vec::Vec;
use core::fmt::{self, Display};
use core::marker::PhantomData;

use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::vector::{Array, Element, Length, Vector, vector};

pub(crate) fn number<'de, D: Deserializer<'de>, T: Deserialize<'de>>(from: D) -> Result<T, D::Error> {
    T::deserialize(from).map_err(explained)
}

/// A vector, as the sequence of its numbers.
pub(crate) mod numbers {
    use super::*;

    pub(crate) fn serialize<S, T, N>(numbers: &Vector<T, N>, to: S) -> Result<S::Ok, S::Error>
    where
        S: Serializer,
        T: Element + Serialize,
        N: Length,
    {
        let mut sequence = to.serialize_tuple(N::COUNT)?;
        numbers.iter().try_for_each(|x| sequence.serialize_element(x))?;
        sequence.end()
    }

    pub(crate) fn deserialize<'de, D, T, N>(from: D) -> Result<Vector<T, N>, D::Error>
    where
        D: Deserializer<'de>,
        T: Element + Deserialize<'de>,
        N: Length,
    {
        from.deserialize_tuple(N::COUNT, Numbers(PhantomData)).map(vector).map_err(explained)
    }
}

struct Numbers<T, N>(PhantomData<(T, N)>);

impl<'de, T: Element + Deserialize<'de>, N: Length> Visitor<'de> for Numbers<T, N> {
    type Value = Array<T, N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} numbers", N::COUNT)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Array<T, N>, A::Error> {
        let mut found = Vec::with_capacity(N::COUNT);
        while found.len() < N::COUNT {
            let Some(x) = sequence.next_element()? else {
                return Err(A::Error::invalid_length(found.len(), &self));
            };
            found.push(x);
        }
        let mut count = N::COUNT;
        while sequence.next_element::<IgnoredAny>()?.is_some() {
            count += 1;
        }
        match count == N::COUNT {
            true => Ok(Array::from_fn(|i| found[i])),
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
