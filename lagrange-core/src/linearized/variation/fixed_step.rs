//! Variations along steps of fixed length: the step of the motion, over dual numbers.
//!
//! The iteration of an implicit step goes on until the slopes satisfy its equations, too, so by the implicit function
//! theorem the variations are those of the discrete map, to round-off. Along a symplectic method they are a symplectic
//! map.

use alloc::vec::Vec;
use core::convert::Infallible;

use super::duals::{Duals, PackedDuals, with_rates};
use super::{Block, DifferentiableMethod, Variations};
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::tangent::WideOf;
use crate::motion::geometric::{CompensatedState, FixedStep, Scheme};
use crate::motion::run::Run;
use crate::number::{Broadcast, Dual, Parts, Real, Scalar, Wide};
use crate::solution::interpolant::evaluate;
use crate::solution::solve::first_row;
use crate::system::{Lagrangian, Pack, State, StateOf};
use crate::vector::{Array, Element, Length, PhaseVector, array, from_fn, vector};

/// A system over dual numbers, and the last step computed with it.
#[derive(Debug)]
pub struct VariedSteps<S, W: Element, N: Length> {
    /// System over dual numbers; the slope of each parameter is its rate of change in [`Block::rates`].
    system: S,
    ends: Option<[State<Dual<W>, N>; 2]>,
}

impl<L, S> DifferentiableMethod<L> for FixedStep<S>
where
    L: Linearized<Scalar: Real> + Pack<Duals<L>>,
    PackedDuals<L>: Linearized<N = L::N, M = L::M, P = L::P, Scalar = Duals<L>>,
    S: Scheme<L> + Scheme<PackedDuals<L>> + Default,
{
    type VariationMemory = Vec<VariedSteps<PackedDuals<L>, WideOf<L>, L::N>>;

    fn companion(
        &self,
        system: &L,
        _: &StateOf<L>,
        variations: &Variations<L>,
    ) -> Result<Self::VariationMemory, Error> {
        let varied = |block: &Block<_, L::N, L::P>| {
            Ok(VariedSteps { system: with_rates::<L>(system, block.rates.as_ref())?, ends: None })
        };
        variations.blocks.iter().map(varied).collect()
    }

    fn follow(
        &self,
        _: &L,
        run: &mut Run<L, Self>,
        variations: &mut Variations<L>,
        companion: &mut Self::VariationMemory,
    ) -> Result<(), Ending> {
        let (before, after) = (&run.before, &run.state);
        for (k, varied) in companion.iter_mut().enumerate() {
            let block = &variations.blocks[k];
            let start = with_slopes(before, &block.y);
            let mut point = CompensatedState::at(&start);
            let mut carried = <S as Scheme<PackedDuals<L>>>::start(&varied.system, &start);
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
                    let entry = variations.argument(k, lane);
                    return Err(Ending::of(Error::DerivativeNotFinite { row, entry, time }, time));
                }
                (Err(_), None) => {
                    return Err(Ending::MethodFailed {
                        time,
                        reason: "the derivatives of a step do not converge",
                    });
                }
                (Ok(_), None) => varied.ends = Some([start, point.state]),
            }
            variations.blocks[k].y = y;
        }
        Ok(())
    }

    fn interpolate(
        &self,
        system: &L,
        run: &mut Run<L, Self>,
        _: &mut Variations<L>,
        companion: &mut Self::VariationMemory,
        within: &mut Vec<Self::Interpolant>,
        coefficients: &mut Vec<PhaseVector<WideOf<L>, L::N>>,
    ) -> Result<(), Ending> {
        run.look_within(system, self, within)?;
        for VariedSteps { system, ends } in companion {
            let Some([start, end]) = ends else { continue };
            let accelerations = |state: &_| array(system.accelerations_unchecked(state).accelerations);
            let ends = [accelerations(start), accelerations(end)];
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

    fn between(
        coefficients: &[PhaseVector<WideOf<L>, L::N>],
        part: WideOf<L>,
    ) -> PhaseVector<WideOf<L>, L::N> {
        evaluate(coefficients, part).0
    }
}

/// A state whose coordinates and velocities change along the variations.
fn with_slopes<T: Real<Wide = W>, W: Wide<T>, N: Length>(
    state: &State<T, N>,
    y: &PhaseVector<W, N>,
) -> State<Dual<W>, N> {
    let dual = |value: T, slope| Dual { value: W::of(value), slope };
    State {
        t: dual(state.t, W::constant(0.0)),
        q: vector(from_fn(|i| dual(state.q[i], y[0][i]))),
        v: vector(from_fn(|i| dual(state.v[i], y[1][i]))),
    }
}
