//! Jacobians, equilibria and linear systems against closed forms and textbooks.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod closed_forms;
mod constrained;
mod equilibria;
mod errors;
mod inverse;
mod local;
mod numbers;
mod regressor;
mod steady;

// Further systems, of which each takes the compiler a second.
#[cfg(feature = "thorough")]
mod inverse_mechanisms;
#[cfg(feature = "thorough")]
mod large_fields;
#[cfg(feature = "thorough")]
mod mechanisms;
#[cfg(feature = "thorough")]
mod number_types;
#[cfg(feature = "thorough")]
mod puma;
#[cfg(feature = "thorough")]
mod ranks;
#[cfg(feature = "thorough")]
mod refused;
#[cfg(feature = "thorough")]
mod steady_mechanisms;

use lagrange_core::nalgebra::{Complex, DMatrix};
use lagrange_core::prelude::*;
use lagrange_systems::HeavyTop;

/// Largest deviation of eigenvalues that are known exactly, in units of the largest.
const TOLERANCE: f64 = 1e-13;

fn assert_close(matrix: &DMatrix<f64>, expected: &DMatrix<f64>) {
    assert_eq!(matrix.shape(), expected.shape());
    let error = (matrix - expected).amax() / expected.amax();
    assert!(error < 1e-14, "off by {error:e}: {matrix}, expected {expected}");
}

/// Each eigenvalue expected is found once, and none beside.
fn assert_spectrum(found: &[Complex<f64>], expected: &[Complex<f64>], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    let size = expected.iter().map(|s| s.norm()).fold(0.0, f64::max);
    let mut left = found.to_vec();
    for s in expected {
        let nearest = (0..left.len()).min_by(|&i, &j| (left[i] - s).norm().total_cmp(&(left[j] - s).norm()));
        let found = left.remove(nearest.unwrap());
        assert!((found - s).norm() <= tolerance * size, "{found} in place of {s}");
    }
}

/// ± i ω for each frequency.
fn oscillations(frequencies: &[f64]) -> Vec<Complex<f64>> {
    frequencies.iter().flat_map(|&w| [Complex::new(0.0, w), Complex::new(0.0, -w)]).collect()
}

const TOP: HeavyTop<f64> = HeavyTop { i1: 0.3, i3: 0.1, mgl: 1.2 * 9.81 * 0.25 };

/// A pendulum on a rod whose length is said again to be an input.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: x^2 + y^2 = l^2)]
#[force(x: push)]
struct Pendulum<'a> {
    m: f64,
    g: &'a f64,
    l: f64,
    push: f64,
}

const PENDULUM: Pendulum<'_> = Pendulum { m: 1.0, g: &9.81, l: 2.0, push: 0.0 };
