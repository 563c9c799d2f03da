//! Linear equations of the iteration with the derivatives at the start of a step, (λ − J) w = r with J = ∂(q̇, q̈)/∂(q, q̇) in the
//! coordinates of the tangent plane.
//!
//! The first half is solved by hand, λ w₁ − w₂ = r₁, which leaves N equations (λ − ∂q̈/∂q̇ − ∂q̈/∂q/λ) w₂ = r₂ + ∂q̈/∂q
//! r₁/λ, with a real λ and complex ones.

use nalgebra::{Complex, ComplexField, Const};

use super::chart::Chart;
use super::iteration::{StageChanges, product, zip};
use super::tableau::{RadauStages, Transformation};
use crate::derivatives::jacobian::name_of;
use crate::derivatives::tangent::{Tangent, WideOf};
use crate::error::Error;
use crate::linearized::StateDerivatives;
use crate::number::{Real, Scalar, Wide};
use crate::numerics::lu::{Lu, Square};
use crate::solution::consistent::BOTH;
use crate::solution::consistent::level::Level;
use crate::system::{Direction, SolutionOf, StateOf, unit};
use crate::vector::{Array, Element, PhaseVector, StaticLength, from_fn};

/// Π ∂q̈/∂q Π and Π ∂q̈/∂q̇ Π at a state, column by column.
pub(super) struct Derivatives<T: Element, N: StaticLength> {
    pub(super) by_q: Square<T, N>,
    pub(super) by_v: Square<T, N>,
    /// Directions Π, of the half in evaluation.
    directions: Square<T, N>,
}

impl<T: Real, N: StaticLength> Derivatives<T, N> {
    pub(super) fn new() -> Self {
        let [by_q, by_v, directions] = from_fn(|_| Square::filled(T::constant(0.0)));
        Self { by_q, by_v, directions }
    }

    /// What round-off of the state `y` changes a step of length `h` by.
    pub(super) fn round_off(&self, y: &PhaseVector<T, N>, h: T) -> PhaseVector<T, N> {
        let unit = T::constant(T::EPSILON) * Scalar::abs(h);
        let mut changes = Array::filled(T::constant(0.0));
        for (column, y) in self.by_q.iter().chain(self.by_v.iter()).zip(y.flat()) {
            let y = unit * Scalar::abs(*y);
            changes.iter_mut().zip(column.iter()).for_each(|(sum, x)| *sum += Scalar::abs(*x) * y);
        }
        PhaseVector::new([y.half(1).map(|v| unit * Scalar::abs(v)), changes])
    }

    /// Evaluates the derivatives at a state with a known solution.
    pub(super) fn evaluate<L: StateDerivatives<N = N, Scalar = T>>(
        &mut self,
        system: &L,
        state: &StateOf<L>,
        solution: SolutionOf<L>,
        chart: &Chart<L>,
    ) -> Result<(), Error> {
        let tangent = Tangent::of(system, state, solution);
        let Self { by_q, by_v, directions: known } = self;
        for (level, columns) in BOTH.into_iter().zip([by_q, by_v]) {
            for k in 0..N::COUNT {
                known[k] = chart.tangent(system, level, &unit::<T, N>(k).into(), state.t)?;
            }
            let put = |k: usize, directions: &mut Direction<WideOf<L>, N>, lane: usize| {
                let half = if level == Level::Position { &mut directions.q } else { &mut directions.v };
                (0..N::COUNT).for_each(|i| half[i].put(lane, known[k][i]));
            };
            let names = if level == Level::Position { 1 } else { 1 + N::COUNT };
            tangent.along_each(
                N::COUNT,
                put,
                |k| name_of::<L>(names + k),
                |k, change| columns[k] = change.accelerations.into(),
            )?;
            for column in columns.iter_mut() {
                *column = chart.tangent(system, Level::Velocity, column, state.t)?;
            }
        }
        Ok(())
    }

    /// Factorizes λ − ∂q̈/∂q̇ − ∂q̈/∂q/λ; false if it is singular.
    fn factorize<F>(&self, lu: &mut Lu<F, N>, lambda: F, of: impl Fn(T) -> F) -> bool
    where
        F: ComplexField + Element,
    {
        let inverse = F::one() / lambda;
        lu.factorize(|i, j| {
            let own = if i == j { lambda } else { F::zero() };
            own - of(self.by_v[j][i]) - of(self.by_q[j][i]) * inverse
        })
    }

    /// Solves (λ − J) w = r with a factorization.
    fn solve<F>(&self, lu: &Lu<F, N>, lambda: F, r: [Array<F, N>; 2], of: impl Fn(T) -> F) -> [Array<F, N>; 2]
    where
        F: ComplexField + Element,
    {
        let [first, mut right] = r;
        let inverse = F::one() / lambda;
        for (x, column) in first.iter().zip(&*self.by_q) {
            let x = *x * inverse;
            right.iter_mut().zip(column).for_each(|(right, entry)| *right += of(*entry) * x);
        }
        let velocities = lu.solve(right);
        [Array::from_fn(|i| (first[i] + velocities[i]) * inverse), velocities]
    }
}

/// Factorizations for one step length.
pub(super) struct Factorizations<T: Real, N: StaticLength, const S: usize> {
    /// Signed length of the step; NaN before the first.
    pub(super) h: T,
    real: Lu<T, N>,
    /// One for each conjugate pair; those that follow are not used, and empty where there is a heap.
    complex: [Option<Lu<Complex<T>, N>>; S],
}

impl<T: Real, N: StaticLength, const S: usize> Factorizations<T, N, S>
where
    Const<S>: RadauStages,
{
    pub(super) fn new() -> Self {
        let complex = from_fn(|k| (k < <Const<S>>::COMPLEX.len()).then(Lu::new));
        Self { h: T::constant(f64::NAN), real: Lu::new(), complex }
    }

    /// Factorizes for a step of length `h`; false if a matrix is singular.
    pub(super) fn factorize(&mut self, derivatives: &Derivatives<T, N>, h: T) -> bool {
        self.h = h;
        let mut are_regular = derivatives.factorize(&mut self.real, real::<T, S>(h), |x| x);
        for (k, lu) in self.complex.iter_mut().flatten().enumerate() {
            are_regular &= derivatives.factorize(lu, complex::<T, S>(k, h), from_real);
        }
        are_regular
    }

    /// Solves the real equations.
    pub(super) fn real(&self, derivatives: &Derivatives<T, N>, r: &PhaseVector<T, N>) -> PhaseVector<T, N> {
        PhaseVector::new(derivatives.solve(&self.real, real::<T, S>(self.h), r.arrays(), |x| x))
    }

    /// Corrections of the stages `z` with these rates.
    pub(super) fn corrections(
        &self,
        transformation: &Transformation<S>,
        derivatives: &Derivatives<T, N>,
        z: &StageChanges<T, N, S>,
        rates: &StageChanges<T, N, S>,
    ) -> StageChanges<T, N, S> {
        let mut residual = product(&transformation.slopes, z);
        for (slope, rate) in residual.iter_mut().zip(rates) {
            *slope = zip(slope, rate, |slope, rate| rate - slope / self.h);
        }
        let mut right = product(&transformation.to_eigenvectors, &residual);
        self.solve(derivatives, &mut right);
        product(&transformation.from_eigenvectors, &right)
    }

    /// Solves the equations of all eigenvectors, in place.
    fn solve(&self, derivatives: &Derivatives<T, N>, r: &mut [PhaseVector<T, N>; S]) {
        r[0] = self.real(derivatives, &r[0]);
        for (k, (lu, pair)) in self.complex.iter().flatten().zip(r[1..].chunks_exact_mut(2)).enumerate() {
            let right = from_fn(|half| Array::from_fn(|i| Complex::new(pair[0][half][i], pair[1][half][i])));
            let both = derivatives.solve(lu, complex::<T, S>(k, self.h), right, from_real);
            pair[0] = from_fn(|half| both[half].map(|x| x.re));
            pair[1] = from_fn(|half| both[half].map(|x| x.im));
        }
    }
}

fn from_real<T: Real>(x: T) -> Complex<T> {
    Complex::new(x, T::constant(0.0))
}

fn real<T: Real, const S: usize>(h: T) -> T
where
    Const<S>: RadauStages,
{
    T::constant(<Const<S>>::REAL) / h
}

fn complex<T: Real, const S: usize>(k: usize, h: T) -> Complex<T>
where
    Const<S>: RadauStages,
{
    let [re, im] = <Const<S>>::COMPLEX[k].map(T::constant);
    Complex::new(re / h, im / h)
}
