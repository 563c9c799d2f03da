//! The Hamiltonian side: the Legendre transform, H, Hamilton's equations and motion in (q, p).

// Helpers unwrap as the tests do that call them.
#![allow(clippy::unwrap_used)]

mod closed_forms;
mod constrained;
mod legendre;
mod motion;

// Motions of systems that differ in the form of L and of constraints.
#[cfg(feature = "thorough")]
mod motions;
#[cfg(feature = "thorough")]
mod rotating_frame;

use lagrange_core::{Function, nalgebra::Const, prelude::*};
use lagrange_random::Random;

/// A smooth potential without any symmetry.
struct Potential;

impl Function<3, 1> for Potential {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        let c = S::constant;
        let quadratic = c(0.7) * x * x + c(0.9) * y * y + c(1.2) * z * z + c(0.3) * x * y;
        [quadratic + c(0.2) * (x + c(0.5) * z).sin() + c(0.1) * (y * z).cos()]
    }
}

/// The largest difference, as a part of the largest entry of either (and of 1).
#[track_caller]
fn agree(a: &[f64], b: &[f64], bound: f64) {
    let size = a.iter().chain(b).fold(1.0_f64, |most, x| most.max(x.abs()));
    for (x, y) in a.iter().zip(b) {
        assert!((x - y).abs() <= bound * size, "{a:?} and {b:?} differ by {:e}", (x - y).abs());
    }
}

/// The derivatives of H by the coordinates and by the momenta, by central differences of the fourth order.
fn gradient<L: Hamiltonian<N = Const<N>, Scalar = f64>, const N: usize>(
    system: &L,
    phase: &PhaseState<f64, N>,
) -> [[f64; N]; 2] {
    let step = 4e-4;
    let value = |half: usize, i: usize, change: f64| {
        let mut moved = *phase;
        let half = if half == 0 { &mut moved.q } else { &mut moved.p };
        half[i] += change;
        system.hamiltonian(&moved).unwrap()
    };
    std::array::from_fn(|half| {
        std::array::from_fn(|i| {
            let difference = |h: f64| (value(half, i, h) - value(half, i, -h)) / (2.0 * h);
            (4.0 * difference(step) - difference(2.0 * step)) / 3.0
        })
    })
}
