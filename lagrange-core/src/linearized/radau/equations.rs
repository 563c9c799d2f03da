//! Linear equations of the iteration, (λ − J) w = r with J = ∂(q̇, q̈)/∂(q, q̇) in the coordinates of the tangent plane.
//!
//! The first half is solved by hand, λ w₁ − w₂ = r₁, which leaves N equations (λ − ∂q̈/∂q̇ − ∂q̈/∂q/λ) w₂ = r₂ + ∂q̈/∂q
//! r₁/λ, with a real λ and a complex one.

use nalgebra::{Complex, ComplexField};

use super::chart::Chart;
use super::lu::Lu;
use crate::error::Error;
use crate::linearized::StateDerivatives;
use crate::linearized::jacobian::name_of;
use crate::linearized::tangent::{Tangent, WideOf};
use crate::number::{Real, Wide};
use crate::room::Room;
use crate::solution::consistent::BOTH;
use crate::solution::consistent::level::Level;
use crate::system::{Direction, SolutionOf, StateOf};
use crate::vector::{Array, Element, Length, PhaseVector, from_fn};

/// Real eigenvalue of the inverse of the matrix of the method.
pub(super) const GAMMA: f64 = 3.637_834_252_744_496;
/// Real part of the complex eigenvalues.
const ALPHA: f64 = 2.681_082_873_627_752;
/// Imaginary part of the complex eigenvalues.
const BETA: f64 = 3.050_430_199_247_410_5;

/// Π ∂q̈/∂q Π and Π ∂q̈/∂q̇ Π at a state, row by row.
pub(super) struct Derivatives<T: Element, N: Length> {
    by_q: Room<Array<Array<T, N>, N>>,
    by_v: Room<Array<Array<T, N>, N>>,
}

impl<T: Real, N: Length> Derivatives<T, N> {
    /// Evaluates the derivatives at a state with a known solution.
    pub(super) fn at<L: StateDerivatives<N = N, Scalar = T>>(
        system: &L,
        state: &StateOf<L>,
        solution: SolutionOf<L>,
        chart: &Chart<L>,
    ) -> Result<Self, Error> {
        let tangent = Tangent::of(system, state, solution);
        let zeros = || Room::of(Array::filled(Array::filled(T::constant(0.0))));
        let (mut by_q, mut by_v) = (zeros(), zeros());
        for (level, columns) in BOTH.into_iter().zip([&mut by_q, &mut by_v]) {
            for k in 0..N::COUNT {
                let unit = Array::from_fn(|i| T::constant(if i == k { 1.0 } else { 0.0 }));
                columns[k] = chart.tangent(system, level, &unit, state.t)?;
            }
            let units = columns.clone();
            let put = |k: usize, directions: &mut Direction<WideOf<L>, N>, lane: usize| {
                let half = if level == Level::Position { &mut directions.q } else { &mut directions.v };
                (0..N::COUNT).for_each(|i| half[i].put(lane, units[k][i]));
            };
            let names = if level == Level::Position { 1 } else { 1 + N::COUNT };
            tangent.along_each(
                N::COUNT,
                put,
                |k| name_of::<L>(names + k),
                |k, change| {
                    columns[k] = change.accelerations.into();
                },
            )?;
            for k in 0..N::COUNT {
                columns[k] = chart.tangent(system, Level::Velocity, &columns[k], state.t)?;
            }
        }
        let transposed =
            |columns: Room<Array<Array<T, N>, N>>| Room::of(from_fn(|i| Array::from_fn(|j| columns[j][i])));
        Ok(Self { by_q: transposed(by_q), by_v: transposed(by_v) })
    }

    /// Factorizes λ − ∂q̈/∂q̇ − ∂q̈/∂q/λ.
    fn factor<F>(&self, lambda: F, of: impl Fn(T) -> F) -> Option<Lu<F, N>>
    where
        F: ComplexField + Element,
    {
        let entry = |i: usize, j: usize| {
            let own = if i == j { lambda } else { F::zero() };
            own - of(self.by_v[i][j]) - of(self.by_q[i][j]) / lambda
        };
        Lu::of(Room::of(from_fn(|i| Array::from_fn(|j| entry(i, j)))))
    }

    /// Solves (λ − J) w = r with a factorization.
    fn solve<F>(&self, lu: &Lu<F, N>, lambda: F, r: [Array<F, N>; 2], of: impl Fn(T) -> F) -> [Array<F, N>; 2]
    where
        F: ComplexField + Element,
    {
        let [first, second] = r;
        let right = Array::from_fn(|i| {
            let product = (0..N::COUNT).fold(F::zero(), |sum, j| sum + of(self.by_q[i][j]) * first[j]);
            second[i] + product / lambda
        });
        let velocities = lu.solve(right);
        [Array::from_fn(|i| (first[i] + velocities[i]) / lambda), velocities]
    }
}

/// Factorizations for one step length.
pub(super) struct Factorizations<T: Real, N: Length> {
    /// Signed length of the step.
    pub(super) h: T,
    real: Lu<T, N>,
    complex: Lu<Complex<T>, N>,
}

impl<T: Real, N: Length> Factorizations<T, N> {
    /// Factorizes for a step of length `h`; `None` if a matrix is singular.
    pub(super) fn of(derivatives: &Derivatives<T, N>, h: T) -> Option<Self> {
        let real = derivatives.factor(T::constant(GAMMA) / h, |x| x)?;
        let complex = derivatives.factor(eigenvalue(h), |x| Complex::new(x, T::constant(0.0)))?;
        Some(Self { h, real, complex })
    }

    /// Solves the real equations.
    pub(super) fn real(&self, derivatives: &Derivatives<T, N>, r: &PhaseVector<T, N>) -> PhaseVector<T, N> {
        let lambda = T::constant(GAMMA) / self.h;
        PhaseVector::new(derivatives.solve(&self.real, lambda, r.arrays(), |x| x))
    }

    /// Corrections of the three transformed stages `w`, from the transformed rates `f`.
    pub(super) fn corrections(
        &self,
        derivatives: &Derivatives<T, N>,
        w: &[PhaseVector<T, N>; 3],
        f: &[PhaseVector<T, N>; 3],
    ) -> [PhaseVector<T, N>; 3] {
        let [gamma, alpha, beta] = [GAMMA, ALPHA, BETA].map(|x| T::constant(x) / self.h);
        let entries = |of: &dyn Fn(usize, usize) -> T| {
            PhaseVector::new(from_fn(|half| Array::from_fn(|i| of(half, i))))
        };
        let first = self.real(derivatives, &entries(&|half, i| f[0][half][i] - gamma * w[0][half][i]));
        let right = from_fn(|half| {
            Array::from_fn(|i| {
                let (x, y) = (w[1][half][i], w[2][half][i]);
                Complex::new(f[1][half][i] - alpha * x + beta * y, f[2][half][i] - alpha * y - beta * x)
            })
        });
        let of = |x| Complex::new(x, T::constant(0.0));
        let both = derivatives.solve(&self.complex, eigenvalue(self.h), right, of);
        [first, entries(&|half, i| both[half][i].re), entries(&|half, i| both[half][i].im)]
    }
}

fn eigenvalue<T: Real>(h: T) -> Complex<T> {
    Complex::new(T::constant(ALPHA) / h, T::constant(BETA) / h)
}
