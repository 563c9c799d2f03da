//! What can be known of the reason why a search failed, beside that its start was not close enough.

use super::error::OrbitError;
use super::search::OrbitSearch;
use crate::error::Error;
use crate::facts::EnergyForm;
use crate::generic::StaticLength;
use crate::linearized::{DifferentiableMethod, Linearized};
use crate::motion::Simulate;
use crate::number::{Real, Scalar, exceeds, power_of_epsilon, smaller};
use crate::system::entry;
use crate::vector::zeros;
use crate::{Sample, StateOf};

impl<L: Linearized<Scalar: Real> + Clone, D: DifferentiableMethod<L> + Clone> OrbitSearch<L, D> {
    /// The error, or a reason for it that lies in the guess or the conditions.
    pub(super) fn explained(&self, error: Error) -> Error {
        let Error::Orbit(found) = &error else { return error };
        let is_closed = matches!(**found, OrbitError::Equilibrium { .. } | OrbitError::NotMirrored { .. });
        let is_lost = matches!(**found, OrbitError::NotClosed { .. } | OrbitError::PeriodLost { .. });
        let mut reason = None;
        if is_closed || is_lost {
            reason = self.wrong_mirror();
        }
        if is_lost {
            reason = reason.or_else(|| self.too_little_energy()).or_else(|| self.start_off_mirror());
        }
        reason.map_or(error, Error::from)
    }

    /// A mirror that turns the time around changes the sign of a coordinate or else that of its velocity.
    fn wrong_mirror(&self) -> Option<OrbitError> {
        let mirror = &self.conditions.as_ref().ok()?.mirror;
        let n = <L::N>::COUNT;
        let is_named = |i: usize| mirror.contains(&i);
        let wrong = (0..n).find(|i| !mirror.is_empty() && is_named(*i) == is_named(n + *i))?;
        let [coordinate, velocity] = [wrong, n + wrong].map(entry::<L>);
        Some(OrbitError::NoMirror { coordinate, velocity, are_named: is_named(wrong) })
    }

    /// The kinetic energy is not negative: the energy E = L₂ − L₀ is that at rest or more.
    fn too_little_energy(&self) -> Option<OrbitError> {
        let conditions = self.conditions.as_ref().ok()?;
        let energy = conditions.energy?;
        if matches!(L::FACTS.energy_form, EnergyForm::General) {
            return None;
        }
        let start = self.system.make_consistent(&self.guess).ok()?.0;
        let duration = conditions.part() * conditions.given(&self.system)?;
        let motion = self.system.motion(start).by(self.method.clone()).to(start.t + duration).ok()?;
        let at_rest =
            |sample: Sample<&L>| self.system.energy(&StateOf::<L> { v: zeros(), ..*sample.state() });
        let least = motion.steps().map(at_rest).reduce(smaller)?;
        let (energy, least) = (energy.to_f64(), (energy < least).then(|| least.to_f64())?);
        Some(OrbitError::TooLittleEnergy { energy, least })
    }

    /// The guess does not lie where an orbit meets its mirror image.
    fn start_off_mirror(&self) -> Option<OrbitError> {
        let mirror = &self.conditions.as_ref().ok()?.mirror;
        let n = <L::N>::COUNT;
        let value = |i: usize| if i < n { self.guess.q[i] } else { self.guess.v[i - n] };
        let size = |i: usize| if i < n { self.guess.q.amax() } else { self.guess.v.amax() };
        let is_off =
            |i: &&usize| exceeds(Scalar::abs(value(**i)), power_of_epsilon::<L::Scalar>(0.25) * size(**i));
        let off = *mirror.iter().find(is_off)?;
        Some(OrbitError::StartOffMirror { entry: entry::<L>(off), value: value(off).to_f64() })
    }
}
