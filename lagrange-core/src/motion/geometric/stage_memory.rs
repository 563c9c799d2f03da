//! Stages of the last step of a partitioned Runge–Kutta method, from which those of the next one are guessed.

use crate::motion::limits::FARTHEST;
use crate::number::{Parts, Scalar};
use crate::system::{Lagrangian, StateOf};
use crate::vector::{Array, Element, StaticLength, array, from_fn};

/// Data carried from step to step.
#[derive(Clone, Debug)]
pub struct StageMemory<F, T: Element, N: StaticLength, M: StaticLength, const S: usize> {
    /// Factorization of the equations at the state.
    pub(super) factor: F,
    /// Momenta, and their rounding errors.
    pub(super) momenta: [Array<T, N>; 2],
    /// Velocities and multipliers of the stages of the last step; at the start those of a step of length `length`.
    pub(super) velocities: [Array<T, N>; S],
    pub(super) multipliers: [Array<T, M>; S],
    /// Length of that step; zero if there is none, and all stages equal the start.
    length: T,
    /// Accelerations at the start, for the first step.
    accelerations: Array<T, N>,
    /// Largest terms of the momenta so far.
    pub(super) largest: Array<T, N>,
}

impl<F: Copy, T: Parts, N: StaticLength, M: StaticLength, const S: usize> StageMemory<F, T, N, M, S> {
    /// Evaluates what the first step from a state needs.
    pub(super) fn start<L>(system: &L, state: &StateOf<L>) -> Self
    where
        L: Lagrangian<Scalar = T, N = N, M = M, Factor = F>,
    {
        let solution = system.accelerations_unchecked(state);
        Self {
            factor: system.factor(state),
            momenta: [array(system.completed_momentum(state)), Array::filled(T::constant(0.0))],
            velocities: [array(state.v); S],
            multipliers: [array(solution.multipliers); S],
            length: T::constant(0.0),
            accelerations: array(solution.accelerations),
            largest: Array::filled(T::constant(0.0)),
        }
    }

    /// The same, with the stages of the step before.
    pub(super) fn start_after<L>(system: &L, state: &StateOf<L>, before: &Self) -> Self
    where
        L: Lagrangian<Scalar = T, N = N, M = M, Factor = F>,
    {
        let Self { velocities, multipliers, length, largest, .. } = *before;
        Self { velocities, multipliers, length, largest, ..Self::start(system, state) }
    }

    /// Sets the stages to the start of the next step, of length `h`, if the last one was much shorter.
    pub(super) fn forget_a_short_step<L>(&mut self, system: &L, state: &StateOf<L>, h: T)
    where
        L: Lagrangian<Scalar = T, N = N, M = M, Factor = F>,
    {
        if self.length != T::constant(0.0) && !h.magnitude().is_within(FARTHEST, self.length.magnitude()) {
            let Self { momenta, largest, .. } = *self;
            *self = Self { momenta, largest, ..Self::start(system, state) };
        }
    }

    /// Initial guess for the stages of a step of length `h`: the polynomials through the stages of the last step, or the
    /// accelerations at the start.
    pub(super) fn guess(&mut self, nodes: &[f64; S], h: T) {
        let zero = T::constant(0.0);
        if self.length == zero {
            let grown = |c: f64, v: &Array<T, N>| {
                Array::from_fn(|i| v[i] + T::constant(c) * h * self.accelerations[i])
            };
            self.velocities = from_fn(|i| grown(nodes[i], &self.velocities[i]));
        } else {
            let ratio = h / self.length;
            let at: [T; S] = from_fn(|i| T::constant(1.0) + T::constant(nodes[i]) * ratio);
            let weights: [[T; S]; S] = from_fn(|i| lagrange(nodes, at[i]));
            let (velocities, multipliers) = (self.velocities, self.multipliers);
            self.velocities = from_fn(|i| interpolated(&weights[i], &velocities));
            self.multipliers = match S {
                2 => multipliers,
                _ => from_fn(|i| interpolated(&without_last(nodes, at[i]), &multipliers)),
            };
        }
        self.length = h;
    }
}

/// Values at `x` of Lagrange's polynomials on the nodes.
fn lagrange<T: Scalar, const S: usize>(nodes: &[f64; S], x: T) -> [T; S] {
    from_fn(|j| {
        let others = (0..S).filter(|&k| k != j);
        others.fold(T::constant(1.0), |product, k| {
            product * (x - T::constant(nodes[k])) * T::constant(1.0 / (nodes[j] - nodes[k]))
        })
    })
}

/// The same on all nodes but the last, at which there is no multiplier.
fn without_last<T: Scalar, const S: usize>(nodes: &[f64; S], x: T) -> [T; S] {
    from_fn(|j| {
        let others = (0..S - 1).filter(|&k| k != j);
        let one = T::constant(if j + 1 < S { 1.0 } else { 0.0 });
        others.fold(one, |product, k| {
            product * (x - T::constant(nodes[k])) * T::constant(1.0 / (nodes[j] - nodes[k]))
        })
    })
}

fn interpolated<T: Scalar, K: StaticLength, const S: usize>(
    weights: &[T; S],
    values: &[Array<T, K>; S],
) -> Array<T, K> {
    Array::from_fn(|i| (0..S).fold(T::constant(0.0), |sum, j| weights[j].multiply_add(values[j][i], sum)))
}
