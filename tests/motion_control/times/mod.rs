//! Times: counted from far away, near the round-off, very short and very long, and steps of the length asked for.

mod backwards;
mod extremes;
pub(crate) mod far;
mod steps;

/// cos ω(t − start), the motion of a spring from (1, 0), the rounding of the product taken into account.
pub(crate) fn exact(omega: f64, start: f64, t: f64) -> f64 {
    let elapsed = t - start;
    assert_eq!(elapsed + start, t, "the test needs a difference without rounding");
    let phase = omega * elapsed;
    let rest = omega.mul_add(elapsed, -phase);
    phase.cos() - rest * phase.sin()
}

/// What so many steps may be off. The norm of the error of each is kept below 1, so that (x, v/ω) is off by at most
/// √2 · `tolerance` · (1 + 1); ten times that, as it is an estimate.
pub(crate) fn allowed(steps: usize, tolerance: f64) -> f64 {
    10.0 * 2.0 * 2_f64.sqrt() * tolerance * steps as f64
}
