//! The motion of a spherical pendulum by quadrature: Milton (8.26)–(8.31).
//!
//! With u = z/l, energy E and angular momentum L_z for m l² = 1, and ω² = g/l, the height obeys
//!
//! u̇² = U(u) = 2 (E − ω² u)(1 − u²) − L_z²   (8.26)
//!
//! and swings between the two roots of U in (−1, 1). The third root lies above 1. The time from one to the other is
//! ∫ du/√U ((8.28) is printed without the root), the azimuth grows by ∫ L_z du/((1 − u²) √U).
//!
//! Heights are counted from the lowest point here, w = 1 + u, so that small swings keep their digits. By
//! U = 2 ω² (w₂ − w)(w − w₁)(w₃ − w) and w = ½(w₁ + w₂) + ½(w₂ − w₁) cos ψ both integrands become smooth and
//! periodic in ψ, and equal weights at equal distances (Gauss and Chebyshev's rule in w) converge geometrically.

use std::f64::consts::PI;

use super::zeros::zero;

/// A motion between two heights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Orbit {
    /// The turning heights above the lowest point, in units of l, lower first.
    pub(crate) heights: [f64; 2],
    /// The third root of U, above the sphere, counted in the same way: L_z² = 2 ω² w₁ w₂ w₃ for m l² = 1.
    pub(crate) third: f64,
    /// ω² = g/l.
    rate: f64,
}

impl Orbit {
    /// The one that turns at these heights.
    pub(crate) fn between([low, high]: [f64; 2], rate: f64) -> Self {
        // U(0) = U(2) as functions of w, both being −L_z².
        let third = (2.0 - low) * (2.0 - high) / (2.0 - low - high);
        Self { heights: [low, high], third, rate }
    }

    /// The one with this energy above the lowest point and this angular momentum, both for m l² = 1.
    pub(crate) fn of(energy: f64, l_z: f64, rate: f64) -> Self {
        let cubic = |w: f64| 2.0 * (energy - rate * w) * w * (2.0 - w) - l_z * l_z;
        // U is largest here, between its roots; where it vanishes there, the bob goes round in a circle.
        let (b, c) = (2.0 * rate + energy, 6.0 * rate * energy);
        let top = 2.0 * energy / (b + (b * b - c).sqrt());
        let summit = (top, cubic(top));
        let root = |end: f64| if summit.1 > 0.0 { zero((end, cubic(end)), summit, cubic) } else { top };
        // U is −L_z² at the lowest point, at the highest, and where all energy is potential.
        Self::between([root(0.0), root((energy / rate).min(2.0))], rate)
    }

    /// The time from one height to the other and back, 2 ∫ du/√U.
    pub(crate) fn nutation(&self) -> f64 {
        PI / self.rate.sqrt() * (1.0 + self.period_excess())
    }

    /// T √(g/l) / 2π − 1, with the time T = 4 ∫ du/√U of one full ellipse, without loss of digits where it is small.
    pub(crate) fn period_excess(&self) -> f64 {
        let [low, high] = self.heights;
        self.mean(|w| {
            let slower = (2.0 / (self.third - w)).sqrt();
            (w - low * high / (2.0 - low - high)) / ((self.third - w) * (slower + 1.0))
        })
    }

    /// The azimuth that one full ellipse, twice up and down, gains beyond 2π.
    ///
    /// It is 4 ∫ L_z du/((1 − u²) √U) less the same integral over √(w₁ w₂)/(2 w), which is 2π: their
    /// difference is taken under the integral, where it has w as a factor.
    pub(crate) fn precession(&self) -> f64 {
        let [low, high] = self.heights;
        let mean = self.mean(|w| {
            let sine = 1.0 - w / 2.0;
            let square = 1.0 / (sine * sine * (1.0 - w / self.third));
            (1.0 - w / 4.0 + sine * sine / self.third) * square / (square.sqrt() + 1.0)
        });
        2.0 * PI * (low * high).sqrt() * mean
    }

    /// The mean over ψ, by the midpoint rule with twice as many points until it stays the same.
    fn mean(&self, f: impl Fn(f64) -> f64) -> f64 {
        let [low, high] = self.heights;
        let rule = |points: u32| {
            let psi = |k: u32| PI * (f64::from(k) + 0.5) / f64::from(points);
            let height = |k: u32| f64::midpoint(low, high) + (high - low) / 2.0 * psi(k).cos();
            (0..points).map(|k| f(height(k))).sum::<f64>() / f64::from(points)
        };
        let mut last = rule(8);
        for points in (4..16).map(|k| 1 << k) {
            let next = rule(points);
            if (next - last).abs() <= 1e-15 * next.abs() {
                return next;
            }
            last = next;
        }
        last
    }
}
