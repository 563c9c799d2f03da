//! Noninertial frames: Milton (8.32)–(8.51).

mod accelerating;
mod declared;
mod functions;
mod rotating;

/// The largest of some deviations; not a number if one of them is not.
fn largest(deviations: impl IntoIterator<Item = f64>) -> f64 {
    deviations.into_iter().fold(0.0, |worst, d| if d > worst || d.is_nan() { d } else { worst })
}
