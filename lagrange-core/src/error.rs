//! What can go wrong, each with the name of the entry at fault and what to do about it.

use core::fmt::{self, Debug, Display, Formatter};

#[cfg(feature = "alloc")]
use alloc::{boxed::Box, string::String, vec::Vec};

#[cfg(feature = "alloc")]
use crate::ending::Ending;
use crate::names::{Entry, Names, Row};

/// Why a computation did not start or did not reach its end, or what a query asked in vain.
///
/// Times and residuals are given as `f64` whatever the scalar of the system is.
#[non_exhaustive]
#[derive(Clone, PartialEq)]
pub enum Error {
    /// An entry of the state given is infinite or not a number.
    StateNotFinite {
        /// The coordinate, velocity, momentum or time at fault.
        entry: Entry,
        /// Its value.
        value: f64,
    },
    /// A matrix among the parameters is not what its type or `#[parameter(…)]` says.
    ParameterNotAsSaid {
        /// The parameter.
        name: &'static str,
        /// What it should be: `symmetric`, `a rotation`.
        wanted: &'static str,
        /// How far it is from that, as a part of its size; not a number where an entry is not finite.
        defect: f64,
    },
    /// The equations of motion evaluate to infinity or not a number.
    EquationsNotFinite {
        /// The first row at fault.
        row: Row,
        /// The time of evaluation.
        time: f64,
    },
    /// A derivative of the equations of motion evaluates to infinity or not a number.
    DerivativeNotFinite {
        /// The first row at fault.
        row: Row,
        /// By what it was differentiated; of several at once, the one that changes most.
        entry: Entry,
        /// The time of evaluation.
        time: f64,
    },
    /// A setting of the method, such as a tolerance, that must be positive and is not.
    Setting {
        /// The name of the setting.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The end time is infinite or not a number.
    EndNotFinite {
        /// The end asked for.
        end: f64,
    },
    /// The motion stopped before its end.
    ///
    /// [`Simulate::integrate_towards`](crate::Simulate::integrate_towards) gives what was computed until then.
    #[cfg(feature = "alloc")]
    Unfinished(
        /// When, where and why.
        Box<Ending>,
    ),
    /// Neither mass matrix nor constraints determine some accelerations.
    Singular {
        /// The coordinates that can accelerate freely.
        coordinates: Names,
        /// The time of evaluation.
        time: f64,
    },
    /// Constraints that depend on one another demand different accelerations.
    Contradictory {
        /// The constraint that the others contradict.
        constraint: &'static str,
        /// The time of evaluation.
        time: f64,
    },
    /// The state given does not satisfy a constraint.
    Inconsistent {
        /// The constraint at fault.
        constraint: &'static str,
        /// Whether its rate of change F q̇ + b is meant (else Φ).
        rate: bool,
        /// The value that should be zero.
        residual: f64,
        /// The time of the state.
        time: f64,
    },
    /// Newton's iteration found no state on the constraints near the one given.
    NotProjected {
        /// The constraint that is farthest from satisfied.
        constraint: &'static str,
        /// Its residual.
        residual: f64,
        /// Iterations done.
        iterations: usize,
        /// The time of the state.
        time: f64,
    },
    /// Entries of the state that are held leave the others too little freedom to satisfy a constraint.
    HeldTooMuch {
        /// The constraint that is farthest from satisfied.
        constraint: &'static str,
        /// Whether its rate of change F q̇ + b is meant, and velocities are held (else Φ and coordinates).
        rate: bool,
        /// What is left of it.
        residual: f64,
        /// The coordinates that are held, or whose velocities are.
        held: Names,
        /// The time of the state.
        time: f64,
    },
    /// The momenta do not determine some velocities: ∂p/∂q̇ is singular along the constraints.
    VelocityUndetermined {
        /// The coordinates whose velocities can change and leave the momenta as they are.
        coordinates: Names,
        /// The time of the momenta.
        time: f64,
    },
    /// Newton's iteration found no velocity with the momenta given.
    MomentumNotReached {
        /// The coordinate whose momentum is farthest off.
        coordinate: &'static str,
        /// By how much.
        residual: f64,
        /// Iterations done.
        iterations: usize,
        /// The time of the momenta.
        time: f64,
    },
    /// No equilibrium was found near the state given.
    #[cfg(feature = "alloc")]
    NoEquilibrium {
        /// The row that is farthest from satisfied.
        row: Row,
        /// Its residual: a generalized force, or what a constraint leaves.
        residual: f64,
        /// Steps taken.
        iterations: usize,
        /// What was sought, where it came nearest: `x = 1.5`.
        best: Vec<String>,
        /// The time of the state.
        time: f64,
    },
    /// Accelerations can be zero, but do not stay so: the velocities lead to where the equations are others.
    NotSteady {
        /// The coordinate whose motion changes the equations most.
        coordinate: &'static str,
        /// The first row that changes.
        row: Row,
        /// The time of the state.
        time: f64,
    },
    /// An input by which a constraint, and with it the states or accelerations that it allows, would change.
    InputShiftsConstraint {
        /// The parameter.
        input: &'static str,
        /// The constraint.
        constraint: &'static str,
    },
    /// A parameter that cannot be changed: it is behind a reference, or in a field whose type says no shape.
    ParameterFixed {
        /// The parameter.
        name: &'static str,
    },
    /// No values of the inputs named give the accelerations asked for.
    NotRealizable {
        /// A row that they leave unbalanced: a coordinate whose force no input balances, or a constraint that the
        /// accelerations violate.
        row: Row,
        /// What is left of it: the generalized force that is lacking with this sign, M q̈ − h − Fᵀλ, or F q̈ + γ.
        residual: f64,
        /// The time of the state.
        time: f64,
    },
    /// Several values of the inputs named give the accelerations asked for.
    InputsNotUnique {
        /// The inputs that can change, together, and leave the accelerations as they are.
        inputs: Names,
        /// The time of the state.
        time: f64,
    },
    /// The iteration for eigenvalues or singular values did not converge, or an entry of the matrix is not finite.
    EigenvaluesNotFound,
    /// A name that the system does not have.
    #[cfg(feature = "alloc")]
    UnknownName {
        /// The name asked for.
        name: String,
        /// What it should name: `coordinate`, `constraint`, …
        kind: &'static str,
        /// What it is instead, or which name is near: `it is the velocity of …`, `did you mean …`.
        hint: Option<String>,
        /// The names that exist.
        known: Vec<String>,
    },
    /// An entry of a state that was given twice.
    #[cfg(feature = "alloc")]
    RepeatedName {
        /// The name.
        name: String,
    },
    /// Points that no function runs through.
    Table,
    /// A part of an ensemble that does not exist.
    Shard {
        /// Which part was asked for, counted from 0.
        shard: usize,
        /// How many parts there are.
        of: usize,
    },
    /// A time at which members are to be sampled that is not finite, or not in order with those before.
    SampleTime {
        /// Which one, counted from 0.
        index: usize,
        /// The time.
        time: f64,
    },
    /// Outcomes of different ensembles, which are no parts of one.
    Merge {
        /// In what they differ.
        reason: &'static str,
    },
    /// A member taken over from another run, which is not to be mixed with this one.
    OtherRun {
        /// The index of the member.
        member: usize,
        /// In what the runs differ.
        differs: &'static str,
    },
    /// Rows to resume from, where code that no fingerprint sees decides about them and the run has no
    /// [tag](crate::Ensemble::tag).
    #[cfg(feature = "std")]
    Untagged {
        /// The code: an event, a controller, ….
        code: String,
    },
    /// What went wrong with a member in another process, which told it in words.
    #[cfg(feature = "std")]
    Elsewhere {
        /// Its words.
        said: String,
    },
    /// A file of a table in Parquet that cannot be read or written, or does not belong there.
    #[cfg(feature = "parquet")]
    Parquet {
        /// The file, or the directory.
        file: String,
        /// What is wrong.
        reason: String,
    },
    /// The ranks of MPI cannot do this ensemble together.
    Ranks {
        /// The first rank at fault.
        rank: usize,
        /// Why not.
        reason: &'static str,
    },
    /// A member asked for that the ensemble does not have.
    NoSuchMember {
        /// Its index.
        member: usize,
        /// How many members there are.
        count: usize,
    },
    /// A table of members that are done, but not of this system, or of several runs.
    Resume {
        /// The line, counted from 1.
        line: usize,
        /// The column, counted from 1.
        column: usize,
        /// What is wrong there.
        reason: &'static str,
    },
    /// A coefficient of restitution that is none.
    Restitution {
        /// Its value.
        value: f64,
    },
    /// A leg that does not go on where a journey has come to.
    LegApart {
        /// When the leg starts.
        start: f64,
        /// When it ends.
        end: f64,
        /// When it should start.
        expected: f64,
    },
    /// The function of an event is not a number.
    EventNotFinite {
        /// The name of the event.
        event: &'static str,
        /// The time of evaluation.
        time: f64,
    },
    /// A motion that touches an event and does not cross it: where it does, and whether, has no derivative.
    Grazing {
        /// The name of the event.
        event: &'static str,
        /// The time of the event.
        time: f64,
    },
    /// A time that the trajectory does not cover.
    OutsideTrajectory {
        /// The time asked for.
        time: f64,
        /// Where the trajectory starts.
        start: f64,
        /// Where it ends.
        end: f64,
    },
}

impl Display for Error {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::StateNotFinite { entry, value } => {
                write!(f, "`{entry}` is {value} in the state given: every entry must be finite")
            }
            Self::ParameterNotAsSaid { name, wanted, defect } if !defect.is_finite() => {
                write!(f, "the parameter `{name}` is not {wanted}: one of its entries is not finite")
            }
            Self::ParameterNotAsSaid { name, wanted, defect } => {
                write!(f, "the parameter `{name}` is not {wanted}: it is off by {defect:.1e} of its size")
            }
            Self::EquationsNotFinite { row, time } => write!(
                f,
                "the equations are not finite at t = {time}; row of {row}: check the parameters, and whether the state is at a pole"
            ),
            Self::DerivativeNotFinite { row, entry, time } => write!(
                f,
                "the derivative of the equations of motion by `{entry}` is not finite at t = {time}; row of {row}: check whether the state is at a pole, or at a point where the equations have a kink"
            ),
            Self::Table => {
                write!(
                    f,
                    "a table needs at least two points (a smooth one three), finite, with x increasing from one to the next"
                )
            }
            Self::Setting { name, value } => {
                write!(f, "the {name} is {value}: it must be positive and finite")
            }
            Self::EndNotFinite { end } => write!(f, "cannot integrate to t = {end}: the end must be finite"),
            #[cfg(feature = "alloc")]
            Self::Unfinished(ending) => write!(f, "{ending}"),
            Self::Singular { coordinates, time } => write!(
                f,
                "the equations do not determine the acceleration of {coordinates} at t = {time}: give it a mass or constrain it"
            ),
            Self::Contradictory { constraint, time } => write!(
                f,
                "constraint `{constraint}` contradicts the others at t = {time}: no accelerations satisfy all; remove it or make it agree"
            ),
            Self::Inconsistent { constraint, rate, residual, time } => write!(
                f,
                "the state violates constraint `{constraint}` at t = {time}: its {} is {residual:e}, not 0; call `make_consistent` first",
                if *rate { "rate F q_dot + b" } else { "residual" }
            ),
            Self::NotProjected { constraint, residual, iterations, time } => write!(
                f,
                "no consistent state found near the one given at t = {time}: constraint `{constraint}` has residual {residual:e} after {iterations} iterations; start closer to the constraints, or check that they can hold together"
            ),
            Self::HeldTooMuch { constraint, rate, residual, held, time } => write!(
                f,
                "what is held, {}{held}, leaves too little freedom for constraint `{constraint}` at t = {time}: its {} stays {residual:e}; hold less, or give what is held other values",
                if *rate { "the velocity of " } else { "" },
                if *rate { "rate F q_dot + b" } else { "residual" }
            ),
            Self::VelocityUndetermined { coordinates, time } => write!(
                f,
                "the momenta do not determine the velocity of {coordinates} at t = {time}: give it a mass, constrain it, or start the search elsewhere with `legendre_near`"
            ),
            Self::MomentumNotReached { coordinate, residual, iterations, time } => write!(
                f,
                "no velocity found with the momenta given at t = {time}: that of `{coordinate}` is off by {residual:e} after {iterations} iterations; start the search closer with `legendre_near`, or check that some velocity has these momenta"
            ),
            #[cfg(feature = "alloc")]
            Self::NoEquilibrium { row, residual, iterations, best, time } => write!(
                f,
                "no equilibrium found near the state given at t = {time}: the row of {row} leaves {residual:e} after {iterations} steps, at {}; start closer, or let other coordinates, velocities or parameters change",
                best.join(", ")
            ),
            Self::NotSteady { coordinate, row, time } => write!(
                f,
                "no steady motion with these velocities at t = {time}: the row of {row} changes as `{coordinate}` moves; give it no velocity"
            ),
            Self::InputShiftsConstraint { input, constraint } => write!(
                f,
                "constraint `{constraint}` changes with the input `{input}`, and with it which motions are allowed: make the input a force, or what it moves a coordinate"
            ),
            Self::ParameterFixed { name } => write!(
                f,
                "the parameter `{name}` cannot be changed: its field is a reference or a rotation, or its type says no shape; make the field a number, an array, or a vector or matrix of nalgebra"
            ),
            Self::NotRealizable { row: row @ Row::Coordinate(_), residual, time } => write!(
                f,
                "the inputs named do not give these accelerations at t = {time}: the row of {row} lacks a generalized force of {residual:e}; name an input that acts on it, or ask for other accelerations"
            ),
            Self::NotRealizable { row, residual, time } => write!(
                f,
                "these accelerations violate {row} at t = {time}: F q_ddot + gamma is {residual:e}, not 0; `solve` gives some that do not"
            ),
            Self::InputsNotUnique { inputs, time } => {
                write!(f, "many values of {inputs} give these accelerations at t = {time}: name fewer inputs")
            }
            Self::EigenvaluesNotFound => write!(
                f,
                "the eigenvalues or singular values of a matrix were not found: check that its entries are finite, and the scales of the parameters"
            ),
            #[cfg(feature = "alloc")]
            Self::UnknownName { name, kind, hint: Some(hint), .. } => {
                write!(f, "there is no {kind} `{name}`: {hint}")
            }
            #[cfg(feature = "alloc")]
            Self::UnknownName { name, kind, hint: None, known } => match known.as_slice() {
                [] => write!(f, "there is no {kind} `{name}`; the system has none"),
                _ => write!(f, "there is no {kind} `{name}`; there are `{}`", known.join("`, `")),
            },
            #[cfg(feature = "alloc")]
            Self::RepeatedName { name } => write!(f, "`{name}` is given twice: give each entry once"),
            Self::Shard { shard, of } => {
                write!(
                    f,
                    "there is no part {shard} of {of}: parts are counted from 0, and there is at least one"
                )
            }
            Self::SampleTime { index, time } => write!(
                f,
                "the sample time {index} (counted from 0) is {time}: give finite times in the order of the motion"
            ),
            Self::Merge { reason } => write!(f, "the outcomes are not parts of one ensemble: {reason}"),
            Self::OtherRun { member, differs } => write!(
                f,
                "member {member} of the table to resume from is of another run: {differs}; resume with what made the table, or begin a new one"
            ),
            #[cfg(feature = "std")]
            Self::Untagged { code } => write!(
                f,
                "{code} may have been another when the rows to resume from were made, and nothing in them tells: name it in both runs by `.tag(\"…\")` on the ensemble, and anew whenever it changes; `.tag(\"\")` takes over rows of a run without a tag"
            ),
            #[cfg(feature = "std")]
            Self::Elsewhere { said } => f.write_str(said),
            #[cfg(feature = "parquet")]
            Self::Parquet { file, reason } => write!(f, "{file}, of a table of members: {reason}"),
            Self::Ranks { rank, reason } => {
                write!(f, "the ranks cannot do this ensemble together: on rank {rank} {reason}")
            }
            Self::NoSuchMember { member, count } => {
                write!(f, "there is no member {member}: the ensemble has {count}, counted from 0")
            }
            Self::Resume { line, column, reason } => write!(
                f,
                "line {line}, column {column} of the table of members does not belong there: {reason}"
            ),
            Self::Restitution { value } => {
                write!(f, "the coefficient of restitution is {value}: it must not be negative, and finite")
            }
            Self::LegApart { start, end, expected } => write!(
                f,
                "the leg from t = {start} to {end} does not go on from t = {expected}, where the journey has come to: start it there, and lead it the same way in time"
            ),
            Self::EventNotFinite { event, time } => write!(
                f,
                "the function of the event `{event}` is not a number at t = {time}: make it one wherever the motion may lead"
            ),
            Self::Grazing { event, time } => write!(
                f,
                "the motion grazes the event `{event}` at t = {time}: the rate of its function is zero there to round-off, and the event has no derivative; start so that it is crossed, or missed"
            ),
            Self::OutsideTrajectory { time, start, end } => {
                write!(f, "t = {time} lies outside the trajectory, which covers {start} to {end}")
            }
        }
    }
}

/// The sentence of its `Display`: `main` prints an error that it returns by this. What tells errors apart are its fields.
impl Debug for Error {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(self, f)
    }
}

impl core::error::Error for Error {}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use alloc::{format, string::ToString};

    /// `main` prints an error by `Debug`, and so does a result that is unwrapped.
    #[test]
    fn errors_and_endings_are_debugged_as_sentences() {
        let apart = Error::LegApart { start: 0.5, end: 1.0, expected: 0.25 };
        let ending = Ending::TimeTooCoarse { time: 2.0, step: 1e-17 };
        assert_eq!(
            format!("{apart:?}"),
            "the leg from t = 0.5 to 1 does not go on from t = 0.25, where the journey has come to: start it there, and lead it the same way in time"
        );
        assert_eq!([format!("{apart:?}"), format!("{ending:#?}")], [apart.to_string(), ending.to_string()]);
    }
}
