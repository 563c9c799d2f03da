//! The settings of a method with step-size control.

use core::fmt;
use core::marker::PhantomData;

use super::contract::{Limits, check_settings};
use super::pair::Pair;
use crate::error::Error;

/// An embedded Runge–Kutta pair `P` with its settings.
///
/// Each accepted step is projected onto Φ = 0 and F q̇ + b = 0, and nothing else. The error of a step, in the norm
/// of Hairer, Nørsett and Wanner (*Solving Ordinary Differential Equations I*, II.4), is kept below
/// `absolute + relative · |x|` of every coordinate and velocity x.
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

/// Relative and absolute tolerance 10⁻⁹, at most 100 000 steps, no limit on wall time.
impl<P> Default for Adaptive<P> {
    fn default() -> Self {
        Self::with_tolerance(1e-9)
    }
}

impl<P> Adaptive<P> {
    /// This relative and absolute tolerance.
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

    /// The error allowed as a fraction of each entry. Below 16 round-off units of the scalar it counts as those.
    ///
    /// It covers what an entry cannot hold: a coordinate of 10³⁰⁰ with a velocity of 1 stays where it is to the last bit, and
    /// the motion is complete. Count coordinates from nearby where small changes matter.
    pub fn relative_tolerance(self, tolerance: f64) -> Self {
        Self { relative: tolerance, ..self }
    }

    /// The error allowed in the unit of each entry, which matters where the entry is about zero.
    pub fn absolute_tolerance(self, tolerance: f64) -> Self {
        Self { absolute: tolerance, ..self }
    }

    /// How many steps may be tried. In a trajectory each accepted one stores 5 (`Dopri5`) or 8 (`Dop853`) times 2N
    /// numbers, so this bounds its memory; an ensemble or a `Motion` stores none.
    pub fn max_steps(mut self, steps: usize) -> Self {
        self.limits.max_steps = steps;
        self
    }

    /// The longest step allowed.
    pub fn max_step(self, step: f64) -> Self {
        Self { max_step: Some(step), ..self }
    }

    /// The first step tried, instead of an estimate.
    pub fn first_step(self, step: f64) -> Self {
        Self { first_step: Some(step), ..self }
    }

    /// All steps of this size, to the round-off of the time (the last may be shorter), whatever the error: to measure
    /// orders of convergence, and for control loops.
    ///
    /// The rates at the end of a step are evaluated by what needs them, the next step or what lies within this one; where the
    /// equations have no solution there, that is the error.
    pub fn fixed_step(self, step: f64) -> Self {
        Self { fixed_step: Some(step), ..self }
    }

    /// How long the integration may take by the clock on the wall.
    #[cfg(feature = "std")]
    pub fn wall_time(mut self, limit: std::time::Duration) -> Self {
        self.limits.wall_time = Some(limit);
        self
    }

    /// By the numbers of the pair, not by its name.
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
