//! Errors of searches for periodic orbits.

use alloc::{string::String, vec::Vec};
use core::fmt::{self, Display, Formatter};

use super::bifurcation::BifurcationKind;
use crate::error::{Entry, Error};

/// Reason why no periodic orbit was found, or why a family does not start.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub enum OrbitError {
    /// No period was given, nor a guess of it.
    NoPeriod,
    /// The equations depend on the time, so that the period cannot be found.
    Clock {
        /// Period guessed.
        period: f64,
    },
    /// The equations do not depend on the time, so that nothing drives them.
    NoClock,
    /// The equations a period later are not those at the start.
    NotItsClock {
        /// Period given.
        period: f64,
    },
    /// The energy was fixed, of an orbit whose energy is not conserved.
    EnergyChanges {
        /// True if the equations depend on the time.
        is_driven: bool,
    },
    /// What was found is not near an orbit.
    Vague {
        /// Estimated distance from a true orbit, in units of its size.
        error: f64,
        /// Period of what was found.
        period: f64,
    },
    /// The orbit does not close.
    NotClosed {
        /// Entry of the state with the largest gap in the units of the orbit.
        entry: Entry,
        /// That gap.
        gap: f64,
        /// Steps done.
        iterations: usize,
        /// Best start found, as text: `x = 1.5`.
        start: Vec<String>,
        /// Period there.
        period: f64,
    },
    /// The period shrinks, or grows, to a tenth or ten times of the guess.
    PeriodLost {
        /// Period guessed.
        guess: f64,
        /// Last period tried.
        period: f64,
    },
    /// The orbit shrinks to an equilibrium, which closes after any time.
    Equilibrium {
        /// Period of the search.
        period: f64,
        /// Largest velocity left.
        velocity: f64,
    },
    /// The guess is an equilibrium.
    StartsAtRest,
    /// No orbit found, and the energy is less than the potential energy along the motion from the guess.
    TooLittleEnergy {
        /// Energy demanded.
        energy: f64,
        /// Least energy at rest on the way.
        least: f64,
    },
    /// The entries of a mirror are those of none: one of a coordinate and its velocity changes its sign.
    NoMirror {
        /// The coordinate.
        coordinate: Entry,
        /// Its velocity.
        velocity: Entry,
        /// True if both are named, false if neither is.
        are_named: bool,
    },
    /// No orbit found from a guess at which entries are not zero that change their sign in the mirror.
    StartOffMirror {
        /// Such an entry.
        entry: Entry,
        /// Its value at the guess.
        value: f64,
    },
    /// The motion after half a period is not the mirror image of the half before.
    NotMirrored {
        /// Entry of the state that differs most.
        entry: Entry,
        /// Its difference.
        gap: f64,
        /// Period of the half that was found, doubled.
        period: f64,
    },
    /// A test of a bifurcation changes its sign between two orbits and has no zero there.
    NoZero,
    /// No family leaves at a bifurcation of this kind.
    NoBranch {
        /// The kind.
        kind: BifurcationKind,
    },
    /// The orbits near this one form no curve, but are isolated or fill a surface.
    NoFamily {
        /// Unknowns less independent conditions, which should be 1.
        freedom: usize,
    },
}

impl Display for OrbitError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPeriod => write!(
                f,
                "the period of the orbit is not known: guess it by `period_near`, or fix it by `period` or `driven_by`"
            ),
            Self::Clock { period } => write!(
                f,
                "the equations depend on the time, so that no other period than that of their clock closes an orbit: in place of the guess {period} give it by `period` or `driven_by`"
            ),
            Self::NoClock => write!(
                f,
                "the equations do not depend on the time, so that nothing drives them: guess the period by `period_near` in place of `driven_by`"
            ),
            Self::NotItsClock { period } => write!(
                f,
                "the equations at t + {period} are not those at t, so that this is not the period of an orbit: give a multiple of the period of what drives them, by `period`, or by `driven_by` and its frequency"
            ),
            Self::EnergyChanges { is_driven: true } => write!(
                f,
                "the equations depend on the time, so that the energy changes along the orbit and cannot be fixed: leave out `energy`, and reach orbits of another size by a `family` over a parameter"
            ),
            Self::EnergyChanges { is_driven: false } => write!(
                f,
                "no periodic orbit of this energy found: forces or friction may change the energy along the orbit, so leave out `energy`"
            ),
            Self::Vague { error, period } => write!(
                f,
                "what was found with the period {period} may be {error:.1e} of its size away from an orbit: divide the orbit into more `segments`, or take a method of a smaller tolerance"
            ),
            Self::NotClosed { entry, gap, iterations, start, period } => write!(
                f,
                "no periodic orbit found: after {iterations} steps `{entry}` misses by {gap:e} with the period {period}, from {}; start closer, divide the orbit into more `segments`, or take a method of a smaller tolerance",
                start.join(", ")
            ),
            Self::PeriodLost { guess, period } => write!(
                f,
                "the period goes from the guess {guess} to {period}, where the orbit is an equilibrium or another one: start closer, or fix the period or the energy"
            ),
            Self::Equilibrium { period, velocity } => write!(
                f,
                "no orbit of the period {period} near the guess but an equilibrium, with velocities of {velocity:e}: give another period, or fix the energy"
            ),
            Self::StartsAtRest => write!(
                f,
                "the start is an equilibrium, which closes after any time: move it aside, along a normal mode of frequency ω with the period 2π/ω; `linearize` there has the `natural_frequencies`"
            ),
            Self::TooLittleEnergy { energy, least } => write!(
                f,
                "no periodic orbit found: the energy {energy} is below the potential energy on the whole way from the guess, {least} or more: give a larger energy, or start where the potential is lower"
            ),
            Self::NoMirror { coordinate, velocity, are_named } => write!(
                f,
                "a mirror image in time changes the sign of one of `{coordinate}` and `{velocity}`: name one of them in `mirrored`, not {}",
                if *are_named { "both" } else { "neither" }
            ),
            Self::StartOffMirror { entry, value } => write!(
                f,
                "no periodic orbit found: the guess has `{entry}` = {value}, which is zero where an orbit meets its mirror image: guess the state there, or leave out `mirrored`"
            ),
            Self::NotMirrored { entry, gap, period } => write!(
                f,
                "the second half of the orbit of period {period} is not the mirror image of the first: `{entry}` differs by {gap:e}; the equations do not have this symmetry, so name other entries in `mirrored`, or none"
            ),
            Self::NoBranch { kind } => write!(
                f,
                "no family of periodic orbits leaves at a {kind}: follow the one of a branch point or of a period doubling"
            ),
            Self::NoZero => f.write_str(
                "the test of the bifurcation jumps between two orbits and has no zero: limit the step by `longest_step`, it may leap to another family",
            ),
            Self::NoFamily { freedom: 0 } => {
                write!(f, "the orbit is isolated: continue it in a parameter, or free its period or energy")
            }
            Self::NoFamily { freedom } => write!(
                f,
                "the orbits near this one fill a space of {freedom} dimensions: fix the energy or the period, name a symmetry by `mirrored`, or take coordinates without what is conserved"
            ),
        }
    }
}

impl From<OrbitError> for Error {
    fn from(error: OrbitError) -> Self {
        Self::Orbit(alloc::boxed::Box::new(error))
    }
}
