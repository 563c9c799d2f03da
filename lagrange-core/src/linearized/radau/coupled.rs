//! Linear equations of the iteration with the derivatives at each stage, which couple all stages.
//!
//! A stiff force whose direction turns by an angle θ within a step of length h feeds an error h² k θ² of a stiffness k into the
//! iteration with the derivatives at the start, which then diverges (Lubich, "Integration of stiff mechanical systems by
//! Runge–Kutta methods", *Zeitschrift für angewandte Mathematik und Physik* 44, 1993). Derivatives at the guess of each stage
//! leave for θ the error of the guess.
//!
//! With the slopes W of the polynomial, Σⱼ Wₖⱼ Δqⱼ − Δvₖ = rₖ and Σⱼ Wₖⱼ Δvⱼ − ∂q̈/∂q Δqₖ − ∂q̈/∂q̇ Δvₖ = sₖ. The first equations
//! are solved by hand, which leaves S × S blocks of N × N.

use super::chart::Chart;
use super::equations::Derivatives;
use super::iteration::{StageChanges, product, zip};
use crate::error::Error;
use crate::linearized::StateDerivatives;
use crate::number::Real;
use crate::numerics::lu::{Lu, Square};
use crate::solution::solve::solve_near;
use crate::system::{StateOf, System};
use crate::vector::{Array, Element, PhaseVector, StaticLength, from_fn};

/// Block LU factorization (Golub and Van Loan, *Matrix Computations*, 3.2).
pub(super) struct Coupled<T: Element, N: StaticLength, const S: usize> {
    /// W for a step of length 1, and the length of the step.
    slopes: [[f64; S]; S],
    h: T,
    derivatives: [Derivatives<T, N>; S],
    /// Columns of L below the diagonal, and of U above it, whose blocks on the diagonal are 1.
    blocks: [[Square<T, N>; S]; S],
    /// Blocks of L on the diagonal.
    diagonal: [Lu<T, N>; S],
}

impl<T: Real, N: StaticLength, const S: usize> Coupled<T, N, S> {
    pub(super) fn new(slopes: [[f64; S]; S]) -> Self {
        let blocks = from_fn(|_| from_fn(|_| Square::filled(T::constant(0.0))));
        let h = T::constant(f64::NAN);
        Self {
            slopes,
            h,
            derivatives: from_fn(|_| Derivatives::new()),
            blocks,
            diagonal: from_fn(|_| Lu::new()),
        }
    }

    /// Evaluates the derivatives at stage `k`, by these constraints.
    pub(super) fn evaluate<L: StateDerivatives<N = N, Scalar = T>>(
        &mut self,
        system: &L,
        (k, state): (usize, &StateOf<L>),
        (chart, active): (&Chart<L>, &Array<bool, <L as System>::M>),
    ) -> Result<(), Error> {
        let solution = solve_near(system, state, Some(active), |solution, _| *solution)?;
        self.derivatives[k].evaluate(system, state, solution, chart)
    }

    /// Factorizes for a step of length `h`; false if a block is singular.
    pub(super) fn factorize(&mut self, h: T) -> bool {
        self.h = h;
        (0..S).for_each(|k| self.fill(k));
        (0..S).all(|k| self.eliminate(k))
    }

    /// Sets the blocks of stage `k`: W² − ∂q̈/∂q − W ∂q̈/∂q̇.
    fn fill(&mut self, k: usize) {
        let Self { slopes, h, derivatives, blocks, .. } = self;
        for (j, block) in blocks[k].iter_mut().enumerate() {
            let twice = (0..S).fold(0.0, |sum, i| sum + slopes[k][i] * slopes[i][j]);
            let (once, twice) = (T::constant(slopes[k][j]) / *h, T::constant(twice) / (*h * *h));
            for (c, column) in block.iter_mut().enumerate() {
                *column = derivatives[k].by_v[c].map(|x| -once * x);
                column[c] += twice;
                if j == k {
                    subtract(column, &derivatives[k].by_q[c]);
                }
            }
        }
    }

    /// Eliminates the unknowns of stage `k` from the equations of the later stages. Returns false if the block of the stage on
    /// the diagonal is singular.
    fn eliminate(&mut self, k: usize) -> bool {
        let Self { blocks, diagonal, .. } = self;
        let own = &blocks[k][k];
        if !diagonal[k].factorize(|i, j| own[j][i]) {
            return false;
        }
        for j in k + 1..S {
            for c in 0..N::COUNT {
                let column = diagonal[k].solve(blocks[k][j][c]);
                blocks[k][j][c] = column;
                for row in &mut blocks[k + 1..] {
                    let change = times(&row[k], &column);
                    subtract(&mut row[j][c], &change);
                }
            }
        }
        true
    }

    /// Solves for the corrections Δq and Δv of all stages. `z` has the changes of the stages from the start of the step, and
    /// `rates` the velocities and accelerations there; r and s are what is left between them and the slopes of `z`.
    pub(super) fn corrections(
        &self,
        z: &StageChanges<T, N, S>,
        rates: &StageChanges<T, N, S>,
    ) -> StageChanges<T, N, S> {
        let h = self.h;
        let slopes = product(&self.slopes, z);
        let residual: StageChanges<T, N, S> =
            from_fn(|k| zip(&rates[k], &slopes[k], |rate, slope| rate - slope / h));
        let turned = product(&self.slopes, &residual);
        let coordinates = self.solve(from_fn(|k| {
            let mut right = Array::from_fn(|i| residual[k][1][i] + turned[k][0][i] / h);
            subtract(&mut right, &times(&self.derivatives[k].by_v, &residual[k].half(0)));
            right
        }));
        let changes = coordinates.map(|q| PhaseVector::new([q, q]));
        let slopes = product(&self.slopes, &changes);
        from_fn(|k| {
            let velocities = Array::from_fn(|i| slopes[k][1][i] / h - residual[k][0][i]);
            PhaseVector::new([coordinates[k], velocities])
        })
    }

    /// Solves the factorized equations.
    fn solve(&self, mut x: [Array<T, N>; S]) -> [Array<T, N>; S] {
        for k in 0..S {
            for j in 0..k {
                let known = times(&self.blocks[k][j], &x[j]);
                subtract(&mut x[k], &known);
            }
            x[k] = self.diagonal[k].solve(x[k]);
        }
        for k in (0..S).rev() {
            for j in k + 1..S {
                let known = times(&self.blocks[k][j], &x[j]);
                subtract(&mut x[k], &known);
            }
        }
        x
    }
}

fn subtract<T: Real, N: StaticLength>(x: &mut Array<T, N>, y: &Array<T, N>) {
    x.iter_mut().zip(y.iter()).for_each(|(x, y)| *x -= *y);
}

/// The product of a matrix, given by its columns, and a vector.
fn times<T: Real, N: StaticLength>(columns: &Square<T, N>, x: &Array<T, N>) -> Array<T, N> {
    let mut sum = Array::filled(T::constant(0.0));
    for (column, x) in columns.iter().zip(x.iter()) {
        sum.iter_mut().zip(column.iter()).for_each(|(sum, a)| *sum += *a * *x);
    }
    sum
}

#[cfg(test)]
mod tests {
    use nalgebra::Const;

    use super::super::equations::Factorizations;
    use super::super::tableau::{RadauStages, Transformation};
    use super::*;

    type N = Const<3>;

    /// Numbers that look random, in (−1, 1).
    fn numbers(seed: f64) -> impl FnMut() -> f64 {
        let mut at = seed;
        move || {
            at += 1.0;
            (at * at * 12.989_8).sin()
        }
    }

    fn changes<const S: usize>(seed: f64) -> StageChanges<f64, N, S> {
        let mut next = numbers(seed);
        from_fn(|_| PhaseVector::new(from_fn(|_| Array::from_fn(|_| next()))))
    }

    /// With the same derivatives at all stages, the eigenvectors of W uncouple them: both solve the same equations.
    fn agrees_with_the_uncoupled_equations<const S: usize>()
    where
        Const<S>: RadauStages,
    {
        let (transformation, h) = (Transformation::<S>::new(), 0.1);
        let fill = |derivatives: &mut Derivatives<f64, N>| {
            let mut next = numbers(7.0);
            for (stiffness, columns) in [(1e3, &mut derivatives.by_q), (10.0, &mut derivatives.by_v)] {
                columns.iter_mut().flat_map(|column| column.iter_mut()).for_each(|x| *x = stiffness * next());
            }
        };
        let mut coupled = Coupled::<f64, N, S>::new(transformation.slopes);
        coupled.derivatives.iter_mut().for_each(fill);
        let mut derivatives = Derivatives::new();
        fill(&mut derivatives);
        let mut uncoupled = Factorizations::<f64, N, S>::new();
        assert!(coupled.factorize(h) && uncoupled.factorize(&derivatives, h));
        let (z, rates) = (changes(1.0), changes(2.0));
        let found = coupled.corrections(&z, &rates);
        let expected = uncoupled.corrections(&transformation, &derivatives, &z, &rates);
        let size = expected.iter().flat_map(|x| x.flat()).fold(0.0_f64, |most, x| most.max(x.abs()));
        for (found, expected) in found.iter().zip(&expected) {
            for (found, expected) in found.flat().iter().zip(expected.flat()) {
                assert!(
                    (found - expected).abs() < 1e-11 * size,
                    "{S} stages: {found} in place of {expected}"
                );
            }
        }
    }

    #[test]
    fn equal_derivatives_give_the_solution_of_the_uncoupled_equations() {
        agrees_with_the_uncoupled_equations::<3>();
        agrees_with_the_uncoupled_equations::<5>();
        agrees_with_the_uncoupled_equations::<7>();
    }
}
