//! Rolling without slipping: Milton (8.4)–(8.7), a ball, a cylinder, and other nonholonomic systems with a known
//! motion.

mod ball;
mod cylinder;
mod euler_angles;
mod nonholonomic;

/// The largest of some deviations; not a number if one of them is not.
fn largest(deviations: impl IntoIterator<Item = f64>) -> f64 {
    deviations.into_iter().fold(0.0, |worst, d| if d > worst || d.is_nan() { d } else { worst })
}
