//! Accelerations and multipliers at a state: units, dependent constraints, elimination, consistent states.

mod assembly;
mod completion;
mod dependence;
mod elimination;
mod factor;
mod gradients;
mod scales;
mod switched_constraints;

// Many systems, every method, and all that is computed along motions.
#[cfg(feature = "thorough")]
mod cancelled_gradients;
#[cfg(feature = "thorough")]
mod motions;
#[cfg(feature = "thorough")]
mod undetermined;

use lagrange_core::{SolutionOf, nalgebra::Const, nalgebra::SVector, prelude::*};
use lagrange_random::Random;

/// Eight rods in a row, in Cartesian coordinates.
#[derive(Lagrangian)]
#[coordinates(x: [8], y: [8])]
#[lagrangian(sum(i in 0..8, m[i]/2*(x_dot[i]^2 + y_dot[i]^2) - m[i]*g*y[i]))]
#[constraint(rod[0]: (x[0]^2 + y[0]^2 - l[0]^2)/2 = 0)]
#[constraint(rod[i in 1..8]: ((x[i]-x[i-1])^2 + (y[i]-y[i-1])^2 - l[i]^2)/2 = 0)]
struct Rods<T> {
    m: [T; 8],
    l: [T; 8],
    g: T,
}

/// The same chain in angles. It is solved over the velocities of its links, and M is never formed.
#[derive(Lagrangian)]
#[coordinates(theta: [8])]
#[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
#[define(vx[i in 1..8] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
#[define(y[0] = -l[0]*cos(theta[0]))]
#[define(y[i in 1..8] = y[i-1] - l[i]*cos(theta[i]))]
#[lagrangian(sum(i in 0..8, m[i]/2*(vx[i]^2 + der(y[i])^2) - m[i]*g*y[i]))]
struct Angles {
    m: [f64; 8],
    l: [f64; 8],
    g: f64,
}

fn chains(m: [f64; 8], l: [f64; 8]) -> (Rods<f64>, Angles) {
    (Rods { m, l, g: 9.81 }, Angles { m, l, g: 9.81 })
}

fn vector<const K: usize>(random: &mut Random) -> SVector<f64, K> {
    random.vector().into()
}

/// What a solution leaves of M x − Fᵀλ = h and of F x = −γ, each as a part of its largest terms.
fn residual<L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>, const N: usize, const M: usize>(
    system: &L,
    state: &State<f64, N>,
    (h, gamma): (&SVector<f64, N>, &SVector<f64, M>),
    solution: &SolutionOf<L>,
) -> f64 {
    let (x, lambda) = (solution.accelerations, solution.multipliers);
    let (mass, f) = (system.mass_matrix(state), system.constraint_jacobian(state));
    let motion = (mass * x - f.tr_mul(&lambda) - h).amax();
    let terms = (mass.abs() * x.abs() + f.abs().tr_mul(&lambda.abs()) + h.abs()).max();
    let (rows, terms_of_rows) = (f * x + gamma, f.abs() * x.abs() + gamma.abs());
    rows.iter().zip(&terms_of_rows).fold(motion / terms, |most, (row, terms)| most.max(row.abs() / terms))
}
