//! The method of Levenberg and Marquardt (Moré 1978) on R = (h + Fᵀλ, γ, F q̇ + b, Φ), with the damping in proportion to
//! |R|: it converges quadratically to equilibria in families too (Fan and Yuan, *Computing* 74, 2005), and a step
//! never moves what R does not depend on.

use alloc::{format, string::String, vec::Vec};

use nalgebra::{DMatrix, DVector, Dyn, SVD};

use super::point::{Point, finite_residual, name, row};
use super::weights::weights;
use crate::linearized::Linearized;
use crate::number::array::vector;
use crate::number::numeric::{larger, power_of_epsilon};
use crate::solution::consistent;
use crate::{Error, Lagrangian, Real, Scalar, Simulate, State};

/// Steps before giving up.
const ITERATIONS: usize = 200;

type Factors<T> = SVD<T, Dyn, Dyn>;

/// Where the search is, and how it goes on.
pub(super) struct Search<L: Lagrangian<N, M>, const N: usize, const M: usize, const P: usize> {
    pub(super) point: Point<L, N, M>,
    /// Indices of what is sought: coordinates, then parameters.
    unknowns: Vec<usize>,
    residual: DVector<L::Scalar>,
    jacobian: DMatrix<L::Scalar>,
    /// What each row is multiplied by, so that rows of different units compare.
    weights: DVector<L::Scalar>,
    /// The length of each column so far: the unit of a step is its inverse.
    scale: DVector<L::Scalar>,
    damping: L::Scalar,
}

impl<L, const N: usize, const M: usize, const P: usize> Search<L, N, M, P>
where
    L: Linearized<N, M, P, Scalar: Real> + Clone,
{
    pub(super) fn start(system: L, guess: &State<L::Scalar, N>, unknowns: Vec<usize>) -> Result<Self, Error> {
        let none = vector([L::Scalar::constant(0.0); M]);
        let state = start(&system, guess, &unknowns);
        let multipliers = system.solve(&state).map_or(none, |solution| solution.multipliers);
        let mut point = Point { system, state, multipliers };
        for &unknown in &unknowns {
            point.set(unknown, point.value(unknown))?;
        }
        let (residual, jacobian) = (point.residual(), point.jacobian(&unknowns)?);
        finite_residual::<L, N, M>(&residual, &point.state)?;
        let weights = weights(&jacobian, &residual, N);
        let scale = DVector::zeros(jacobian.ncols());
        let damping = L::Scalar::constant(1e-3);
        Ok(Self { point, unknowns, residual, jacobian, weights, scale, damping })
    }

    /// Steps until only round-off is left; how many it took.
    pub(super) fn run(&mut self) -> Result<usize, Error> {
        let half = L::Scalar::constant(0.5);
        for iteration in 0..ITERATIONS {
            if self.is_exact() {
                return Ok(iteration);
            }
            let factors = self.factorize()?;
            let (converged, before) = (self.is_negligible(&factors), self.distance(&self.residual));
            let moved = self.step(&factors)?;
            if converged && (!moved || self.distance(&self.residual) > half * before) {
                return Ok(iteration);
            }
            if !moved {
                return Err(self.not_found(iteration));
            }
        }
        let factors = self.factorize()?;
        if self.is_negligible(&factors) { Ok(ITERATIONS) } else { Err(self.not_found(ITERATIONS)) }
    }

    /// Takes the least damped step that leads nearer; false where none does.
    fn step(&mut self, factors: &Factors<L::Scalar>) -> Result<bool, Error> {
        let before = self.distance(&self.residual);
        let (less, more) = (L::Scalar::constant(0.1), L::Scalar::constant(10.0));
        for _ in 0..40 {
            let step = self.damped(factors, self.damping * before);
            let next = self.moved(&step)?;
            let residual = next.residual();
            if self.distance(&residual) < before {
                self.jacobian = next.jacobian(&self.unknowns)?;
                (self.point, self.residual) = (next, residual);
                self.damping *= less;
                return Ok(true);
            }
            self.damping *= more;
        }
        Ok(false)
    }

    /// The singular values of the Jacobian in the units of rows and columns.
    fn factorize(&mut self) -> Result<Factors<L::Scalar>, Error> {
        let mut scaled = self.jacobian.clone();
        for (i, weight) in self.weights.iter().enumerate() {
            scaled.row_mut(i).scale_mut(*weight);
        }
        for (j, mut column) in scaled.column_iter_mut().enumerate() {
            self.scale[j] = larger(self.scale[j], column.norm());
            column.scale_mut(self.unit(j));
        }
        let size = scaled.nrows();
        let epsilon = L::Scalar::constant(L::Scalar::EPSILON);
        SVD::try_new(scaled, true, true, epsilon, 1000 * size).ok_or(Error::EigenvaluesNotFound)
    }

    /// δ = −Σ_k v_k σ_k (u_k·R)/(σ_k² + μ), over the singular values that are not zero.
    fn damped(&self, factors: &Factors<L::Scalar>, damping: L::Scalar) -> DVector<L::Scalar> {
        let zero = L::Scalar::constant(0.0);
        let mut step = DVector::zeros(self.jacobian.ncols());
        let (Some(u), Some(v)) = (&factors.u, &factors.v_t) else { return step };
        let least = factors.singular_values.max() * L::Scalar::constant(L::Scalar::EPSILON);
        for (k, &sigma) in factors.singular_values.iter().enumerate().filter(|(_, sigma)| **sigma > least) {
            let rows = self.residual.iter().zip(&self.weights).enumerate();
            let along = rows.fold(zero, |sum, (i, (r, w))| sum + u[(i, k)] * *r * *w);
            let length = -sigma * along / (sigma * sigma + damping);
            for j in 0..step.len() {
                step[j] += v[(k, j)] * length * self.unit(j);
            }
        }
        step
    }

    /// The unit of a step in unknown `j`: it changes R about as much as the guess is off.
    fn unit(&self, j: usize) -> L::Scalar {
        let one = L::Scalar::constant(1.0);
        if self.scale[j] > L::Scalar::constant(0.0) { one / self.scale[j] } else { one }
    }

    fn moved(&self, step: &DVector<L::Scalar>) -> Result<Point<L, N, M>, Error> {
        let mut next = self.point.clone();
        for (j, &unknown) in self.unknowns.iter().enumerate() {
            next.set(unknown, next.value(unknown) + step[j])?;
        }
        for a in 0..M {
            next.multipliers[a] += step[self.unknowns.len() + a];
        }
        Ok(next)
    }

    /// |R| in the units of the rows.
    fn distance(&self, residual: &DVector<L::Scalar>) -> L::Scalar {
        residual.component_mul(&self.weights).norm()
    }

    /// Whether every row is round-off of its terms.
    fn is_exact(&self) -> bool {
        let part = L::Scalar::constant(4.0 * L::Scalar::EPSILON);
        let bound = self.terms(|_, x| part * x);
        self.residual.iter().zip(&bound).all(|(r, bound)| Scalar::abs(*r) <= *bound)
    }

    /// Whether what is left may be round-off: it is small, of the terms of each row and of those where the unknowns
    /// are about 1; and what no step could take away is round-off of the terms here or at the guess. The second
    /// tells forces that cannot balance, however small their unit makes them.
    fn is_negligible(&self, factors: &Factors<L::Scalar>) -> bool {
        let part = L::Scalar::constant(16.0 * L::Scalar::EPSILON);
        let floor = power_of_epsilon(0.75);
        let small = self.terms(|_, x| part * x + floor);
        let round_off = self.terms(|j, x| part * (x + self.unit(j)));
        let moved = &self.jacobian * self.damped(factors, L::Scalar::constant(0.0));
        let stays = &self.residual + moved.rows(0, self.residual.len());
        (0..self.residual.len())
            .all(|i| Scalar::abs(self.residual[i]) <= small[i] && Scalar::abs(stays[i]) <= round_off[i])
    }

    /// Σ_j |∂R_i/∂x_j| size(j, |x_j|) over the unknowns and multipliers, for each row i.
    fn terms(&self, size: impl Fn(usize, L::Scalar) -> L::Scalar) -> DVector<L::Scalar> {
        let unknowns = self.unknowns.iter().map(|&unknown| self.point.value(unknown));
        let values = unknowns.chain(self.point.multipliers.iter().copied());
        let sizes = values.enumerate().map(|(j, x)| size(j, Scalar::abs(x)));
        let sizes = DVector::from_iterator(self.jacobian.ncols(), sizes);
        self.jacobian.map(Scalar::abs) * sizes
    }

    /// What takes part in the directions along which nothing changes.
    pub(super) fn undetermined(&mut self) -> Result<Vec<String>, Error> {
        let zero = L::Scalar::constant(0.0);
        let factors = self.factorize()?;
        let Some(v) = &factors.v_t else { return Ok(Vec::new()) };
        let least = factors.singular_values.max() * power_of_epsilon(2.0 / 3.0);
        let free: Vec<usize> = (0..v.nrows()).filter(|&k| factors.singular_values[k] <= least).collect();
        let share = |j: usize| free.iter().fold(zero, |most, &k| larger(most, Scalar::abs(v[(k, j)])));
        let shares: Vec<_> = (0..self.unknowns.len()).map(share).collect();
        let names =
            self.unknowns.iter().zip(shares).filter(|(_, share)| *share > power_of_epsilon(1.0 / 3.0));
        Ok(names.map(|(&unknown, _)| name::<L, N, M, P>(unknown).into()).collect())
    }

    #[cold]
    fn not_found(&self, iterations: usize) -> Error {
        let size = |i: usize| Scalar::abs(self.residual[i]) * self.weights[i];
        let worst =
            (1..self.residual.len()).fold(0, |worst, i| if size(i) > size(worst) { i } else { worst });
        let best = self.unknowns.iter().map(|&unknown| {
            let value = self.point.value(unknown).to_f64();
            format!("{} = {value:?}", name::<L, N, M, P>(unknown))
        });
        Error::NoEquilibrium {
            row: row::<L, N, M>(worst),
            residual: self.residual[worst].to_f64(),
            iterations,
            best: best.collect(),
            time: self.point.state.t.to_f64(),
        }
    }
}

/// The guess, moved onto the constraints where nothing of it is held.
fn start<L, const N: usize, const M: usize>(
    system: &L,
    guess: &State<L::Scalar, N>,
    unknowns: &[usize],
) -> State<L::Scalar, N>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let mut state = *guess;
    let is_free = (0..N).all(|i| unknowns.contains(&i));
    if is_free && consistent::project_coordinates(system, &mut state).is_ok() { state } else { *guess }
}
