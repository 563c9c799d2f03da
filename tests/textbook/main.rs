//! Systems of the textbooks against closed solutions: K. Milton, chapter 8.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod ball;
mod frames;
mod functions;
mod particles;
mod polar;
mod rolling_bodies;
mod spherical_pendulum;

// Motions of many periods.
#[cfg(feature = "thorough")]
mod foucault;
#[cfg(feature = "thorough")]
mod small;

#[path = "../../examples/pendulum/mod.rs"]
mod pendulum;

/// The largest of some deviations; not a number if one of them is not.
fn largest(deviations: impl IntoIterator<Item = f64>) -> f64 {
    deviations.into_iter().fold(0.0, |worst, d| if d > worst || d.is_nan() { d } else { worst })
}
