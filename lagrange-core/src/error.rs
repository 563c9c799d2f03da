//! What can go wrong, each with the name of the entry at fault and what to do about it.

mod display;
mod ending;
#[cfg(feature = "std")]
mod ensemble;

#[cfg(feature = "alloc")]
use alloc::{boxed::Box, string::String, vec::Vec};

pub use crate::names::{Entry, Names, Row};
pub use ending::{Ending, Pace};
#[cfg(feature = "std")]
pub use ensemble::EnsembleError;

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
    /// [`MotionBuilder::towards`](crate::MotionBuilder::towards) gives what was computed until then.
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
    /// The gradient of a holonomic constraint vanishes where it holds, as that of cos(a) = 1 does: to first order it fixes nothing.
    ///
    /// Of each entry of its row in F no more is left than 16 times what ε^(3/4) of the coordinates (2·10⁻¹² for `f64`) makes of
    /// it. A row that is zero all around, as of a constraint times a parameter that is zero, is none. At a singular pose
    /// it may vanish there alone: no first derivative says which way a motion goes on from rest.
    NoGradient {
        /// The constraint at fault.
        constraint: &'static str,
        /// The time of the state.
        time: f64,
    },
    /// Constraints depend on one another to first order, but not to second, as |a| = l, |b| = l and |a − b| = 2l do, which together
    /// are |a + b|² = 0: the first derivatives, which are all that the equations of motion know, leave directions free that the
    /// constraints do not.
    ///
    /// Here or so near that the constraints differ by their round-off. At a singular pose, where branches of a motion meet, that
    /// is so at this pose alone.
    DependentToFirstOrder {
        /// The constraints whose combination has no gradient.
        constraints: Names,
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
    /// A constraint depends on this input, which would change the admissible states or accelerations.
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
    /// A time at which members are to be sampled that is not finite, or not in order with those before.
    SampleTime {
        /// Which one, counted from 0.
        index: usize,
        /// The time.
        time: f64,
    },
    /// An error of an ensemble as a whole, or of one of its members.
    #[cfg(feature = "std")]
    Ensemble(EnsembleError),
    /// A coefficient of restitution that is none.
    Restitution {
        /// Its value.
        value: f64,
    },
    /// A leg that does not go on where a hybrid trajectory has come to.
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

impl core::error::Error for Error {}

/// Lets `?` return the ending of a [`Motion`](crate::Motion) that failed from a function that returns an [`Error`].
#[cfg(feature = "alloc")]
impl From<Ending> for Error {
    fn from(ending: Ending) -> Self {
        Self::Unfinished(Box::new(ending))
    }
}
