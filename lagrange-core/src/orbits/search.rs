//! Search for a periodic orbit by single or multiple shooting.

use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};

use super::conditions::{Conditions, Period};
use super::error::OrbitError;
use super::frame::OrbitUnits;
use super::orbit::PeriodicOrbit;
use super::shot::{Chain, Problem};
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized};
use crate::motion::{Dop853, Simulate};
use crate::number::{Real, Scalar, larger};
use crate::system::{check_contacts, lookup};
use crate::trajectory::Trajectory;
use crate::{Lagrangian, StateOf};

/// Settings of a search for a periodic orbit near a state. The method is [`Dop853`] with a tolerance of 10⁻¹³ unless
/// [`by`](Self::by) sets another.
///
/// Entries of the state are compared in units of the orbit: its largest coordinate and its largest velocity.
#[derive(Clone)]
#[must_use = "`find` searches for the orbit"]
pub struct OrbitSearch<L: Linearized, D = Dop853> {
    pub(super) system: L,
    pub(super) guess: StateOf<L>,
    pub(super) method: D,
    pub(super) conditions: Result<Conditions<L::Scalar>, Error>,
    pub(super) tolerance: L::Scalar,
}

impl<L: Linearized<Scalar: Real> + Clone> OrbitSearch<L> {
    pub(super) fn new(system: &L, guess: &StateOf<L>) -> Self {
        const { check_contacts(L::HAS_CONTACTS) };
        let conditions = Conditions {
            period: Period::Unknown,
            energy: None,
            mirror: Vec::new(),
            advance: Vec::new(),
            segments: 1,
        };
        let tolerance = L::Scalar::constant(1e-9);
        let method = Dop853::with_tolerance(1e-13);
        Self { system: system.clone(), guess: *guess, method, conditions: Ok(conditions), tolerance }
    }
}

impl<L: Linearized<Scalar: Real> + Clone, D> OrbitSearch<L, D> {
    /// Sets the method, one of those of [`integrate_sensitivities`](Linearized::integrate_sensitivities).
    pub fn by<E>(self, method: E) -> OrbitSearch<L, E> {
        let Self { system, guess, conditions, tolerance, .. } = self;
        OrbitSearch { system, guess, method, conditions, tolerance }
    }

    /// Guess of the period, which is to be found. For equations that do not depend on the time.
    pub fn period_near(self, guess: L::Scalar) -> Self {
        self.with(|conditions| conditions.period = Period::Near(guess))
    }

    /// Fixes the period: that of a drive, a multiple of it, or that of the member wanted of a family.
    pub fn period(self, period: L::Scalar) -> Self {
        self.with(|conditions| conditions.period = Period::Fixed(period))
    }

    /// Makes the period so many turns of a drive whose angular frequency is the parameter of this name: `turns`·2π/Ω, also where the
    /// parameter changes along a family.
    pub fn driven_by(self, frequency: &str, turns: usize) -> Self {
        let found = lookup::index::<L>(L::PARAMETERS, "parameter", frequency);
        self.try_with(|conditions| {
            let turns = at_least_one("number of turns of the drive", turns)?;
            conditions.period = Period::Driven { rate: found?, turns };
            Ok(())
        })
    }

    /// Fixes the energy p·q̇ − L, of a conservative system; an error if the equations depend on the time.
    pub fn energy(self, energy: L::Scalar) -> Self {
        self.with(|conditions| conditions.energy = Some(energy))
    }

    /// Demands an orbit that is its own mirror image, and computes half of it.
    ///
    /// `entries` names the coordinates and velocities that change sign in the mirror, x(−t) = R x(t): they are zero at the start and
    /// after half a period. The second half is then checked. An orbit of the restricted problem of three bodies that crosses the
    /// axis at right angles is mirrored in `&["y", "x_dot", "z_dot"]`.
    pub fn mirrored(self, entries: &[&str]) -> Self {
        let found = lookup::indices::<L>(&lookup::entries::<L>(), "coordinate or velocity", entries);
        self.try_with(|conditions| {
            conditions.mirror = found?;
            Ok(())
        })
    }

    /// Lets a coordinate grow by `growth` in a period: an angle that turns by 2π.
    pub fn advancing(self, coordinate: &str, growth: L::Scalar) -> Self {
        let found = lookup::index::<L>(L::COORDINATES, "coordinate", coordinate);
        self.try_with(|conditions| {
            conditions.advance.push((found?, growth));
            Ok(())
        })
    }

    /// Divides the orbit, or the half of it that is computed, into so many segments of equal duration (multiple shooting): 1 unless
    /// set. An orbit whose deviations grow by more than 10⁶ in a period needs some. The starts between are those of the motion from
    /// the guess.
    pub fn segments(self, count: usize) -> Self {
        self.try_with(|conditions| {
            conditions.segments = at_least_one("number of segments of an orbit", count)?;
            Ok(())
        })
    }

    /// Largest residual of an orbit, 10⁻⁹ unless set. The search goes on until a step no longer halves the residual, and fails if it
    /// is larger than this then.
    pub fn tolerance(self, tolerance: L::Scalar) -> Self {
        Self { tolerance, ..self }
    }

    fn with(self, set: impl FnOnce(&mut Conditions<L::Scalar>)) -> Self {
        self.try_with(|conditions| {
            set(conditions);
            Ok(())
        })
    }

    /// Changes the conditions; the first error is kept until the search.
    fn try_with(mut self, set: impl FnOnce(&mut Conditions<L::Scalar>) -> Result<(), Error>) -> Self {
        self.conditions =
            self.conditions.and_then(|mut conditions| set(&mut conditions).map(|()| conditions));
        self
    }

    /// Finds a periodic orbit near the guess: Newton's method with least steps, so that the orbit found is near the guess also where
    /// orbits fill a family.
    ///
    /// # Errors
    /// [`Error::Orbit`]: no orbit found, with the best start and its gap, or with what is wrong with the guess; no period; a symmetry
    /// that the motion does not have.
    /// [`Error::UnknownName`] for entries, coordinates or parameters; [`Error::Setting`]; [`Error::Unfinished`] if a segment's
    /// motion fails, with the time; those of [`linearize`](Linearized::linearize).
    pub fn find(&self) -> Result<PeriodicOrbit<L>, Error>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        let problem = self.problem()?;
        let chain = self.chain()?;
        let found = problem.correct(chain, &self.method, None, self.tolerance);
        let orbit = found
            .and_then(|(shot, iterations)| problem.orbit(&shot, iterations, &self.method, self.tolerance));
        orbit.map_err(|error| self.explained(error))
    }

    /// The equations of the search.
    pub(super) fn problem(&self) -> Result<Problem<L::Scalar>, Error> {
        let conditions = self.conditions.clone()?;
        let period = self.checked_period(&conditions)?;
        let has_clock = L::DEPENDS_ON_TIME;
        if !has_clock && matches!(conditions.period, Period::Driven { .. }) {
            return Err(OrbitError::NoClock.into());
        }
        if has_clock && conditions.period_is_free() {
            return Err(OrbitError::Clock { period: period.to_f64() }.into());
        }
        if has_clock && conditions.energy.is_some() {
            return Err(OrbitError::EnergyChanges { is_driven: true }.into());
        }
        let is_conservative = !has_clock && L::FACTS.energy_is_conserved.is_some();
        let parameter_unit = L::Scalar::constant(1.0);
        Ok(Problem { conditions, parameter: None, parameter_unit, has_clock, is_conservative })
    }

    fn checked_period(&self, conditions: &Conditions<L::Scalar>) -> Result<L::Scalar, Error> {
        let period = conditions.given(&self.system).ok_or(OrbitError::NoPeriod)?;
        let is_right = |x: L::Scalar| x.to_f64() > 0.0 && x.to_f64().is_finite();
        for (name, value) in [("period of an orbit", period), ("tolerance of an orbit", self.tolerance)] {
            if !is_right(value) {
                return Err(Error::Setting { name, value: value.to_f64() });
            }
        }
        Ok(period)
    }

    /// The guess: nodes along its motion.
    fn chain(&self) -> Result<Chain<L>, Error>
    where
        D: DifferentiableMethod<L> + Clone,
    {
        let conditions = self.conditions.clone()?;
        let period = self.checked_period(&conditions)?;
        let mut nodes = Vec::with_capacity(conditions.segments);
        nodes.push(self.system.make_consistent(&self.guess)?.0);
        let duration = conditions.part() * period / L::Scalar::constant(conditions.segments as f64);
        let mut motions = Vec::with_capacity(conditions.segments);
        for k in 1..=conditions.segments {
            let end = self.guess.t + duration * L::Scalar::constant(k as f64);
            let motion = self.system.motion(nodes[k - 1]).by(self.method.clone()).to(end)?;
            nodes.push(*motion.end().state());
            motions.push(motion);
        }
        nodes.truncate(conditions.segments);
        let units = OrbitUnits::of(motions.iter());
        let fastest = motions.iter().flat_map(Trajectory::steps).map(|sample| sample.state().v.amax());
        let moved = fastest.fold(L::Scalar::constant(0.0), larger) * period;
        if !L::DEPENDS_ON_TIME && moved <= self.tolerance * units.q {
            return Err(OrbitError::StartsAtRest.into());
        }
        Ok(Chain { system: self.system.clone(), nodes, period, units })
    }
}

fn at_least_one(name: &'static str, count: usize) -> Result<usize, Error> {
    if count == 0 { Err(Error::Setting { name, value: 0.0 }) } else { Ok(count) }
}

impl<L: Lagrangian + Linearized, D> Debug for OrbitSearch<L, D> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut search = f.debug_struct("OrbitSearch");
        search.field("system", &L::NAME).field("guess", &self.guess).finish_non_exhaustive()
    }
}
