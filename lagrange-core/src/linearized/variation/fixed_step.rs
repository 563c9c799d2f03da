//! Variations along steps of fixed length: the step of the motion, over dual numbers.
//!
//! The iteration of an implicit step goes on until the slopes satisfy its equations, too, so by the implicit function
//! theorem the variations are those of the discrete map, to round-off. Along a symplectic method they are a symplectic
//! map.

use alloc::vec::Vec;
use core::convert::Infallible;

use super::duals::{Duals, PackedDuals, with_rates, with_slopes};
use super::{Block, DifferentiableMethod, Variations, VariedRun};
use crate::derivatives::tangent::WideOf;
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::motion::geometric::{CompensatedState, FixedStep, Scheme};
use crate::number::limits::CANCELLED;
use crate::number::{Broadcast, Dual, Parts, Real, Scalar, Wide, is_within, larger, power_of_epsilon};
use crate::solution::solve::first_row;
use crate::system::{Lagrangian, Pack, State, StateOf};
use crate::vector::{Array, Element, PhaseVector, StaticLength};

/// A system over dual numbers, and the last step computed with it.
#[derive(Debug)]
pub struct VariedSteps<S, C, W: Element, N: StaticLength> {
    /// System over dual numbers; the slope of each parameter is its rate of change in [`Block::rates`].
    system: S,
    last: Option<VariedStep<C, W, N>>,
}

/// A step over dual numbers.
#[derive(Debug)]
struct VariedStep<C, W: Element, N: StaticLength> {
    ends: [State<Dual<W>, N>; 2],
    /// Data that the step left: the next one begins its iteration where that of the motion does.
    carried: C,
}

impl<L, S> DifferentiableMethod<L> for FixedStep<S>
where
    L: Linearized<Scalar: Real> + Pack<Duals<L>>,
    PackedDuals<L>: Linearized<N = L::N, M = L::M, P = L::P, Scalar = Duals<L>>,
    S: Scheme<L> + Scheme<PackedDuals<L>> + Default,
{
    type VariationMemory =
        Vec<VariedSteps<PackedDuals<L>, <S as Scheme<PackedDuals<L>>>::Carried, WideOf<L>, L::N>>;

    fn companion(
        &self,
        system: &L,
        _: &StateOf<L>,
        variations: &Variations<L>,
    ) -> Result<Self::VariationMemory, Error> {
        let varied = |block: &Block<_, L::N, L::P>| {
            Ok(VariedSteps { system: with_rates::<L>(system, block.rates.as_ref())?, last: None })
        };
        variations.blocks.iter().map(varied).collect()
    }

    fn follow(&self, at: VariedRun<'_, L, Self>) -> Result<(), Ending> {
        let VariedRun { run, variations, memory: companion, .. } = at;
        let (before, after) = (&run.before, &run.state);
        for (k, varied) in companion.iter_mut().enumerate() {
            let block = &variations.blocks[k];
            let start = with_slopes(before, &block.y);
            let mut point = CompensatedState::at(&start);
            let mut carried = match &varied.last {
                None => <S as Scheme<PackedDuals<L>>>::start(&varied.system, &start),
                Some(last) => S::start_after(&varied.system, &start, &last.carried),
            };
            let constant =
                |x: L::Scalar| Dual { value: WideOf::<L>::of(x), slope: WideOf::<L>::constant(0.0) };
            let (h, to) = (constant(after.t - before.t), constant(after.t));
            let moved = self.advance(&varied.system, &mut point, &mut carried, (h, to));
            let y =
                PhaseVector::new([&point.state.q, &point.state.v].map(|x| Array::from_fn(|i| x[i].slope)));
            let lanes = block.lanes;
            let broken = |lane: usize, i: usize| !(0..2).all(|half| Parts::is_finite(y[half][i].lane(lane)));
            let fault =
                (0..lanes).find_map(|lane| Some((first_row::<L>(|i| broken(lane, i), |_| false)?, lane)));
            let time = before.t.to_f64();
            match (moved, fault) {
                (_, Some((row, lane))) => {
                    let entry = variations.arguments()[block.first + lane];
                    return Err(Ending::of(Error::DerivativeNotFinite { row, entry, time }, time));
                }
                (Err(_), None) => {
                    return Err(Ending::MethodFailed {
                        time,
                        reason: "the derivatives of a step do not converge; take shorter steps",
                    });
                }
                (Ok(_), None) if !is_near(&start, &point.state, after) => {
                    return Err(Ending::MethodFailed {
                        time,
                        reason: "the derivatives of a step lead to another solution of its equations; take shorter steps",
                    });
                }
                (Ok(_), None) => varied.last = Some(VariedStep { ends: [start, point.state], carried }),
            }
            variations.blocks[k].y = y;
        }
        Ok(())
    }

    fn interpolate(
        &self,
        VariedRun { system, run, memory: companion, .. }: VariedRun<'_, L, Self>,
        within: &mut Vec<Self::Interpolant>,
        coefficients: &mut Vec<PhaseVector<WideOf<L>, L::N>>,
    ) -> Result<(), Ending> {
        run.look_within(system, self, within)?;
        for VariedSteps { system, last } in companion {
            let Some(VariedStep { ends: [start, end], .. }) = last else { continue };
            let accelerations = |state: &_| system.accelerations_unchecked(state).accelerations;
            let ends = PhaseVector::of(accelerations(start), accelerations(end));
            let Ok(found) = self.coefficients::<PackedDuals<L>, Infallible>([start, end], &ends, |state| {
                Ok(accelerations(state))
            });
            let slopes = |y: &PhaseVector<Duals<L>, L::N>| {
                PhaseVector::new(y.arrays().map(|half| half.map(|x| x.slope)))
            };
            coefficients.extend(found.iter().map(slopes));
        }
        Ok(())
    }
}

/// True if a step over dual numbers from `start` ends at the state of the motion, to half of the digits of each coordinate or
/// to round-off of the largest. Iterations that end at one solution agree to their round-off; others are as far apart as the
/// step is long.
fn is_near<T: Real<Wide = W>, W: Wide<T>, N: StaticLength>(
    start: &State<Dual<W>, N>,
    end: &State<Dual<W>, N>,
    motion: &State<T, N>,
) -> bool {
    let size = |i: usize| Scalar::abs(start.q[i].value.lane(0)) + Scalar::abs(motion.q[i]);
    let largest = (0..N::COUNT).fold(T::constant(0.0), |most, i| larger(most, size(i)));
    let round_off = T::constant(CANCELLED * T::EPSILON) * largest;
    (0..N::COUNT).all(|i| {
        let off = Scalar::abs(end.q[i].value.lane(0) - motion.q[i]);
        is_within(off, power_of_epsilon::<T>(0.5) * size(i) + round_off)
    })
}
