//! Settings of the embedded Runge–Kutta methods.

use core::fmt;
use core::marker::PhantomData;

use super::contract::{Limits, check_settings, limit_setters};
use super::pair::Pair;
use crate::error::Error;

/// An embedded Runge–Kutta method by the pair `P`, with its settings.
///
/// Each accepted step is projected onto Φ = 0 and F q̇ + b = 0, and not altered otherwise. The error of a step is kept
/// below `absolute + relative · |x|` of every coordinate and velocity x, in the norm of Hairer, Nørsett and Wanner
/// (*Solving Ordinary Differential Equations I*, II.4).
///
/// ```
/// use lagrange_core::Dop853;
/// let method = Dop853::with_tolerance(1e-12).max_step(0.1).max_steps(1_000_000);
/// assert_ne!(method, Dop853::default());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Adaptive<P> {
    pub(super) relative: f64,
    pub(super) absolute: f64,
    pub(super) max_step: Option<f64>,
    pub(super) first_step: Option<f64>,
    pub(super) fixed_step: Option<f64>,
    limits: Limits,
    pair: PhantomData<P>,
}

/// Relative and absolute tolerance 10⁻⁹, at most 100 000 steps, no limit on wall-clock time.
impl<P> Default for Adaptive<P> {
    fn default() -> Self {
        Self::with_tolerance(1e-9)
    }
}

impl<P> Adaptive<P> {
    /// Sets relative and absolute tolerance to the same number.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self {
            relative: tolerance,
            absolute: tolerance,
            max_step: None,
            first_step: None,
            fixed_step: None,
            limits: Limits::default(),
            pair: PhantomData,
        }
    }

    /// Sets the relative tolerance: the error allowed as a fraction of each entry of the state. A tolerance below 16 ε
    /// of the scalar counts as 16 ε.
    ///
    /// It also covers changes that an entry cannot represent: a coordinate of 10³⁰⁰ with a velocity of 1 stays constant
    /// to the last bit, and the motion completes. If small changes matter, choose an origin of the coordinate nearby.
    pub fn relative_tolerance(self, tolerance: f64) -> Self {
        Self { relative: tolerance, ..self }
    }

    /// Sets the absolute tolerance: the error allowed in the unit of each entry. It matters for entries near zero.
    pub fn absolute_tolerance(self, tolerance: f64) -> Self {
        Self { absolute: tolerance, ..self }
    }

    limit_setters! {
        /// Sets the limit on steps, rejected ones included. It also bounds the memory of a trajectory, which stores 5
        /// (`Dopri5`) or 8 (`Dop853`) times 2N numbers for each accepted step. An ensemble or a `Motion` stores no steps.
    }

    /// Sets the longest step allowed, in units of time.
    pub fn max_step(self, step: f64) -> Self {
        Self { max_step: Some(step), ..self }
    }

    /// Sets the first step to try, instead of an estimate.
    pub fn first_step(self, step: f64) -> Self {
        Self { first_step: Some(step), ..self }
    }

    /// Makes all steps this long, to the round-off of the time, whatever the error; the last may be shorter. For
    /// measurements of orders of convergence, and for control loops.
    ///
    /// Accelerations at the end of a step are evaluated only when the next step or the dense output needs them. If the
    /// equations have no solution there, that later call returns the error.
    pub fn fixed_step(self, step: f64) -> Self {
        Self { fixed_step: Some(step), ..self }
    }

    /// Writes the coefficients and settings of the method. The coefficients identify the pair; its name does not.
    pub(super) fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result
    where
        P: Pair,
    {
        let Self { relative, absolute, max_step, first_step, fixed_step, .. } = self;
        write!(to, "{:?} {:?} {:?} {:?} {:?} ", P::NODES, P::STAGES, P::WEIGHTS, P::ERROR, P::LOWER_ERROR)?;
        write!(to, "{:?} {:?} {:?} {:?} ", P::ORDER, P::DAMPING, P::SHRINK, P::GROWTH)?;
        write!(to, "{relative:?} {absolute:?} {max_step:?} {first_step:?} {fixed_step:?}")
    }

    pub(crate) fn limits(&self) -> Limits {
        self.limits
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        check_settings([
            ("relative tolerance", Some(self.relative)),
            ("absolute tolerance", Some(self.absolute)),
            ("longest step", self.max_step),
            ("first step", self.first_step),
            ("fixed step", self.fixed_step),
        ])
    }
}
