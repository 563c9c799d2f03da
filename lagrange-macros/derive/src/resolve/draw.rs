//! Random parameter values for tests at random points. They respect the types of the fields.

use super::parameters::Parameters;
use super::problem::Problem;
use crate::symbolic::{Approximate, Symbol, drawn, random};
use crate::syntax::{FieldShape, Inside, Property};
use crate::variables::Variable;

impl Problem {
    /// Random value of a symbol, reproducible for each draw.
    pub(crate) fn drawn(&self, symbol: Symbol, draw: u64) -> Approximate {
        self.parameters.value_of(symbol, draw)
    }
}

impl Parameters {
    /// Value of any symbol in this draw.
    pub(super) fn value_of(&self, symbol: Symbol, draw: u64) -> Approximate {
        match Variable::of(symbol) {
            Variable::Parameter(k) => self.drawn(k, symbol, draw),
            _ => Approximate::exact(drawn(symbol, (-1.25, 1.75), draw)),
        }
    }

    fn drawn(&self, k: usize, symbol: Symbol, draw: u64) -> Approximate {
        let entry = self.entries[k];
        let plain = || Approximate::exact(drawn(symbol, self.ranges[entry.field], draw));
        let Ok(FieldShape { layout, .. }) = &self.fields[entry.field].shape else { return plain() };
        // The entries of one rotation share their random angles, whichever entry is asked for.
        let angles = |rotation: usize| {
            move |k: usize| {
                let place = (entry.field << 20 | rotation << 8 | k) as u64;
                7.0 * random(ANGLES, place, draw)
            }
        };
        let (size, number) = (layout.size(), entry.number);
        match self.property(entry.field) {
            _ if layout.inside == Inside::UnitQuaternion => rounded(unit(angles(number / 4))[number % 4]),
            Some(Property::Rotation) => {
                rounded(turn(size, angles(number / (size * size)))[number / size % size][number % size])
            }
            Some(Property::Symmetric) | None => plain(),
        }
    }
}

/// Stream of random numbers for angles, used neither for symbols nor for unknown functions.
const ANGLES: u64 = 253;

/// A number of magnitude at most 1, computed by a few sines and products, with its rounding error.
fn rounded(value: f64) -> Approximate {
    Approximate { value, error: 32.0 * f64::EPSILON }
}

/// Unit quaternion by Hopf's angles: (cos α cos β, cos α sin β, sin α cos γ, sin α sin γ).
fn unit(angle: impl Fn(usize) -> f64) -> [f64; 4] {
    let [(s, c), (t, d), (u, e)] = [0, 1, 2].map(|k| angle(k).sin_cos());
    [c * d, c * t, s * e, s * u]
}

/// Rotation matrix: product of one rotation in the plane of each pair of axes.
fn turn(size: usize, angle: impl Fn(usize) -> f64) -> Vec<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> =
        (0..size).map(|i| (0..size).map(|j| if i == j { 1.0 } else { 0.0 }).collect()).collect();
    let planes = (0..size).flat_map(|j| (0..j).map(move |i| (i, j)));
    for (k, (i, j)) in planes.enumerate() {
        let (sin, cos) = angle(k).sin_cos();
        for row in &mut rows {
            (row[i], row[j]) = (cos * row[i] - sin * row[j], sin * row[i] + cos * row[j]);
        }
    }
    rows
}
