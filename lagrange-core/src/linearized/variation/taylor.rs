//! Variations along the steps of Taylor's method: the recurrences of the motion, evaluated over dual numbers.
//!
//! Each number in a series carries its derivatives along one direction per lane, and so do the coefficients. The series
//! is thus differentiated at fixed step length by the recurrences that made it.

mod general;

use alloc::vec::Vec;
use core::convert::Infallible;

use nalgebra::ComplexField;

use super::duals::{Duals, PackedDuals, with_rates, with_slopes};
use super::{Block, DifferentiableMethod, Variations, VariedRun};
use crate::derivatives::tangent::{Tangent, WideOf};
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::motion::limits::SLACK;
use crate::motion::taylor::expansion::Expansion;
use crate::motion::taylor::last::Last;
use crate::motion::taylor::limits::LAST;
use crate::motion::taylor::{Taylor, TaylorMemory};
use crate::names::Entry;
use crate::number::{Broadcast, Dual, Real, Scalar, Wide, exceeds, smaller};
use crate::solution::pivot::least_pivot;
use crate::solution::solve::first_row;
use crate::system::{Lagrangian, Pack, RightHandSides, Solution, State, StateOf, TaylorSeries};
use crate::vector::{Array, Element, FixedArray, PhaseVector, StaticLength, from_fn};
use general::DualGeneral;

type Sums<L> = <PackedDuals<L> as TaylorSeries>::Sums;

/// A motion with one variation per lane, as a system and a series over dual numbers.
#[derive(Debug)]
pub struct Varied<S, U, W: Element, N: StaticLength> {
    /// System over dual numbers; the slope of each parameter is its rate of change in [`Block::rates`].
    system: S,
    series: Expansion<U, Dual<W>, N>,
}

/// A step of a block of variations.
struct BlockStep<W: Element, N: StaticLength> {
    /// Variations at the start of the step.
    before: PhaseVector<W, N>,
    /// Rates of δq̇ at the end of the series.
    rates: Array<W, N>,
}

impl<L> DifferentiableMethod<L> for Taylor
where
    L: Linearized<Scalar: Real> + TaylorSeries + Pack<Duals<L>>,
    PackedDuals<L>: TaylorSeries<N = L::N, M = L::M, Scalar = Duals<L>> + Linearized<P = L::P>,
{
    type VariationMemory = Vec<Varied<PackedDuals<L>, Sums<L>, WideOf<L>, L::N>>;

    fn companion(
        &self,
        system: &L,
        _: &StateOf<L>,
        variations: &Variations<L>,
    ) -> Result<Self::VariationMemory, Error> {
        let order = self.order::<L::Scalar>();
        let varied = |block: &Block<_, L::N, L::P>| {
            let system = with_rates::<L>(system, block.rates.as_ref())?;
            Ok(Varied { system, series: Expansion::new::<PackedDuals<L>>(order) })
        };
        variations.blocks.iter().map(varied).collect()
    }

    fn prepare(&self, at: VariedRun<'_, L, Self>, end: L::Scalar) -> Result<(), Ending> {
        let VariedRun { system, run, variations, memory: companion } = at;
        let (memory, time) = (&mut run.memory, run.state.t.to_f64());
        self.aim(memory, end);
        let of = |error| Ending::of(error, time);
        self.expand(system, memory, &mut run.statistics).map_err(of)?;
        for (varied, block) in companion.iter_mut().zip(&variations.blocks) {
            let entry = |lane| variations.arguments()[block.first + lane];
            varied.expand::<L, _, L::P>(system, memory, block, entry).map_err(of)?;
            let scales = self.scales([&block.y; 2], block.unit, &memory.series);
            let sizes: [_; LAST] = from_fn(|i| varied.size(varied.series.order() + 1 - LAST + i, &scales));
            for lane in 0..block.lanes {
                let (order, unit) = (varied.series.order(), memory.series.unit);
                let last = Last { order, unit, sizes: sizes.map(|size| size.lane(lane)) };
                let longest = self.choose(last.allowed(), memory.planned, &memory.clock);
                memory.planned = smaller(memory.planned, longest);
            }
        }
        Ok(())
    }

    fn follow(&self, at: VariedRun<'_, L, Self>) -> Result<(), Ending> {
        let VariedRun { system, run, variations, memory: companion } = at;
        let (memory, time) = (&run.memory, run.before.t.to_f64());
        let steps: Vec<_> = variations
            .blocks
            .iter_mut()
            .zip(companion)
            .map(|(block, varied)| varied.advance(block, &memory.series, memory.clock.now))
            .collect();
        let ending = match self.off(system, memory, variations, &steps) {
            Ok(None) => return Ok(()),
            Ok(Some(entry)) => Ending::StepTooSmall { time, entry },
            Err(error) => Ending::of(error, time),
        };
        variations.blocks.iter_mut().zip(steps).for_each(|(block, step)| block.y = step.before);
        Err(ending)
    }

    fn interpolate(
        &self,
        VariedRun { system, run, memory: companion, .. }: VariedRun<'_, L, Self>,
        within: &mut Vec<Self::Interpolant>,
        coefficients: &mut Vec<PhaseVector<WideOf<L>, L::N>>,
    ) -> Result<(), Ending> {
        run.look_within(system, self, within)?;
        let memory = &run.memory;
        let theta = (memory.clock.now - memory.series.start) / memory.series.unit;
        companion.iter().for_each(|varied| varied.push_coefficients(theta, coefficients));
        Ok(())
    }

    fn between(
        coefficients: &[PhaseVector<WideOf<L>, L::N>],
        part: WideOf<L>,
    ) -> PhaseVector<WideOf<L>, L::N> {
        let zero = PhaseVector::filled(WideOf::<L>::constant(0.0));
        coefficients.iter().rev().fold(zero, |sum, coefficient| {
            from_fn(|half| Array::from_fn(|i| sum[half][i].multiply_add(part, coefficient[half][i])))
        })
    }
}

impl Taylor {
    /// Reciprocal scales for coefficients of variations. The scale of an entry is `SLACK` times the sum of the largest
    /// δq (or δq̇) and the scale of the motion, in units of the variations.
    fn scales<S, T: Real, W: Wide<T>, N: StaticLength>(
        &self,
        ends: [&PhaseVector<W, N>; 2],
        unit: W,
        series: &Expansion<S, T, N>,
    ) -> PhaseVector<W, N> {
        let slack = T::constant(self.slack::<T>());
        let (own, one, times) = ([&series.q[0], &series.v[0]], W::constant(1.0), W::constant(SLACK));
        from_fn(|half| {
            let sizes = ends.iter().flat_map(|y| y[half].iter().map(|x| x.abs()));
            let largest = sizes.fold(W::constant(0.0), |most, size| most.max(size));
            Array::from_fn(|i| one / (times * (largest + unit * W::of(Scalar::abs(own[half][i]) + slack))))
        })
    }

    /// Projects the variations onto the tangent space. Returns the argument of a variation whose accelerations at the
    /// end of its series deviate too far from the equations; `None` if there is none.
    fn off<L: Linearized<Scalar: Real> + TaylorSeries>(
        &self,
        system: &L,
        memory: &TaylorMemory<L::Sums, L::Scalar, L::N, L::M>,
        variations: &mut Variations<L>,
        steps: &[BlockStep<WideOf<L>, L::N>],
    ) -> Result<Option<Entry>, Error> {
        let tangent = Tangent::of(system, &memory.state, memory.solved.solution);
        variations.arrive(&tangent)?;
        let length = WideOf::<L>::of(Scalar::abs(memory.clock.now - memory.series.start));
        let bound = L::Scalar::constant(self.jump_allowed::<L::Scalar>());
        let mut worst = None;
        let equations = variations.equations(&tangent);
        for (block, BlockStep { before, rates }) in variations.blocks.iter().zip(steps) {
            let slope = equations.slope(block, &block.y)?;
            let scales = self.scales([before, &block.y], block.unit, &memory.series);
            let off = (0..<L::N>::COUNT).map(|i| (rates[i] - slope[1][i]).abs() * length * scales[1][i]);
            let off = off.fold(WideOf::<L>::constant(0.0), |most, off| most + off);
            let lane = (0..block.lanes).find(|&lane| exceeds(off.lane(lane), bound));
            worst = worst.or_else(|| lane.map(|lane| variations.arguments()[block.first + lane]));
        }
        Ok(worst)
    }
}

impl<S, U: FixedArray<Dual<W>>, W: Scalar, N: StaticLength> Varied<S, U, W, N> {
    /// Expands the motion and its variations in Taylor series about the present state.
    fn expand<L, V, P: StaticLength>(
        &mut self,
        system: &L,
        memory: &TaylorMemory<V, L::Scalar, N, L::M>,
        block: &Block<W, N, P>,
        entry: impl Fn(usize) -> Entry,
    ) -> Result<(), Error>
    where
        L: Lagrangian<N = N, Scalar: Real<Wide = W>>,
        S: TaylorSeries<N = N, M = L::M, Scalar = Dual<W>, Sums = U>,
        W: Wide<L::Scalar>,
        V: FixedArray<L::Scalar>,
    {
        let at = &memory.state;
        let state = with_slopes(at, &block.y);
        let unit = Dual { value: W::of(memory.series.unit), slope: W::constant(0.0) };
        let solution = self.system.accelerations_unchecked(&state);
        if memory.solved.is_by_elimination() && is_sound::<L::Scalar, W, N, L::M>(&solution) {
            let factor = self.system.factor(&state);
            let solve = |(forcing, bias): &RightHandSides<_, N, L::M>| {
                Ok(self.system.solve_with(&factor, forcing, bias))
            };
            let Ok::<(), Infallible>(()) = self.series.orders(&self.system, &state, &solution, unit, solve);
        } else {
            self.expand_in_general(system, (at, &state), unit, memory.solved.active)?;
        }
        self.check::<L>(block.lanes, at.t, entry)
    }

    /// Like `expand`, by the factors of the general solver. A separate function, because the matrices are
    /// large.
    #[cold]
    #[inline(never)]
    fn expand_in_general<L>(
        &mut self,
        system: &L,
        (at, state): (&State<L::Scalar, N>, &State<Dual<W>, N>),
        unit: Dual<W>,
        active: Array<bool, L::M>,
    ) -> Result<(), Error>
    where
        L: Lagrangian<N = N, Scalar: Real<Wide = W>>,
        S: TaylorSeries<N = N, M = L::M, Scalar = Dual<W>, Sums = U>,
        W: Wide<L::Scalar>,
    {
        let general = DualGeneral::at(system, &self.system, (at, state), active)?;
        let sides = (self.system.forcing(state), self.system.constraint_bias(state));
        let (solution, solve) = (general.solve::<L>(&sides)?, |sides: &_| general.solve::<L>(sides));
        self.series.orders(&self.system, state, &solution, unit, solve)
    }

    /// Fails if the derivatives of a coefficient are not finite.
    fn check<L>(&self, lanes: usize, time: L::Scalar, entry: impl Fn(usize) -> Entry) -> Result<(), Error>
    where
        L: Lagrangian<N = N, Scalar: Real<Wide = W>>,
        W: Wide<L::Scalar>,
    {
        let last = self.series.last();
        for lane in 0..lanes {
            let is_broken = |i: usize| last.iter().any(|x| !x[i].slope.lane(lane).is_finite());
            if let Some(row) = first_row::<L>(is_broken, |_| false) {
                return Err(Error::DerivativeNotFinite { row, entry: entry(lane), time: time.to_f64() });
            }
        }
        Ok(())
    }

    /// Largest derivative of a coefficient of this order, relative to the scales.
    fn size(&self, order: usize, scales: &PhaseVector<W, N>) -> W {
        let coefficients = [&self.series.q[order], &self.series.v[order]];
        let sizes = coefficients.iter().zip([&scales[0], &scales[1]]);
        let sizes = sizes.flat_map(|(x, scales)| (0..N::COUNT).map(move |i| x[i].slope.abs() * scales[i]));
        sizes.fold(W::constant(0.0), |most, size| most.max(size))
    }

    /// Advances the variations to the end of the step that the motion has taken.
    fn advance<T: Real<Wide = W>, V, P: StaticLength>(
        &mut self,
        block: &mut Block<W, N, P>,
        motion: &Expansion<V, T, N>,
        now: T,
    ) -> BlockStep<W, N>
    where
        W: Wide<T>,
    {
        self.series.summed = motion.summed;
        let length = Dual { value: W::of(now - motion.start), slope: W::constant(0.0) };
        let [dq, dv, rates] = self.series.change(length).map(|all| all.map(|x| x.slope));
        let before = block.y;
        block.y = from_fn(|half| Array::from_fn(|i| before[half][i] + [&dq, &dv][half][i]));
        BlockStep { before, rates }
    }

    /// Appends the coefficients for powers of the fraction of the step; `theta` is the length of the step in units of
    /// the series.
    fn push_coefficients<T: Real>(&self, theta: T, coefficients: &mut Vec<PhaseVector<W, N>>)
    where
        W: Wide<T>,
    {
        let Expansion { q, v, summed, .. } = &self.series;
        let (mut power, theta, zero) = (W::constant(1.0), W::of(theta), Array::filled(W::constant(0.0)));
        for order in 0..q.len() {
            let is_summed = [order <= summed + 1, order <= *summed];
            let of = |x: Option<&Array<Dual<W>, N>>, is_summed: bool| match x.filter(|_| is_summed) {
                Some(x) => x.map(|x| x.slope * power),
                None => zero,
            };
            let halves = [of(q.get(order), is_summed[0]), of(v.get(order), is_summed[1])];
            coefficients.push(PhaseVector::new(halves));
            power = power * theta;
        }
    }
}

/// True if the pivots of the elimination are large enough in all lanes.
fn is_sound<T: Real, W: Wide<T>, N: StaticLength, M: StaticLength>(
    solution: &Solution<Dual<W>, N, M>,
) -> bool {
    (0..W::COUNT).all(|lane| solution.pivot.value.lane(lane) > least_pivot())
}
