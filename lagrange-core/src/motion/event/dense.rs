//! An accepted step with its dense output, in which events are searched.

use core::marker::PhantomData;

use super::memory::Interval;
use crate::error::Error;
use crate::motion::limits::{COARSEST, FINEST, WIDE};
use crate::number::limits::SUM;
use crate::number::{Real, Scalar, larger};
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::VectorField;
use crate::system::{StateOf, System};

/// An accepted step with its dense output.
pub(crate) struct DenseStep<'a, L: System, F, I> {
    pub(crate) system: &'a L,
    pub(crate) before: &'a StateOf<L>,
    pub(crate) after: &'a StateOf<L>,
    pub(crate) interpolant: &'a I,
    pub(crate) field: PhantomData<F>,
}

impl<L, F, I> DenseStep<'_, L, F, I>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    I: Interpolant<L::Scalar, L::Length>,
{
    /// State at a time within the step, projected onto the constraints.
    #[inline]
    pub(crate) fn at(&self, t: L::Scalar) -> Result<StateOf<L>, Error> {
        match t == self.after.t {
            true => Ok(self.after.clone()),
            false if I::IS_PROJECTED => F::project(self.system, &self.interpolant.at(t)),
            false => Ok(F::state(self.system, &self.interpolant.at(t))),
        }
    }

    pub(super) fn length(&self) -> L::Scalar {
        self.after.t - self.before.t
    }

    /// The interval between two times, or `None` if it is too short to be divided.
    pub(super) fn interval(&self, from: L::Scalar, to: L::Scalar) -> Option<Interval<L::Scalar>> {
        let constant = L::Scalar::constant;
        let (width, length) = (Scalar::abs(to - from), Scalar::abs(self.length()));
        let round_off = constant(L::Scalar::EPSILON) * larger(Scalar::abs(from), Scalar::abs(to));
        let is_wide = width * constant(WIDE) >= length;
        let finest = if width * constant(WIDE * WIDE) >= length { FINEST } else { 2 * COARSEST };
        let jitter = constant(2.0) * round_off / width;
        (width > constant(2.0 * SUM) * round_off).then_some(Interval { width, jitter, finest, is_wide })
    }

    /// End of part `piece` of `of` equal parts of the step from the time `from` on.
    pub(super) fn mark(&self, from: L::Scalar, piece: usize, of: usize) -> L::Scalar {
        let part = L::Scalar::constant(piece as f64 / of as f64);
        if piece == of { self.after.t } else { from + (self.after.t - from) * part }
    }

    /// True if `later` comes after `t` in the direction of the motion.
    pub(super) fn is_ahead(&self, t: L::Scalar, later: L::Scalar) -> bool {
        let zero = L::Scalar::constant(0.0);
        if self.length() < zero { later < t } else { later > t }
    }
}
