//! Jacobians, equilibria and linear systems against closed forms and textbooks.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod closed_forms;
mod constrained;
mod equilibria;
mod errors;
mod inverse;
mod large_fields;
mod local;
mod numbers;
mod ranks;
mod regressor;
mod steady;

use lagrange_core::nalgebra::{Complex, DMatrix};
use lagrange_core::prelude::*;

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

/// A heavy symmetric top in Euler angles.
#[derive(Clone, Lagrangian)]
#[coordinates(phi, theta, psi)]
#[lagrangian(i1/2*(theta_dot^2 + phi_dot^2*sin(theta)^2) + i3/2*(psi_dot + phi_dot*cos(theta))^2
    - m*g*l*cos(theta))]
struct Top {
    i1: f64,
    i3: f64,
    m: f64,
    g: f64,
    l: f64,
}

const TOP: Top = Top { i1: 0.3, i3: 0.1, m: 1.2, g: 9.81, l: 0.25 };
