//! Names and numbers of a table of a trajectory.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::{self, Debug, Display, Formatter};

/// Names and numbers of a table, from [`Csv::records`](crate::trajectory::Csv::records) and
/// [`SampledTrajectory::csv`](crate::trajectory::SampledTrajectory::csv). It prints as comma-separated values, numbers in the shortest
/// form that reads back the same.
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

impl<T: Debug> Display for Records<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.names.join(","))?;
        self.rows.iter().try_for_each(|row| write_row(row, f))
    }
}

/// Writes a line of comma-separated values. `Debug` prints the shortest form that reads back the same, with an exponent if that is
/// shorter.
pub(super) fn write_row<T: Debug>(row: &[T], f: &mut Formatter<'_>) -> fmt::Result {
    for (k, cell) in row.iter().enumerate() {
        write!(f, "{}{cell:?}", if k == 0 { "" } else { "," })?;
    }
    writeln!(f)
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
