//! Names and numbers of a table of a trajectory.

use alloc::string::String;
use alloc::vec::Vec;

/// Names and numbers of a table, from [`Csv::records`](crate::trajectory::Csv::records).
///
/// With the feature `serde` records can be serialized and deserialized:
/// `{"names": ["t", "x"], "rows": [[0.0, 1.0]]}`. Human-readable formats such as JSON may write numbers that are
/// not finite as `null`, which is read as NaN.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(bound(deserialize = "T: crate::Real + serde::Deserialize<'de>"))
)]
pub struct Records<T> {
    /// Name of each column.
    pub names: Vec<String>,
    /// Numbers of each sample, one per column.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "rows"))]
    pub rows: Vec<Vec<T>>,
}

#[cfg(feature = "serde")]
fn rows<'de, D: serde::Deserializer<'de>, T: crate::Real + serde::Deserialize<'de>>(
    deserializer: D,
) -> Result<Vec<Vec<T>>, D::Error> {
    use serde::Deserialize;

    if !deserializer.is_human_readable() {
        return Deserialize::deserialize(deserializer);
    }
    let rows: Vec<Vec<Option<T>>> = Deserialize::deserialize(deserializer)?;
    let number = |cell: Option<T>| cell.unwrap_or(T::constant(f64::NAN));
    Ok(rows.into_iter().map(|row| row.into_iter().map(number).collect()).collect())
}
