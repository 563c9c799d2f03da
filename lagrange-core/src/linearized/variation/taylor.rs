//! Variations along the steps of Taylor's method: the recurrences of the motion, evaluated over dual numbers.
//!
//! Each number in a series carries its derivatives along one direction per lane, and so do the coefficients. The series
//! is thus differentiated at fixed step length by the recurrences that made it.

mod general;

use alloc::vec::Vec;
use core::array::from_fn;
use core::convert::Infallible;

use nalgebra::{ComplexField, SVector};

use super::{Block, DifferentiableMethod, Variations};
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::tangent::{Tangent, WideOf};
use crate::motion::method::control::SLACK;
use crate::motion::run::Run;
use crate::motion::taylor::expansion::Expansion;
use crate::motion::taylor::last::{LAST, Last};
use crate::motion::taylor::{Taylor, TaylorMemory};
use crate::names::Entry;
use crate::number::{Broadcast, Dual, FixedArray, Real, Scalar, Wide, entries, exceeds, smaller, vector};
use crate::solution::pivot::least_pivot;
use crate::solution::solve::first_row;
use crate::solution::vector_field::{LagrangianVectorField, PhaseVector};
use crate::system::{Lagrangian, Pack, RightHandSides, Solution, State, TaylorSeries};
use general::DualGeneral;

/// Dual numbers with derivatives along one direction per lane.
type Duals<L, const N: usize, const M: usize> = Dual<WideOf<L, N, M>>;
/// The system over these dual numbers.
type PackedDuals<L, const N: usize, const M: usize> = <L as Pack<Duals<L, N, M>>>::Packed;
type Sums<L, const N: usize, const M: usize> = <PackedDuals<L, N, M> as TaylorSeries<N, M>>::Sums;

/// A motion with one variation per lane, as a system and a series over dual numbers.
#[derive(Debug)]
pub struct Varied<S, U, W, const N: usize> {
    /// System over dual numbers; the slope of each parameter is its rate of change in [`Block::rates`].
    system: S,
    series: Expansion<U, Dual<W>, N>,
}

/// A step of a block of variations.
struct BlockStep<W, const N: usize> {
    /// Variations at the start of the step.
    before: PhaseVector<W, N>,
    /// Rates of δq̇ at the end of the series.
    rates: [W; N],
}

impl<L, const N: usize, const M: usize, const P: usize> DifferentiableMethod<L, N, M, P> for Taylor
where
    L: Linearized<N, M, P, Scalar: Real> + TaylorSeries<N, M> + Pack<Duals<L, N, M>>,
    PackedDuals<L, N, M>: TaylorSeries<N, M, Scalar = Duals<L, N, M>> + Linearized<N, M, P>,
{
    type VariationMemory = Vec<Varied<PackedDuals<L, N, M>, Sums<L, N, M>, WideOf<L, N, M>, N>>;

    fn companion(
        &self,
        system: &L,
        _: &State<L::Scalar, N>,
        variations: &Variations<L, N, M, P>,
    ) -> Result<Self::VariationMemory, Error> {
        let order = self.order::<L::Scalar>();
        let varied = |block: &Block<_, N, P>| {
            let system = with_rates::<L, N, M, P>(system, block.rates.as_ref())?;
            Ok(Varied { system, series: Expansion::new::<PackedDuals<L, N, M>, M>(order) })
        };
        variations.blocks.iter().map(varied).collect()
    }

    fn prepare(
        &self,
        system: &L,
        run: &mut Run<Self::Memory, L::Scalar, N>,
        end: L::Scalar,
        variations: &Variations<L, N, M, P>,
        companion: &mut Self::VariationMemory,
    ) -> Result<(), Ending> {
        let (memory, time) = (&mut run.memory, run.state.t.to_f64());
        self.aim(memory, end);
        let of = |error| Ending::of(error, time);
        self.expand(system, memory, &mut run.statistics).map_err(of)?;
        for (k, (varied, block)) in companion.iter_mut().zip(&variations.blocks).enumerate() {
            let entry = |lane| variations.argument(k, lane);
            varied.expand::<L, _, M, P>(system, memory, block, entry).map_err(of)?;
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

    fn follow(
        &self,
        system: &L,
        run: &mut Run<Self::Memory, L::Scalar, N>,
        variations: &mut Variations<L, N, M, P>,
        companion: &mut Self::VariationMemory,
    ) -> Result<(), Ending> {
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
        system: &L,
        run: &mut Run<Self::Memory, L::Scalar, N>,
        _: &mut Variations<L, N, M, P>,
        companion: &mut Self::VariationMemory,
        within: &mut Vec<Self::Interpolant>,
        coefficients: &mut Vec<PhaseVector<WideOf<L, N, M>, N>>,
    ) -> Result<(), Ending> {
        run.look_within::<L, LagrangianVectorField, Self, M>(system, self, within)?;
        let memory = &run.memory;
        let theta = (memory.clock.now - memory.series.start) / memory.series.unit;
        companion.iter().for_each(|varied| varied.push_coefficients(theta, coefficients));
        Ok(())
    }

    fn between(
        coefficients: &[PhaseVector<WideOf<L, N, M>, N>],
        part: WideOf<L, N, M>,
    ) -> PhaseVector<WideOf<L, N, M>, N> {
        let zero = [[WideOf::<L, N, M>::constant(0.0); N]; 2];
        coefficients.iter().rev().fold(zero, |sum, coefficient| {
            from_fn(|half| entries(|i| sum[half][i].multiply_add(part, coefficient[half][i])))
        })
    }
}

impl Taylor {
    /// Reciprocal scales for coefficients of variations. The scale of an entry is `SLACK` times the sum of the largest
    /// δq (or δq̇) and the scale of the motion, in units of the variations.
    fn scales<S, T: Real, W: Wide<T>, const N: usize>(
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
            entries(|i| one / (times * (largest + unit * W::of(Scalar::abs(own[half][i]) + slack))))
        })
    }

    /// Projects the variations onto the tangent space. Returns the argument of a variation whose accelerations at the
    /// end of its series deviate too far from the equations; `None` if there is none.
    fn off<L, const N: usize, const M: usize, const P: usize>(
        &self,
        system: &L,
        memory: &TaylorMemory<L::Sums, L::Scalar, N, M>,
        variations: &mut Variations<L, N, M, P>,
        steps: &[BlockStep<WideOf<L, N, M>, N>],
    ) -> Result<Option<Entry>, Error>
    where
        L: Linearized<N, M, P, Scalar: Real> + TaylorSeries<N, M>,
    {
        let tangent = Tangent::of(system, &memory.state, memory.solved.solution);
        variations.arrive(&tangent)?;
        let length = WideOf::<L, N, M>::of(Scalar::abs(memory.clock.now - memory.series.start));
        let bound = L::Scalar::constant(self.jump_allowed::<L::Scalar>());
        let mut worst = None;
        let look = |k: usize, [_, slope]: PhaseVector<WideOf<L, N, M>, N>| {
            let block = &variations.blocks[k];
            let BlockStep { before, rates } = &steps[k];
            let [_, scales] = self.scales([before, &block.y], block.unit, &memory.series);
            let off = (0..N).map(|i| (rates[i] - slope[i]).abs() * length * scales[i]);
            let off = off.fold(WideOf::<L, N, M>::constant(0.0), |most, off| most + off);
            let lane = (0..block.lanes).find(|&lane| exceeds(off.lane(lane), bound));
            worst = worst.or_else(|| lane.map(|lane| variations.argument(k, lane)));
        };
        variations.slopes_at(&tangent, |_, block| block.y, look)?;
        Ok(worst)
    }
}

/// Converts the system to dual numbers whose parameters change at these rates.
fn with_rates<L, const N: usize, const M: usize, const P: usize>(
    system: &L,
    rates: Option<&SVector<WideOf<L, N, M>, P>>,
) -> Result<PackedDuals<L, N, M>, Error>
where
    L: Linearized<N, M, P, Scalar: Real> + Pack<Duals<L, N, M>>,
    PackedDuals<L, N, M>: Linearized<N, M, P, Scalar = Duals<L, N, M>>,
{
    let (mut over, values) = (system.pack(), system.parameters());
    let Some(rates) = rates else { return Ok(over) };
    let zero = L::Scalar::constant(0.0);
    for k in 0..P {
        let changes = (0..WideOf::<L, N, M>::COUNT).any(|lane| rates[k].lane(lane) != zero);
        let value = Dual { value: WideOf::<L, N, M>::of(values[k]), slope: rates[k] };
        if changes && !over.set_parameter(k, value) {
            return Err(Error::ParameterFixed { name: L::PARAMETERS[k] });
        }
    }
    Ok(over)
}

impl<S, U, W: Scalar, const N: usize> Varied<S, U, W, N>
where
    U: FixedArray<Dual<W>>,
{
    /// Expands the motion and its variations in Taylor series about the present state.
    fn expand<L, V, const M: usize, const P: usize>(
        &mut self,
        system: &L,
        memory: &TaylorMemory<V, L::Scalar, N, M>,
        block: &Block<W, N, P>,
        entry: impl Fn(usize) -> Entry,
    ) -> Result<(), Error>
    where
        L: Lagrangian<N, M, Scalar: Real<Wide = W>>,
        S: TaylorSeries<N, M, Scalar = Dual<W>, Sums = U>,
        W: Wide<L::Scalar>,
        V: FixedArray<L::Scalar>,
    {
        let dual = |value: L::Scalar, slope| Dual { value: W::of(value), slope };
        let (at, none, [q, v]) = (&memory.state, W::constant(0.0), &block.y);
        let state = State {
            t: dual(at.t, none),
            q: vector(from_fn(|i| dual(at.q[i], q[i]))),
            v: vector(from_fn(|i| dual(at.v[i], v[i]))),
        };
        let unit = dual(memory.series.unit, none);
        let solution = self.system.accelerations_unchecked(&state);
        if memory.solved.is_by_elimination() && is_sound::<L::Scalar, W, N, M>(&solution) {
            let factor = self.system.factor(&state);
            let solve = |(forcing, bias): &RightHandSides<_, N, M>| {
                Ok(self.system.solve_with(&factor, forcing, bias))
            };
            let Ok::<(), Infallible>(()) = self.series.orders(&self.system, &state, &solution, unit, solve);
        } else {
            self.expand_in_general(system, (at, &state), unit, memory.solved.active)?;
        }
        self.check::<L, M>(block.lanes, at.t, entry)
    }

    /// Like `expand`, by the general factors. A separate function, because the matrices are large.
    #[cold]
    #[inline(never)]
    fn expand_in_general<L, const M: usize>(
        &mut self,
        system: &L,
        (at, state): (&State<L::Scalar, N>, &State<Dual<W>, N>),
        unit: Dual<W>,
        active: [bool; M],
    ) -> Result<(), Error>
    where
        L: Lagrangian<N, M, Scalar: Real<Wide = W>>,
        S: TaylorSeries<N, M, Scalar = Dual<W>, Sums = U>,
        W: Wide<L::Scalar>,
    {
        let general = DualGeneral::at(system, &self.system, (at, state), active)?;
        let sides = (self.system.forcing(state), self.system.constraint_bias(state));
        let (solution, solve) = (general.solve::<L>(&sides)?, |sides: &_| general.solve::<L>(sides));
        self.series.orders(&self.system, state, &solution, unit, solve)
    }

    /// Fails if the derivatives of a coefficient are not finite.
    fn check<L, const M: usize>(
        &self,
        lanes: usize,
        time: L::Scalar,
        entry: impl Fn(usize) -> Entry,
    ) -> Result<(), Error>
    where
        L: Lagrangian<N, M, Scalar: Real<Wide = W>>,
        W: Wide<L::Scalar>,
    {
        let last = self.series.last();
        for lane in 0..lanes {
            let is_broken = |i: usize| last.iter().any(|x| !x[i].slope.lane(lane).is_finite());
            if let Some(row) = first_row::<L, N, M>(is_broken, |_| false) {
                return Err(Error::DerivativeNotFinite { row, entry: entry(lane), time: time.to_f64() });
            }
        }
        Ok(())
    }

    /// Largest derivative of a coefficient of this order, relative to the scales.
    fn size(&self, order: usize, scales: &PhaseVector<W, N>) -> W {
        let coefficients = [&self.series.q[order], &self.series.v[order]];
        let sizes = coefficients.iter().zip(scales);
        let sizes = sizes.flat_map(|(x, scales)| (0..N).map(move |i| x[i].slope.abs() * scales[i]));
        sizes.fold(W::constant(0.0), |most, size| most.max(size))
    }

    /// Advances the variations to the end of the step that the motion has taken.
    fn advance<T: Real<Wide = W>, V, const P: usize>(
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
        block.y = [(before[0], dq), (before[1], dv)].map(|(y, change)| entries(|i| y[i] + change[i]));
        BlockStep { before, rates }
    }

    /// Appends the coefficients for powers of the fraction of the step; `theta` is the length of the step in units of
    /// the series.
    fn push_coefficients<T: Real>(&self, theta: T, coefficients: &mut Vec<PhaseVector<W, N>>)
    where
        W: Wide<T>,
    {
        let Expansion { q, v, summed, .. } = &self.series;
        let (mut power, theta, zero) = (W::constant(1.0), W::of(theta), [W::constant(0.0); N]);
        for order in 0..q.len() {
            let is_summed = [order <= summed + 1, order <= *summed];
            let of = |x: Option<&[Dual<W>; N]>, is_summed: bool| match x.filter(|_| is_summed) {
                Some(x) => x.map(|x| x.slope * power),
                None => zero,
            };
            coefficients.push([of(q.get(order), is_summed[0]), of(v.get(order), is_summed[1])]);
            power = power * theta;
        }
    }
}

/// True if the pivots of the elimination are large enough in all lanes.
fn is_sound<T: Real, W: Wide<T>, const N: usize, const M: usize>(solution: &Solution<Dual<W>, N, M>) -> bool {
    (0..W::COUNT).all(|lane| solution.pivot.value.lane(lane) > least_pivot())
}
