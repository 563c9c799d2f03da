//! Conditions that single out a periodic orbit.

use alloc::vec::Vec;

use crate::linearized::Linearized;
use crate::motion::Simulate;
use crate::number::{Real, Scalar};
use crate::system::{Direction, StateOf};
use crate::vector::Length;

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

/// True if the equations depend on the time: if at one of 16 times over a period their derivative by the time is not zero. The times
/// are in no simple ratio to the period, at which a derivative may vanish.
pub(super) fn has_clock<L: Linearized<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    period: L::Scalar,
) -> bool {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let zero = L::Scalar::constant(0.0);
    (1..=16).any(|k| {
        let mut state = *state;
        let turns = GOLDEN * f64::from(k);
        state.t += period * L::Scalar::constant(turns - f64::from(turns as u32));
        let Ok(solution) = system.solve(&state) else { return false };
        let change = system.residual_change(&state, &solution, &Direction::of_time());
        (0..<L::N>::COUNT).any(|i| change.motion[i] != zero)
            || (0..<L::M>::COUNT).any(|a| change.acceleration[a] != zero || change.position[a] != zero)
    })
}
