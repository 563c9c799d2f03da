//! Deserialization of numbers, with an explanation for the `null` that JSON writes for NaN and infinity.

use core::fmt::Display;

use alloc::string::ToString;
use nalgebra::SVector;
use serde::de::Error;
use serde::{Deserialize, Deserializer};

pub(crate) fn number<'de, D, T>(from: D) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    T::deserialize(from).map_err(explained)
}

pub(crate) fn numbers<'de, D, T, const N: usize>(from: D) -> Result<SVector<T, N>, D::Error>
where
    D: Deserializer<'de>,
    T: nalgebra::Scalar + Deserialize<'de>,
{
    SVector::deserialize(from).map_err(explained)
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
