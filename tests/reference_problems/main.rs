//! Benchmark problems of multibody dynamics against reference values: each in the coordinates and with the constraints of its
//! source, by several methods. With `--nocapture` the errors are printed as a table; `LAGRANGE_CASES=full` adds long motions and
//! methods that take many steps.

// A test that fails says why by a panic.
#![allow(clippy::unwrap_used)]

mod andrews;
mod bicycle;
mod bricard;
mod four_bars;
mod governor;
mod nonholonomic;
mod reference;
mod reference_motions;
mod test_set;
