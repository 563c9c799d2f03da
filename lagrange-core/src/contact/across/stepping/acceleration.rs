//! Anderson's acceleration of the iteration by which a step finds forces and impulses.

use alloc::vec::Vec;

use crate::numerics::bare::{dot, sqrt};

/// Starts and results of the iterations so far, from which the next start is extrapolated. Velocities are in units in which the mass matrix is 1.
///
/// The iteration is an affine map while forces are linear in the velocities and the same contacts push, stick and slide. Its acceleration is
/// then equivalent to GMRES (Walker and Ni, *SIAM Journal on Numerical Analysis* 49, 2011), and converges even where the map does not
/// contract, as where a magnetic field turns a velocity far in a step.
#[derive(Default)]
pub(super) struct Acceleration {
    /// Start of the last iteration, and the change by it.
    last: Option<[Vec<f64>; 2]>,
    /// Differences of such pairs. The changes are orthonormal.
    differences: Vec<[Vec<f64>; 2]>,
}

impl Acceleration {
    /// Returns the start of the next iteration, after one from `start` to `end`.
    pub(super) fn next(&mut self, start: Vec<f64>, end: &[f64]) -> Vec<f64> {
        let change = minus(end, &start, 1.0);
        let now = [start, change];
        if let Some(last) = self.last.replace(now.clone()) {
            self.push([0, 1].map(|half| minus(&now[half], &last[half], 1.0)));
        }
        let [start, change] = self.differences.iter().fold(now, without);
        minus(&start, &change, -1.0)
    }

    fn push(&mut self, difference: [Vec<f64>; 2]) {
        let changed = sqrt(dot(&difference[1], &difference[1]));
        let rest = self.differences.iter().fold(difference, without);
        let left = sqrt(dot(&rest[1], &rest[1]));
        // Of a difference that those before explain to half of the digits, less than half of the rest is right.
        if left > sqrt(f64::EPSILON) * changed {
            self.differences.push(rest.map(|half| half.iter().map(|x| x / left).collect()));
        }
    }
}

/// A start and its change, without the part along a difference.
fn without(pair: [Vec<f64>; 2], difference: &[Vec<f64>; 2]) -> [Vec<f64>; 2] {
    let part = dot(&difference[1], &pair[1]);
    [0, 1].map(|half| minus(&pair[half], &difference[half], part))
}

/// x − part · y.
fn minus(x: &[f64], y: &[f64], part: f64) -> Vec<f64> {
    x.iter().zip(y).map(|(x, y)| x - part * y).collect()
}
