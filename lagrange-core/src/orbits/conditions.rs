//! Conditions that single out a periodic orbit.

use alloc::vec::Vec;

use crate::StateOf;
use crate::generic::Vector;
use crate::linearized::Linearized;
use crate::motion::Simulate;
use crate::number::limits::ACCUMULATED;
use crate::number::{Real, Scalar, larger, power_of_epsilon};

/// What is known of the period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Period<T> {
    /// Nothing is: an error.
    Unknown,
    /// About this, to be found.
    Near(T),
    /// Exactly this.
    Fixed(T),
    /// So many turns of a clock whose rate is this parameter.
    Driven { rate: usize, turns: usize },
}

/// Conditions on an orbit, beside that it closes.
#[derive(Clone, Debug)]
pub(super) struct Conditions<T> {
    pub(super) period: Period<T>,
    pub(super) energy: Option<T>,
    /// Entries of (q, q̇) that are zero where the orbit meets its mirror image, at the start and after half a period.
    pub(super) mirror: Vec<usize>,
    /// Coordinates that grow by so much in a period.
    pub(super) advance: Vec<(usize, T)>,
    /// Number of segments.
    pub(super) segments: usize,
}

impl<T: Real> Conditions<T> {
    /// True if only half of the orbit is computed.
    pub(super) fn is_half(&self) -> bool {
        !self.mirror.is_empty()
    }

    /// True if the period is to be found.
    pub(super) fn period_is_free(&self) -> bool {
        matches!(self.period, Period::Near(_))
    }

    /// Part of the period that is computed.
    pub(super) fn part(&self) -> T {
        T::constant(if self.is_half() { 0.5 } else { 1.0 })
    }

    /// The period at these parameters, if it is not to be found.
    pub(super) fn given<L: Linearized<Scalar = T>>(&self, system: &L) -> Option<T> {
        match self.period {
            Period::Fixed(period) | Period::Near(period) => Some(period),
            Period::Driven { rate, turns } => {
                Some(T::constant(turns as f64 * core::f64::consts::TAU) / system.parameters()[rate])
            }
            Period::Unknown => None,
        }
    }

    /// Derivative of the period by a parameter.
    pub(super) fn period_by(&self, parameter: Option<usize>, rate: T, period: T) -> T {
        match self.period {
            Period::Driven { rate: clock, .. } if parameter == Some(clock) => -period / rate,
            _ => T::constant(0.0),
        }
    }

    /// The whole orbit, once its half is known: closing is the one condition.
    pub(super) fn whole(&self) -> Self {
        let segments = if self.is_half() { 2 * self.segments } else { self.segments };
        Self { mirror: Vec::new(), energy: None, segments, ..self.clone() }
    }

    /// Twice around.
    pub(super) fn doubled(&self) -> Self {
        let period = match self.period {
            Period::Fixed(period) => Period::Fixed(period + period),
            Period::Near(period) => Period::Near(period + period),
            Period::Driven { rate, turns } => Period::Driven { rate, turns: 2 * turns },
            Period::Unknown => Period::Unknown,
        };
        let advance = self.advance.iter().map(|(i, by)| (*i, *by + *by)).collect();
        let whole = self.whole();
        Self { period, advance, segments: 2 * whole.segments, energy: self.energy, ..whole }
    }
}

/// True if the equations at these states are the same a period later: to ε^⅓ of what the accelerations change in eighths
/// of the period, or to round-off.
pub(super) fn repeats<L: Linearized<Scalar: Real>>(
    system: &L,
    states: &[StateOf<L>],
    period: L::Scalar,
) -> bool {
    let zero = L::Scalar::constant(0.0);
    states.iter().all(|state| {
        let after = |part: f64| {
            let t = state.t + period * L::Scalar::constant(part);
            system.solve(&StateOf::<L> { t, ..*state }).ok().map(|solution| solution.accelerations)
        };
        let (Some(now), Some(later)) = (after(0.0), after(1.0)) else { return true };
        let apart = |then: &Vector<L::Scalar, L::N>| {
            then.iter().zip(now.iter()).fold(zero, |most, (x, y)| larger(most, Scalar::abs(*x - *y)))
        };
        let eighths = (1..8).filter_map(|k| after(f64::from(k) / 8.0));
        let most = eighths.fold(zero, |most, then| larger(most, apart(&then)));
        let round_off = L::Scalar::constant(ACCUMULATED * L::Scalar::EPSILON) * (now.amax() + most);
        apart(&later) <= power_of_epsilon::<L::Scalar>(1.0 / 3.0) * most + round_off
    })
}
