//! Why an integration stopped.

#[cfg(feature = "alloc")]
use alloc::string::String;
use core::fmt::{self, Debug, Display, Formatter};

use super::Error;
use crate::names::{Entry, Row};

/// Why a motion ends where it does.
///
/// With the feature `serde` it is written, `{"ending": "StepTooSmall", "time": 1.5, "entry": "x_dot"}`, and not read:
/// its names are those of a system that is compiled in.
#[non_exhaustive]
#[derive(Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(tag = "ending"))]
pub enum Ending {
    /// The end asked for was reached.
    Complete {
        /// The end.
        time: f64,
    },
    /// The tolerance demands steps too short to advance the time: a singularity of the motion, a tolerance
    /// below the round-off, or a time that is counted from far away.
    StepTooSmall {
        /// Last time reached.
        time: f64,
        /// The coordinate or velocity with the largest error.
        entry: Entry,
    },
    /// The settings demand steps too short to advance the time: where it is counted from far away, the numbers near it
    /// lie farther apart.
    TimeTooCoarse {
        /// The last time reached.
        time: f64,
        /// The longest step allowed.
        step: f64,
    },
    /// Nothing determines some accelerations any more, or in (q, p) some velocities.
    Singular {
        /// The last time reached.
        time: f64,
        /// The coordinates at fault: [`Error::Singular`], or in (q, p) [`Error::VelocityUndetermined`].
        error: Error,
    },
    /// Constraints that depend on one another demand different accelerations, or in (q, p) different velocities.
    Contradictory {
        /// The last time reached.
        time: f64,
        /// The constraint at fault: [`Error::Contradictory`].
        error: Error,
    },
    /// What the equations need was not found.
    Unsolved {
        /// The last time reached.
        time: f64,
        /// In (q, p) the velocity that belongs to momenta: [`Error::MomentumNotReached`].
        error: Error,
    },
    /// The equations became infinite or not a number.
    NotFinite {
        /// The last time reached.
        time: f64,
        /// The row at fault.
        row: Row,
    },
    /// No state on the constraints was found.
    OffConstraints {
        /// The last time reached.
        time: f64,
        /// The constraint at fault: [`Error::NotProjected`].
        error: Error,
    },
    /// The method has a reason of its own.
    MethodFailed {
        /// The last time reached.
        time: f64,
        /// What it says.
        reason: &'static str,
    },
    /// The limit on steps.
    StepLimit {
        /// The last time reached.
        time: f64,
        /// Steps tried.
        steps: usize,
        /// How it would go on.
        pace: Pace,
    },
    /// The limit on time by the clock on the wall.
    WallTimeLimit {
        /// The last time reached.
        time: f64,
    },
    /// An event at which the run was to end.
    Event {
        /// When.
        time: f64,
        /// The name of the event.
        event: &'static str,
    },
    /// The crossings of an event follow each other ever faster, without end: a ball that comes to rest, or one thing that
    /// undoes another.
    EventsAccumulate {
        /// The last of them.
        time: f64,
        /// The name of the event.
        event: &'static str,
    },
    /// The function of an event is not a number.
    EventNotFinite {
        /// The last time reached.
        time: f64,
        /// The name of the event.
        event: &'static str,
    },
    /// The controller of a motion failed.
    #[cfg(feature = "alloc")]
    ControllerFailed {
        /// When it was called.
        time: f64,
        /// What it said.
        said: String,
    },
    /// What kept a member of an ensemble from its end in another process, which told it in words.
    #[cfg(feature = "std")]
    Elsewhere {
        /// The last time reached.
        time: f64,
        /// Its words.
        said: String,
    },
    /// The callback said so.
    Cancelled {
        /// The last time reached.
        time: f64,
    },
}

/// How long the steps are where the limit on them is reached, and what keeps them short, as far as the method can tell.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Pace {
    /// The length of the next step, where the method chooses it.
    pub step: Option<f64>,
    /// Rate of the fastest decay or growth, if the problem looks stiff: stability, not accuracy, limits the step length.
    pub stiffness: Option<f64>,
    /// Where the time is too coarse for the tolerance, how far its numbers lie apart: from one to the next the rates change by
    /// what costs a step half of its tolerance or more, because the time is counted from far away.
    pub time_apart: Option<f64>,
}

/// Why the limit on steps was reached, as the end of a sentence.
impl Display for Pace {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(apart) = self.time_apart {
            return write!(
                f,
                ": the numbers that times are made of lie {apart:.1e} apart there, and forces change more from one to the next than the tolerance allows; count the time from nearby, or allow a larger error"
            );
        }
        if let Some(rate) = self.stiffness {
            return write!(
                f,
                ": the problem looks stiff, something in it grows or dies at a rate of {rate:.1e}, which keeps steps short whatever the tolerance; put a constraint in the place of a stiff spring, leave out a mass that friction governs, or raise the limit with `max_steps`"
            );
        }
        match self.step {
            None => f.write_str("; raise it with `max_steps`"),
            Some(step) => write!(
                f,
                ", where the next is {step:.1e} long; raise it with `max_steps`, unless steps only shrink: then the motion falls into a singularity, or forces jump, as friction by `abs` does where it sticks (smooth it, as by `tanh`)"
            ),
        }
    }
}

impl Ending {
    /// The last time reached.
    pub fn time(&self) -> f64 {
        match *self {
            Self::Complete { time }
            | Self::StepTooSmall { time, .. }
            | Self::TimeTooCoarse { time, .. }
            | Self::Singular { time, .. }
            | Self::Contradictory { time, .. }
            | Self::Unsolved { time, .. }
            | Self::NotFinite { time, .. }
            | Self::OffConstraints { time, .. }
            | Self::MethodFailed { time, .. }
            | Self::StepLimit { time, .. }
            | Self::WallTimeLimit { time }
            | Self::Event { time, .. }
            | Self::EventsAccumulate { time, .. }
            | Self::EventNotFinite { time, .. }
            | Self::Cancelled { time } => time,
            #[cfg(feature = "alloc")]
            Self::ControllerFailed { time, .. } => time,
            #[cfg(feature = "std")]
            Self::Elsewhere { time, .. } => time,
        }
    }

    /// Whether the end asked for was reached.
    pub fn is_complete(&self) -> bool {
        matches!(self, Self::Complete { .. })
    }

    /// Whether something other than the caller kept the motion from the end.
    pub fn is_failure(&self) -> bool {
        !matches!(self, Self::Complete { .. } | Self::Event { .. } | Self::Cancelled { .. })
    }

    /// The ending of an integration that an error stopped after `time`.
    pub(crate) fn of(error: Error, time: f64) -> Self {
        match error {
            Error::EquationsNotFinite { row, .. } => Self::NotFinite { time, row },
            Error::NotProjected { .. } => Self::OffConstraints { time, error },
            Error::Singular { .. } | Error::VelocityUndetermined { .. } => Self::Singular { time, error },
            Error::Contradictory { .. } => Self::Contradictory { time, error },
            Error::EventNotFinite { event, .. } => Self::EventNotFinite { time, event },
            _ => Self::Unsolved { time, error },
        }
    }
}

impl Display for Ending {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete { time } => write!(f, "reached the end at t = {time}"),
            Self::StepTooSmall { time, entry } => write!(
                f,
                "stopped at t = {time}: the error of `{entry}` demands a step too small to advance the time; the motion is singular nearby, the tolerance is below the round-off, or the time is counted from far away"
            ),
            Self::TimeTooCoarse { time, step } => write!(
                f,
                "stopped at t = {time}: a step of {step:e} does not advance the time; allow longer ones, or count the time from nearby"
            ),
            Self::Singular { time, error } => write!(
                f,
                "stopped at t = {time}: {error}; if it has mass elsewhere, the motion has come to a pole of the coordinates, as polar ones have at r = 0: choose others"
            ),
            Self::Contradictory { time, error }
            | Self::Unsolved { time, error }
            | Self::OffConstraints { time, error } => write!(f, "stopped at t = {time}: {error}"),
            Self::NotFinite { time, row } => write!(
                f,
                "stopped at t = {time}: the equations are not finite in the row of {row}; check the parameters, and whether the motion runs into a pole"
            ),
            Self::MethodFailed { time, reason } => {
                write!(f, "stopped at t = {time} by the method: {reason}")
            }
            Self::StepLimit { time, steps, pace } => {
                write!(f, "stopped at t = {time} after {steps} steps, the limit{pace}")
            }
            Self::WallTimeLimit { time } => {
                write!(f, "stopped at t = {time} by the limit on wall time; raise it with `wall_time`")
            }
            Self::Event { time, event } => write!(f, "ended by the event `{event}` at t = {time}"),
            Self::EventsAccumulate { time, event } => write!(
                f,
                "stopped at t = {time}: the events `{event}` accumulate, each follows the one before sooner, without end; go on with the system in which what they lead to holds (a ball at rest), or end the run by a bound on what is left"
            ),
            Self::EventNotFinite { time, event } => write!(
                f,
                "stopped at t = {time}: the function of the event `{event}` is not a number soon after; make it one wherever the motion may lead"
            ),
            #[cfg(feature = "alloc")]
            Self::ControllerFailed { time, said } => {
                write!(f, "stopped at t = {time}: the controller failed: {said}")
            }
            #[cfg(feature = "std")]
            Self::Elsewhere { said, .. } => f.write_str(said),
            Self::Cancelled { time } => write!(f, "cancelled at t = {time}"),
        }
    }
}

/// The sentence of its `Display`: `main` prints an ending that it returns as an error by this.
impl Debug for Ending {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(self, f)
    }
}

impl core::error::Error for Ending {}
