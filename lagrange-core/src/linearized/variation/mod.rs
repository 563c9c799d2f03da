//! Variational equations, integrated along the steps of a motion.
//!
//! A step of the variations is the derivative of the step of the motion at fixed step length; each method provides it
//! (internal differentiation: Bock, *Numerical treatment of inverse problems in chemical reaction kinetics*, 1981;
//! Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, II.6, "Sensitivity analysis").
//!
//! After each step the variations are projected onto the tangent space. On the constraints this is the derivative of
//! the projection of the state: δq += x with M x = Fᵀμ, F x = −δΦ, then δq̇ by δ(F q̇ + b). Steps end near the
//! constraints, and the projection applies the rows of velocity constraints to δq too, which changes it by no more than
//! the error of a step. At the start, which parameters may shift, F is that of the holonomic constraints alone, as for
//! the state.

mod classical;
mod differentiable;
mod duals;
mod equations;
mod fixed_step;
mod stages;
mod taylor;

use alloc::vec::Vec;

use super::Linearized;
use crate::derivatives::tangent::{Tangent, WideOf, parameter};
use crate::error::Error;
use crate::names::Entry;
use crate::number::{Real, Scalar, Wide, unit_of};
use crate::room::Room;
use crate::solution::consistent::factors_of_nearest;
use crate::solution::kkt::{Factors, Fault, Rank};
use crate::solution::solve::fault;
use crate::vector::{Array, Element, PhaseVector, StaticLength, Vector, zeros};

pub use differentiable::DifferentiableMethod;
pub(super) use differentiable::VariedRun;
pub(super) use equations::VariationalEquations;

/// Variations of a motion, one per SIMD lane.
#[derive(Clone, Debug)]
pub(crate) struct Block<W: Element, N: StaticLength, P: StaticLength> {
    /// Variations δ(q, q̇).
    pub(crate) y: PhaseVector<W, N>,
    /// Variations at the stage of a step that is being computed.
    pub(crate) at_stage: PhaseVector<W, N>,
    /// Rates of change of the parameters; `None` if no lane varies a parameter.
    pub(crate) rates: Option<Vector<W, P>>,
    /// Reciprocal scale of each lane: 1/|p| if the lane varies a parameter p ≠ 0, else 1.
    pub(crate) unit: W,
    /// Number of lanes in use.
    pub(crate) lanes: usize,
    /// Index of the argument of the first lane.
    pub(crate) first: usize,
}

/// Variations of a motion by several arguments, in blocks of lanes.
#[derive(Debug)]
pub struct Variations<L: Linearized<Scalar: Real>> {
    arguments: Vec<Entry>,
    pub(crate) blocks: Vec<Block<WideOf<L>, L::N, L::P>>,
}

impl<L: Linearized<Scalar: Real>> Variations<L> {
    /// Variations at the start of a motion: `column` gives δ(q, q̇) for each argument, and arguments that are
    /// parameters also change the equations. With constraints, the variations are projected onto the tangent space:
    /// parameters may shift the start, and only the part of a change along the constraints changes the motion.
    pub(super) fn begin(
        tangent: &Tangent<'_, L>,
        arguments: Vec<Entry>,
        column: impl Fn(usize) -> [Vector<L::Scalar, L::N>; 2],
    ) -> Result<Self, Error> {
        let mut variations = Self::none(tangent.system, arguments);
        variations.restart(tangent, column)?;
        Ok(variations)
    }

    /// Variations that are zero, by these arguments.
    pub(super) fn none(system: &L, arguments: Vec<Entry>) -> Self {
        let lanes = <WideOf<L> as Wide<L::Scalar>>::COUNT;
        let parameters: Vec<_> = arguments.iter().map(|entry| parameter::<L>(*entry)).collect();
        let values = system.parameters();
        let block = |(k, parameters)| Block::of(k * lanes, parameters, &values);
        let blocks = parameters.chunks(lanes).enumerate().map(block).collect();
        Self { arguments, blocks }
    }

    /// Puts the variations at the start of a motion again: `column` gives δ(q, q̇) for each argument.
    pub(super) fn restart(
        &mut self,
        tangent: &Tangent<'_, L>,
        column: impl Fn(usize) -> [Vector<L::Scalar, L::N>; 2],
    ) -> Result<(), Error> {
        let lanes = <WideOf<L> as Wide<L::Scalar>>::COUNT;
        for j in 0..self.count() {
            let column = column(j);
            let entries = self.blocks[j / lanes].y.flat_mut().iter_mut().zip(column.iter().flatten());
            entries.for_each(|(wide, x)| wide.put(j % lanes, *x));
        }
        self.set_out(tangent)
    }

    /// Number of variations.
    pub(super) fn count(&self) -> usize {
        self.arguments.len()
    }

    /// Orthonormalizes the variations one after the other (Gram–Schmidt, each twice). Passes to `take` the length of
    /// each after it is made orthogonal to those before. The arrays `linear`, one per block, are combined in the same
    /// way.
    pub(super) fn orthonormalize(
        &mut self,
        linear: &mut [&mut PhaseVector<WideOf<L>, L::N>],
        mut take: impl FnMut(usize, L::Scalar),
    ) {
        for j in 0..self.count() {
            for k in (0..j).chain(0..j) {
                let along = self.dot(j, k);
                self.combine(linear, [j, k], |x, y| x - along * y);
            }
            let length = Scalar::sqrt(self.dot(j, j));
            self.combine(linear, [j, j], |x, _| x / length);
            take(j, length);
        }
    }

    /// Replaces variation `into` by the combination `of` itself and variation `from`.
    fn combine(
        &mut self,
        linear: &mut [&mut PhaseVector<WideOf<L>, L::N>],
        [into, from]: [usize; 2],
        of: impl Fn(L::Scalar, L::Scalar) -> L::Scalar,
    ) {
        let lanes = <WideOf<L> as Wide<L::Scalar>>::COUNT;
        let [into, from] = [into, from].map(|j| (j / lanes, j % lanes));
        let combine = |x: &mut WideOf<L>, y: WideOf<L>| {
            let combined = of(x.lane(into.1), y.lane(from.1));
            x.put(into.1, combined);
        };
        let from_y = self.blocks[from.0].y;
        let pairs = self.blocks[into.0].y.flat_mut().iter_mut().zip(from_y.flat());
        pairs.for_each(|(x, y)| combine(x, *y));
        if !linear.is_empty() {
            let y = *linear[from.0];
            let pairs = linear[into.0].flat_mut().iter_mut().zip(y.flat());
            pairs.for_each(|(x, y)| combine(x, *y));
        }
    }

    /// Scalar product of two variations.
    fn dot(&self, j: usize, k: usize) -> L::Scalar {
        let lanes = <WideOf<L> as Wide<L::Scalar>>::COUNT;
        let entries = |j: usize| self.blocks[j / lanes].y.flat().iter().map(move |x| x.lane(j % lanes));
        entries(j).zip(entries(k)).fold(L::Scalar::constant(0.0), |sum, (x, y)| sum + x * y)
    }

    /// Arguments of the variations, in their order.
    pub(crate) fn arguments(&self) -> &[Entry] {
        &self.arguments
    }

    /// Entry of δ(q, q̇) of variation `j`, coordinates first.
    pub(super) fn entry(&self, j: usize, i: usize) -> L::Scalar {
        let lanes = <WideOf<L> as Wide<L::Scalar>>::COUNT;
        self.blocks[j / lanes].y.flat()[i].lane(j % lanes)
    }

    /// Projects the variations at the start onto the tangent space. As for the start itself, the coordinates are moved
    /// by the holonomic constraints alone.
    fn set_out(&mut self, tangent: &Tangent<'_, L>) -> Result<(), Error> {
        if const { <L::M>::COUNT > 0 } {
            let nearest = Room::of(factors_of_nearest(
                &tangent.matrices().m,
                &tangent.holonomic_rows(),
                Rank::off_constraints(),
            ));
            let equations = VariationalEquations::at(tangent, &self.arguments, &self.blocks);
            for block in &mut self.blocks {
                let position = equations.changes(block, &block.y).position;
                block
                    .move_by(&nearest, &position)
                    .map_err(|found| fault::<L>(&found, tangent.state.t.to_f64()))?;
                block.y = equations.half_projected(1, block, block.y)?;
            }
        }
        Ok(())
    }

    /// Projects the variations at the end of a step onto the tangent space.
    pub(crate) fn arrive(&mut self, tangent: &Tangent<'_, L>) -> Result<(), Error> {
        if const { <L::M>::COUNT > 0 } {
            let equations = VariationalEquations::at(tangent, &self.arguments, &self.blocks);
            for block in &mut self.blocks {
                block.y = equations.projected(block, block.y)?;
            }
        }
        Ok(())
    }

    /// The equations of the variations at a state.
    pub(super) fn equations<'a>(&'a self, tangent: &'a Tangent<'a, L>) -> VariationalEquations<'a, L> {
        VariationalEquations::at(tangent, &self.arguments, &self.blocks)
    }
}

impl<W: Scalar, N: StaticLength, P: StaticLength> Block<W, N, P> {
    /// Creates a block of variations that are zero, one per lane, from argument `first` on. Each is by the parameter of
    /// this index, or by an entry of the state if it is `None`.
    fn of<T: Real>(first: usize, parameters: &[Option<usize>], values: &Vector<T, P>) -> Self
    where
        W: Wide<T>,
    {
        let (one, none) = (T::constant(1.0), PhaseVector::filled(W::constant(0.0)));
        let (mut rates, mut unit): (Option<Vector<W, P>>, _) = (None, W::constant(1.0));
        for (lane, k) in parameters.iter().enumerate().filter_map(|(lane, k)| Some((lane, (*k)?))) {
            rates.get_or_insert_with(zeros)[k].put(lane, one);
            unit.put(lane, one / unit_of(Scalar::abs(values[k])));
        }
        Self { y: none, at_stage: none, rates, unit, lanes: parameters.len(), first }
    }

    /// Adds to δq the correction that compensates these changes of Φ, lane by lane.
    fn move_by<T: Real<Wide = W>, M: StaticLength>(
        &mut self,
        nearest: &Factors<T, N, M>,
        position: &Vector<W, M>,
    ) -> Result<(), Fault<T, N>>
    where
        W: Wide<T>,
    {
        for lane in 0..self.lanes {
            let demanded = Array::from_fn(|a| position[a].lane(lane));
            let least = nearest.solve(&Array::filled(T::constant(0.0)), &demanded)?.accelerations;
            let moved = self.y[0].iter_mut().zip(&least);
            moved.for_each(|(x, least)| x.put(lane, x.lane(lane) + *least));
        }
        Ok(())
    }
}
