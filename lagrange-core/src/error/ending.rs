//! Reasons why an integration stops.

use core::fmt::{self, Debug, Display, Formatter};

use super::Error;
use super::owned::String;
use crate::names::{Entry, Row};

/// Reason why a motion ends.
///
/// With the feature `serde` an ending can be serialized, as
/// `{"ending": "StepTooSmall", "time": 1.5, "entry": "x_dot"}`. It cannot be deserialized: its names are
/// `&'static str` of a compiled system.
#[non_exhaustive]
#[derive(Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(tag = "ending"))]
pub enum Ending {
    /// The motion reached the requested end time.
    Complete {
        /// End time.
        time: f64,
    },
    /// The tolerance demands steps too short to advance the time. Causes: a singularity of the motion, a
    /// tolerance below the round-off, or a time far from its origin.
    StepTooSmall {
        /// Last time reached.
        time: f64,
        /// Coordinate or velocity with the largest error.
        entry: Entry,
    },
    /// The settings demand steps too short to advance the time: far from the origin of time, neighbouring
    /// floating-point numbers lie farther apart than a step.
    TimeTooCoarse {
        /// Last time reached.
        time: f64,
        /// Longest step length allowed.
        step: f64,
    },
    /// The equations no longer determine some accelerations, or in (q, p) some velocities.
    Singular {
        /// Last time reached.
        time: f64,
        /// [`Error::Singular`], or in (q, p) [`Error::VelocityUndetermined`], with the coordinates at fault.
        error: Error,
    },
    /// Dependent constraints demand different accelerations, or in (q, p) different velocities.
    Contradictory {
        /// Last time reached.
        time: f64,
        /// [`Error::Contradictory`], with the constraint at fault.
        error: Error,
    },
    /// The equations could not be solved for another reason.
    Unsolved {
        /// Last time reached.
        time: f64,
        /// In (q, p), [`Error::MomentumNotReached`]: no velocities have the momenta.
        error: Error,
    },
    /// The equations evaluate to infinity or NaN.
    NotFinite {
        /// Last time reached.
        time: f64,
        /// Row of the equations at fault.
        row: Row,
    },
    /// The projection found no state on the constraints.
    OffConstraints {
        /// Last time reached.
        time: f64,
        /// [`Error::NotProjected`], with the constraint at fault.
        error: Error,
    },
    /// The method failed for a reason of its own.
    MethodFailed {
        /// Last time reached.
        time: f64,
        /// Reason given by the method.
        reason: &'static str,
    },
    /// The limit on the number of steps is reached.
    StepLimit {
        /// Last time reached.
        time: f64,
        /// Steps tried.
        steps: usize,
        /// Length of the next step, and the cause of short steps.
        pace: Pace,
    },
    /// The limit on the transitions of contacts is reached.
    TransitionLimit {
        /// Last time reached.
        time: f64,
        /// Number of transitions.
        transitions: usize,
    },
    /// The limit on wall-clock time is reached.
    WallTimeLimit {
        /// Last time reached.
        time: f64,
    },
    /// An event ended the run.
    Event {
        /// Time of the event.
        time: f64,
        /// Name of the event.
        event: &'static str,
    },
    /// The crossings of an event accumulate at ever shorter intervals: a ball comes to rest, or two events undo
    /// each other.
    EventsAccumulate {
        /// Time of the last crossing.
        time: f64,
        /// Name of the event.
        event: &'static str,
    },
    /// The function of an event is NaN.
    EventNotFinite {
        /// Last time reached.
        time: f64,
        /// Name of the event.
        event: &'static str,
    },
    /// The controller of a motion returned an error.
    ControllerFailed {
        /// Time of the call.
        time: f64,
        /// Message of the controller.
        said: String,
    },
    /// A member of an ensemble failed in another process, which reported the ending as text.
    Elsewhere {
        /// Last time reached.
        time: f64,
        /// Text of the ending.
        said: String,
    },
    /// The callback cancelled the run.
    Cancelled {
        /// Last time reached.
        time: f64,
    },
}

/// Length of the next step when the limit on steps is reached, and the cause of short steps as far as the
/// method can tell.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Pace {
    /// Length of the next step, if the method controls the step length.
    pub step: Option<f64>,
    /// Rate of the fastest decay or growth, if the problem looks stiff: stability, not accuracy, limits the step length.
    pub stiffness: Option<f64>,
    /// Distance between neighbouring floating-point times, if it is too coarse for the tolerance: from one time
    /// to the next the accelerations change so much that a step loses half of its tolerance or more. The time
    /// is then too far from its origin.
    pub time_apart: Option<f64>,
}

/// Formats the cause of the step limit as the end of a sentence.
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
                ": the problem looks stiff, something in it grows or dies at a rate of {rate:.1e}, which keeps steps short whatever the tolerance; take `Radau`, put a constraint in the place of a stiff spring, leave out a mass that friction governs, or raise the limit with `max_steps`"
            );
        }
        // Before the first step none is planned.
        match self.step.filter(|step| *step != 0.0) {
            None => f.write_str("; raise it with `max_steps`"),
            Some(step) => write!(
                f,
                ", where the next is {step:.1e} long; raise it with `max_steps`, unless steps only shrink: then the motion falls into a singularity, or forces jump, as friction by `abs` does where it sticks (smooth it, as by `tanh`, and take `Radau`), or friction along two velocities begins slowly (take `Radau`)"
            ),
        }
    }
}

impl Ending {
    /// Returns the last time reached.
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
            | Self::TransitionLimit { time, .. }
            | Self::WallTimeLimit { time }
            | Self::Event { time, .. }
            | Self::EventsAccumulate { time, .. }
            | Self::EventNotFinite { time, .. }
            | Self::Cancelled { time } => time,
            Self::ControllerFailed { time, .. } => time,
            Self::Elsewhere { time, .. } => time,
        }
    }

    /// True if the motion reached the requested end time.
    pub fn is_complete(&self) -> bool {
        matches!(self, Self::Complete { .. })
    }

    /// True if something other than the caller stopped the motion before its end.
    pub fn is_failure(&self) -> bool {
        !matches!(self, Self::Complete { .. } | Self::Event { .. } | Self::Cancelled { .. })
    }

    /// Returns the ending of an integration that `error` stopped after `time`.
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
            Self::Contradictory { time, error } | Self::Unsolved { time, error } => {
                write!(f, "stopped at t = {time}: {error}")
            }
            Self::OffConstraints { time, error } => {
                write!(f, "stopped at t = {time}: {error}, or take shorter steps")
            }
            Self::NotFinite { time, row } => write!(
                f,
                "stopped at t = {time}: the equations are not finite in the row of {row}; check the parameters, whether the motion runs into a pole, and, with steps of one length, whether shorter ones are stable"
            ),
            Self::MethodFailed { time, reason } => {
                write!(f, "stopped at t = {time} by the method: {reason}")
            }
            Self::StepLimit { time, steps, pace } => {
                write!(f, "stopped at t = {time} after {steps} steps, the limit{pace}")
            }
            Self::TransitionLimit { time, transitions } => write!(
                f,
                "stopped at t = {time}, after {transitions} transition{} of contacts, the limit; raise it with `max_transitions`, or take `Radau` where bodies slide along two velocities",
                if *transitions == 1 { "" } else { "s" }
            ),
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
            Self::ControllerFailed { time, said } => {
                write!(f, "stopped at t = {time}: the controller failed: {said}")
            }
            Self::Elsewhere { said, .. } => write!(f, "{said}"),
            Self::Cancelled { time } => write!(f, "cancelled at t = {time}"),
        }
    }
}

/// Prints the sentence of `Display`, since `main` prints a returned error by `Debug`.
impl Debug for Ending {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(self, f)
    }
}

impl core::error::Error for Ending {}
