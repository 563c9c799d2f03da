//! Taylor's method: expansion of the motion in a power series about each state, with errors down to round-off.

pub(crate) mod control;
mod crossing;
mod defect;
pub(crate) mod expansion;
#[cfg(feature = "std")]
mod lanes;
pub(crate) mod last;
pub(crate) mod limits;
mod memory;
mod polynomial;
mod roots;
mod sampling;
mod settings;
mod step;
mod sums;

use alloc::vec::Vec;
use core::fmt;

use super::method::clock::Clock;
use super::method::contract::check_settings;
use super::method::{Limits, Method, Step};
use crate::error::{Ending, Error, Pace};
use crate::names::{Entry, name};
use crate::number::{Real, Scalar};
use crate::solution::vector_field::LagrangianVectorField;
use crate::statistics::Statistics;
use crate::system::{State, StateOf, TaylorSeries};
use crate::vector::{Array, vector};
use expansion::{Expansion, SolvedState};
use memory::Before;
pub(crate) use memory::TaylorMemory;
pub use polynomial::TaylorPolynomial;
use sampling::Sampling;
pub use settings::Taylor;
use step::Attempt;

impl<L: TaylorSeries<Scalar: Real>> Method<L, LagrangianVectorField> for Taylor {
    type Memory = TaylorMemory<L::Sums, L::Scalar, L::N, L::M>;
    type Interpolant = TaylorPolynomial<L::Scalar, L::N>;

    fn limits(&self) -> Limits {
        self.limits
    }

    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result {
        let Self { relative, absolute, max_step, .. } = self;
        write!(to, "Taylor {relative:?} {absolute:?} {max_step:?}")
    }

    fn accuracy(&self) -> f64 {
        self.relative
    }

    fn check(&self) -> Result<(), Error> {
        check_settings([
            ("relative tolerance", Some(self.relative)),
            ("absolute tolerance", Some(self.absolute)),
            ("longest step", self.max_step),
        ])
    }

    fn begin(
        &self,
        system: &L,
        start: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<Self::Memory, Error> {
        statistics.evaluations += 1;
        let (zero, solved) = (L::Scalar::constant(0.0), SolvedState::at(system, start)?);
        statistics.multipliers_are_unique &= solved.solution.multipliers_are_unique();
        Ok(TaylorMemory {
            clock: Clock::new(start.t, None),
            state: *start,
            solved,
            rest: [Array::filled(zero); 2],
            series: Expansion::new::<L>(self.order::<L::Scalar>()),
            is_expanded: false,
            planned: zero,
            sampling: Sampling { step: zero, distance: zero },
            before: None,
        })
    }

    fn resume(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        state: &StateOf<L>,
        statistics: &mut Statistics,
    ) -> Result<(), Error> {
        statistics.evaluations += 1;
        memory.clock.set(state.t);
        (memory.state, memory.solved) = (*state, SolvedState::at(system, state)?);
        statistics.multipliers_are_unique &= memory.solved.solution.multipliers_are_unique();
        (memory.is_expanded, memory.before) = (false, None);
        memory.rest = [Array::filled(L::Scalar::constant(0.0)); 2];
        Ok(())
    }

    fn step(
        &self,
        system: &L,
        memory: &mut Self::Memory,
        end: L::Scalar,
        _: &StateOf<L>,
        to: &mut StateOf<L>,
        statistics: &mut Statistics,
    ) -> Step {
        self.aim(memory, end);
        let now = memory.clock.now.to_f64();
        if let Err(error) = self.expand(system, memory, statistics) {
            return Step::Failed(Ending::of(error, now));
        }
        let (h, time) = memory.clock.next(memory.planned);
        if !memory.clock.is_ahead(time) {
            return Step::Failed(Ending::TimeTooCoarse { time: now, step: memory.planned.to_f64() });
        }
        statistics.evaluations += 1;
        let ending = match self.attempt(system, memory, (h, time), statistics) {
            Ok(Attempt::Reached(next)) => {
                statistics.multipliers_are_unique &= memory.solved.solution.multipliers_are_unique();
                *to = next;
                return Step::Accepted;
            }
            Ok(Attempt::Inaccurate(i)) => {
                Ending::StepTooSmall { time: now, entry: Entry::Velocity(name(L::COORDINATES, i)) }
            }
            Err(error) => Ending::of(error, now),
        };
        if self.can_be_shorter(memory, h) { Step::Rejected } else { Step::Failed(ending) }
    }

    fn interpolant(
        &self,
        _: &L,
        memory: &mut Self::Memory,
        _: [&StateOf<L>; 2],
        _: &mut Statistics,
    ) -> Result<Self::Interpolant, Error> {
        let Expansion { start, unit, q, summed, .. } = &memory.series;
        Ok(TaylorPolynomial::new(*start, *unit, q[..summed + 2].iter().copied()))
    }

    fn push_interpolant(
        &self,
        _: &L,
        memory: &mut Self::Memory,
        _: [&StateOf<L>; 2],
        _: &mut Statistics,
        to: &mut Vec<Self::Interpolant>,
    ) -> Result<(), Error> {
        let Expansion { start, unit, q, summed, .. } = &memory.series;
        to.push(TaylorPolynomial::empty(*start, *unit));
        if let Some(last) = to.last_mut() {
            last.set(q[..summed + 2].iter().copied());
        }
        Ok(())
    }

    fn undo(&self, memory: &mut Self::Memory) -> bool {
        let Some(Before { solved, rest, sampling }) = memory.before.take() else { return false };
        let (start, h) = (memory.series.start, memory.clock.now - memory.series.start);
        memory.clock.now = start;
        memory.state = State { t: start, q: vector(memory.series.q[0]), v: vector(memory.series.v[0]) };
        (memory.solved, memory.rest, memory.sampling, memory.is_expanded) = (solved, rest, sampling, true);
        self.can_be_shorter(memory, h)
    }

    fn pace(&self, _: &L, memory: &Self::Memory, _: L::Scalar) -> Pace {
        Pace { step: Some(memory.planned.to_f64()), ..Pace::default() }
    }
}
