//! What a table of a trajectory holds.

use alloc::string::String;
use alloc::vec::Vec;

/// The names and the numbers of a table, [`Csv::records`](crate::trajectory::Csv::records).
///
/// With the feature `serde` it is written and read: `{"names": ["t", "x"], "rows": [[0.0, 1.0]]}`. In formats for people, such
/// as JSON, what is no finite number may be written as nothing (`null`), which is read as NaN.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(deserialize = "T: crate::Real + serde::Deserialize<'de>")))]
pub struct Records<T> {
    /// The name of each column.
    pub names: Vec<String>,
    /// The numbers of each sample, as many as there are names.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "rows"))]
    pub rows: Vec<Vec<T>>,
}

#[cfg(feature = "serde")]
fn rows<'de, D, T>(deserializer: D) -> Result<Vec<Vec<T>>, D::Error>
where
    D: serde::Deserializer<'de>,
    T: crate::Real + serde::Deserialize<'de>,
{
    use serde::Deserialize;

    if !deserializer.is_human_readable() {
        return Deserialize::deserialize(deserializer);
    }
    let rows: Vec<Vec<Option<T>>> = Deserialize::deserialize(deserializer)?;
    let number = |cell: Option<T>| cell.unwrap_or(T::constant(f64::NAN));
    Ok(rows.into_iter().map(|row| row.into_iter().map(number).collect()).collect())
}
