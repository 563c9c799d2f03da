//! Errors, each with the name of the entry at fault and advice what to do.

mod display;
mod ending;
#[cfg_attr(not(feature = "alloc"), path = "error/never.rs")]
pub(crate) mod owned;

pub use crate::names::{Entry, Names, Row, WrittenName};
pub use ending::{Ending, Pace};
pub use owned::EnsembleError;
use owned::{BoxedEnding, BoxedOrbitError, String, Strings};

/// Reason why a computation did not start, did not reach its end, or has no answer to a query.
///
/// Times and residuals are `f64` for every scalar type of the system.
#[non_exhaustive]
#[derive(Clone, PartialEq)]
pub enum Error {
    /// An entry of the given state is infinite or NaN.
    StateNotFinite {
        /// The coordinate, velocity, momentum or time at fault.
        entry: Entry,
        /// Its value.
        value: f64,
    },
    /// A state has more or fewer coordinates or velocities than its system has coordinates.
    StateLength {
        /// Number of the coordinates or velocities of the state.
        found: usize,
        /// Number of the coordinates of the system.
        expected: usize,
    },
    /// A field of a system of any number of bodies has more or fewer elements than it should.
    FieldLength {
        /// Name of the field.
        field: &'static str,
        /// Number of its elements.
        found: usize,
        /// Number that it should have.
        expected: usize,
        /// The length whose value that is: `n`.
        of: &'static str,
    },
    /// An entry of a table of indices is beyond the end of the array that it points into.
    FieldIndex {
        /// Name of the table.
        field: &'static str,
        /// Place of the entry in the table, counted from 0.
        entry: usize,
        /// The entry.
        index: usize,
        /// Number of elements of the array.
        length: usize,
    },
    /// A sum or a range leaves an array whose length is a field, or a family of definitions.
    ElementMissing {
        /// Name of the array.
        array: &'static str,
        /// Index of the first element that does not exist.
        index: i64,
        /// Index of the first element of the array.
        from: usize,
        /// Index after the last element.
        to: usize,
    },
    /// A parameter matrix lacks the property that its type or `#[parameter(…)]` declares.
    ParameterNotAsSaid {
        /// Name of the parameter.
        name: &'static str,
        /// Required property: `symmetric`, `a rotation`.
        wanted: &'static str,
        /// Deviation from the property, relative to the size of the matrix; not finite if an entry is not
        /// finite.
        defect: f64,
    },
    /// The equations of motion have no value, and a parameter is infinite or NaN.
    ParameterNotFinite {
        /// Name of the first such parameter.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// All four entries of a unit quaternion are zero.
    ZeroQuaternion {
        /// Name of the quaternion.
        name: &'static str,
    },
    /// The equations of motion evaluate to infinity or NaN.
    EquationsNotFinite {
        /// First row of the equations with an entry that is not finite.
        row: Row,
        /// The time of evaluation.
        time: f64,
    },
    /// A derivative of the equations of motion evaluates to infinity or NaN.
    DerivativeNotFinite {
        /// First row of the derivative with an entry that is not finite.
        row: Row,
        /// Variable of differentiation; for a derivative along several at once, the one that changes most.
        entry: Entry,
        /// The time of evaluation.
        time: f64,
    },
    /// A setting of the method, such as a tolerance, is not positive and finite.
    Setting {
        /// The name of the setting.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The end time is infinite or NaN.
    EndNotFinite {
        /// End time requested.
        end: f64,
    },
    /// The motion stopped before its end time.
    ///
    /// [`MotionBuilder::towards`](crate::MotionBuilder::towards) returns the trajectory computed until then.
    Unfinished(
        /// Time, place and reason of the stop.
        BoxedEnding,
    ),
    /// Neither the mass matrix nor the constraints determine some accelerations.
    Singular {
        /// Coordinates whose accelerations are undetermined.
        coordinates: Names,
        /// The time of evaluation.
        time: f64,
    },
    /// Dependent constraints demand different accelerations.
    Contradictory {
        /// The constraint that the others contradict.
        constraint: &'static str,
        /// The time of evaluation.
        time: f64,
    },
    /// The given state violates a constraint.
    Inconsistent {
        /// The constraint at fault.
        constraint: Row,
        /// True if the rate of change F q̇ + b is violated, false if Φ is.
        rate: bool,
        /// Value of Φ or F q̇ + b, which should be zero.
        residual: f64,
        /// The time of the state.
        time: f64,
    },
    /// The gradient of a holonomic constraint vanishes where the constraint holds, as for cos(a) = 1. To first
    /// order such a constraint restricts nothing.
    ///
    /// Criterion: each entry of the constraint's row of F is at most 16 times its change when the coordinates
    /// change by ε^(3/4) (2·10⁻¹² for `f64`). Or the parameters alone cancel the row, as across the plane of a linkage that
    /// two bases turn by equal angles: no entry exceeds 4 times the bound of its rounding error. A row that is zero throughout a neighbourhood does not count, for
    /// example that of a constraint times a parameter that is zero. At a singular pose the gradient may vanish
    /// at that pose alone: no first derivative then tells which way a motion leaves rest.
    NoGradient {
        /// The constraint at fault.
        constraint: Row,
        /// The time of the state.
        time: f64,
    },
    /// A constraint of a system of any number of bodies depends on others, so that its multiplier is not determined: its
    /// pivot has lost half of its digits.
    Dependent {
        /// The constraint.
        constraint: Row,
        /// The time of the state.
        time: f64,
    },
    /// Constraints depend on one another to first order but not to second, as |a| = l, |b| = l and |a − b| = 2l
    /// do, which together imply |a + b|² = 0. The equations of motion contain first derivatives only, so they
    /// leave directions free that the constraints forbid.
    ///
    /// The dependence holds at this state, or at one so near that the constraints differ by their round-off. At
    /// a singular pose, where branches of a motion meet, it holds at that pose alone.
    DependentToFirstOrder {
        /// Constraints whose linear combination has no gradient.
        constraints: Names,
        /// The time of the state.
        time: f64,
    },
    /// Multipliers that grow without bound towards a pose at which constraints depend on one another: no bounded force keeps
    /// the constraints there.
    UnboundedMultipliers {
        /// Constraints whose multipliers have a pole.
        constraints: Names,
        /// Time at which the motion would pass the pose.
        time: f64,
    },
    /// Constraints that do not hold together near a guess.
    Conflicting {
        /// The constraints that remain violated where the sum of squared residuals is least.
        constraints: Names,
        /// Largest residual there, in units of the gradient of its constraint at the guess: a distance.
        distance: f64,
        /// The time of the guess.
        time: f64,
    },
    /// Newton's iteration found no state on the constraints near the given one.
    NotProjected {
        /// Constraint farthest from being satisfied.
        constraint: Row,
        /// Residual of that constraint.
        residual: f64,
        /// Iterations done.
        iterations: usize,
        /// The time of the state.
        time: f64,
    },
    /// The held entries of the state leave too little freedom to satisfy a constraint.
    HeldTooMuch {
        /// Constraint farthest from being satisfied.
        constraint: &'static str,
        /// True if velocities are held and F q̇ + b is violated; false if coordinates are held and Φ is
        /// violated.
        rate: bool,
        /// Remaining value of F q̇ + b or Φ.
        residual: f64,
        /// Coordinates that are held, or whose velocities are held.
        held: Names,
        /// The time of the state.
        time: f64,
    },
    /// The momenta do not determine some velocities: ∂p/∂q̇ is singular along the constraints.
    VelocityUndetermined {
        /// Coordinates whose velocities can change without changing the momenta.
        coordinates: Names,
        /// The time of the momenta.
        time: f64,
    },
    /// Newton's iteration found no velocities with the given momenta.
    MomentumNotReached {
        /// Coordinate whose momentum is farthest from the given one.
        coordinate: &'static str,
        /// Residual of that momentum.
        residual: f64,
        /// Iterations done.
        iterations: usize,
        /// The time of the momenta.
        time: f64,
    },
    /// No equilibrium was found near the given state.
    NoEquilibrium {
        /// Row of the equations farthest from being satisfied.
        row: Row,
        /// Residual of that row: a generalized force, or the value of a constraint.
        residual: f64,
        /// Iterations done.
        iterations: usize,
        /// Best values found for the unknowns, as text: `x = 1.5`.
        best: Strings,
        /// The time of the state.
        time: f64,
    },
    /// The accelerations can vanish, but do not stay zero: the motion at these velocities changes the
    /// equations.
    NotSteady {
        /// The moving coordinate that contributes most to the change of `row`.
        coordinate: &'static str,
        /// First row of the equations that changes.
        row: Row,
        /// The time of the state.
        time: f64,
    },
    /// A constraint depends on this input, so the input would change the admissible states or accelerations.
    InputShiftsConstraint {
        /// Name of the parameter used as an input.
        input: &'static str,
        /// Name of the constraint.
        constraint: &'static str,
    },
    /// A parameter cannot be changed: its field is a reference, or has a type of unknown shape.
    ParameterFixed {
        /// Name of the parameter.
        name: &'static str,
    },
    /// No values of the named inputs produce the requested accelerations.
    NotRealizable {
        /// Unbalanced row of the equations: a coordinate whose generalized force no input balances, or a
        /// constraint that the accelerations violate.
        row: Row,
        /// Residual of that row: the missing generalized force, with the sign of M q̈ − h − Fᵀλ, or F q̈ + γ.
        residual: f64,
        /// The time of the state.
        time: f64,
    },
    /// The given accelerations and the constraints leave others undetermined.
    AccelerationsNotUnique {
        /// Coordinates whose accelerations can change together.
        coordinates: Names,
        /// The time of the state.
        time: f64,
    },
    /// The generalized forces are not linear in the inertial parameters of the named bodies.
    NotInertial {
        /// Coordinate whose generalized force is not what the regressor says.
        row: Row,
        /// The generalized force less what the regressor says.
        residual: f64,
        /// The time of the state.
        time: f64,
    },
    /// A change of a state has another number of entries than there are local coordinates.
    LocalChange {
        /// Number of entries.
        found: usize,
        /// Number of local coordinates: of places, and as many of velocities.
        expected: usize,
    },
    /// An entry of a change in local coordinates is infinite or NaN.
    LocalChangeNotFinite {
        /// Name of the local coordinate.
        coordinate: String,
    },
    /// Regressors that are put together are of different bodies.
    OtherBodies,
    /// Some states do not tell whether an inertial parameter can be found beside those before it.
    BaseParametersUndecided {
        /// Name of the parameter.
        parameter: String,
        /// What is left of its column beside the others, as a part of its length.
        left: f64,
    },
    /// Several values of the named inputs produce the requested accelerations.
    InputsNotUnique {
        /// Inputs that can change together without changing the accelerations.
        inputs: Names,
        /// The time of the state.
        time: f64,
    },
    /// The iteration for eigenvalues or singular values did not converge, or an entry of the matrix is not finite.
    EigenvaluesNotFound,
    /// No coordinate, constraint, parameter or other quantity of the requested kind has this name.
    UnknownName {
        /// Name requested.
        name: String,
        /// Kind of name expected: `coordinate`, `constraint`, …
        kind: &'static str,
        /// Actual meaning of the name, or a similar name: `it is the velocity of …`, `did you mean …`.
        hint: Option<String>,
        /// Existing names of this kind.
        known: Strings,
    },
    /// An entry of a state is given twice.
    RepeatedName {
        /// Name of the entry.
        name: String,
    },
    /// The points of a table define no function: too few, not finite, or x does not increase.
    Table,
    /// A sample time of an ensemble is not finite, or not in order with the times before it.
    SampleTime {
        /// Index of the sample time, counted from 0.
        index: usize,
        /// The sample time.
        time: f64,
    },
    /// No periodic orbit was found, or it has no family.
    Orbit(BoxedOrbitError),
    /// An error of an ensemble as a whole, or of one of its members.
    Ensemble(EnsembleError),
    /// A coefficient of restitution is negative or not finite, or that of a contact exceeds 1.
    Restitution {
        /// Name of the contact or of the constraint that is hit.
        constraint: &'static str,
        /// Its value.
        value: f64,
    },
    /// A contact is stated as closed, though its gap is not zero, or its velocity not zero.
    ClosedApart {
        /// Name of the contact.
        contact: &'static str,
        /// True if the gap changes, false if it is open or negative.
        rate: bool,
        /// The gap or its rate.
        residual: f64,
        /// The time of the state.
        time: f64,
    },
    /// A contact has Poisson's law of impact, which [time stepping](crate::contact::MoreauJean) does not have.
    ImpactLaw {
        /// Name of the contact.
        contact: &'static str,
    },
    /// The gap of a contact is negative: at the start, or because a motion passed through it unnoticed.
    Penetration {
        /// Name of the contact.
        contact: &'static str,
        /// Its gap.
        gap: f64,
        /// The time of the state.
        time: f64,
    },
    /// No impulses or forces keep the gaps of these contacts from becoming negative, as between walls that close in.
    ContactsContradict {
        /// The contacts that touch.
        contacts: Names,
        /// The time of the state.
        time: f64,
    },
    /// Friction that slides leaves no acceleration with a force that presses the bodies together: the contact digs in, or the
    /// force grows without bound (Painlevé's paradox). All that the contacts may do was tried.
    FrictionJams {
        /// Name of the friction.
        friction: &'static str,
        /// The time of the state.
        time: f64,
    },
    /// The forces of friction that several contacts share, or its directions in a plane, could not be decided.
    FrictionUndecided {
        /// Name of the friction, or of the contact.
        friction: &'static str,
        /// The time of the state.
        time: f64,
    },
    /// Friction is negative, infinite or no number, or its limit is below the force of sliding.
    Friction {
        /// Name of the friction.
        friction: &'static str,
        /// The limit while the bodies stick, and the force of sliding.
        bounds: [f64; 2],
        /// The time of the state.
        time: f64,
    },
    /// No impulses of friction and the contacts beside it were found in a [time step](crate::contact::MoreauJean).
    ImpulsesNotFound {
        /// Name of the friction.
        friction: &'static str,
        /// Time at which the impulses act.
        time: f64,
    },
    /// Forces change too much within a [time step](crate::contact::MoreauJean).
    StepTooLong {
        /// What the balance of momentum is off by, as a part of its largest term.
        residual: f64,
        /// How often impulses were found.
        iterations: usize,
        /// Time at the start of the step.
        time: f64,
    },
    /// The part θ of a [time step](crate::contact::MoreauJean::theta) is below ½ or above 1.
    Theta {
        /// Its value.
        value: f64,
    },
    /// More than 100,000 impacts follow one another at one time: elastic ones of a ball between walls without room, or those of a
    /// body that is lighter than its neighbours by a factor of ten thousand or more.
    ImpactsDoNotEnd {
        /// Their time.
        time: f64,
    },
    /// The end of a motion with contacts lies before its start. The state after an impact does not determine the state before.
    MotionBackwards {
        /// Time of the start.
        start: f64,
        /// End time requested.
        end: f64,
    },
    /// A leg of a hybrid trajectory does not continue from the end of the previous leg, in the same direction
    /// of time.
    LegApart {
        /// Start time of the leg.
        start: f64,
        /// End time of the leg.
        end: f64,
        /// End time of the hybrid trajectory so far, where the leg should start.
        expected: f64,
    },
    /// The function of an event is NaN.
    EventNotFinite {
        /// The name of the event.
        event: &'static str,
        /// The time of evaluation.
        time: f64,
    },
    /// The function of an event is not a number in a motion by [time steps](crate::contact::MoreauJean), where events know no
    /// accelerations and multipliers.
    EventInTimeSteps {
        /// The name of the event.
        event: &'static str,
        /// The time of evaluation.
        time: f64,
    },
    /// The state after a transition of contacts has no derivative by the state before it.
    NoDerivativeAcross {
        /// Name of the contact, or of the friction.
        contact: &'static str,
        /// Time of the transition.
        time: f64,
        /// Reason.
        reason: &'static str,
    },
    /// The motion touches the zero of an event function without crossing it: time and existence of the event
    /// are then not differentiable.
    Grazing {
        /// The name of the event.
        event: &'static str,
        /// The time of the event.
        time: f64,
    },
    /// The trajectory does not cover the requested time.
    OutsideTrajectory {
        /// Time requested.
        time: f64,
        /// Start time of the trajectory.
        start: f64,
        /// End time of the trajectory.
        end: f64,
    },
}

impl core::error::Error for Error {}
