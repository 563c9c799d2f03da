//! Messages of errors.

use core::fmt::{self, Debug, Display, Formatter};

use super::Error;
use super::owned::{joined, said_of};
use crate::names::Row;

impl Display for Error {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::StateNotFinite { entry, value } => {
                write!(f, "`{entry}` is {value} in the state given: every entry must be finite")
            }
            Self::StateLength { found, expected } => write!(
                f,
                "the state given has {found} coordinates or velocities, and the system {expected} coordinates: q and q̇ have one entry for each coordinate"
            ),
            Self::FieldLength { field, found, expected, of } => {
                write!(
                    f,
                    "the field `{field}` has {found} elements, and `{of}` is {expected}: give it {expected}"
                )
            }
            Self::FieldIndex { field, entry, index, length } => write!(
                f,
                "entry {entry} of `{field}` is {index}, and there are {length}: indices, like entries, count from 0"
            ),
            Self::ElementMissing { array, index, from, to } => write!(
                f,
                "`{array}[{index}]` does not exist: the indices of `{array}` are {from}..{to}; let the range end before it, or give the array more elements"
            ),
            Self::ParameterNotAsSaid { name, wanted, defect } if !defect.is_finite() => {
                write!(f, "the parameter `{name}` is not {wanted}: one of its entries is not finite")
            }
            Self::ParameterNotAsSaid { name, wanted, defect } => {
                write!(f, "the parameter `{name}` is not {wanted}: it is off by {defect:.1e} of its size")
            }
            Self::ParameterNotFinite { name, value } => {
                write!(
                    f,
                    "the parameter `{name}` is {value}: every parameter in the equations must be finite"
                )
            }
            Self::ZeroQuaternion { name } => write!(
                f,
                "the quaternion `{name}` is zero, which is no rotation: its length must be 1; for no turn at all set `{name}[0]` to 1"
            ),
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
            Self::Setting { name, value } if *value > 0.0 && value.is_finite() => {
                write!(f, "the {name} is {value:e}: times this near are not told apart; make it longer")
            }
            Self::Setting { name, value } => {
                write!(f, "the {name} is {value}: it must be positive and finite")
            }
            Self::EndNotFinite { end } => write!(f, "cannot integrate to t = {end}: the end must be finite"),
            Self::Unfinished(ending) => write!(f, "{ending}"),
            Self::Singular { coordinates, time } => write!(
                f,
                "the equations do not determine the acceleration of {coordinates} at t = {time}: give each a mass or constrain it, or start beside a pole of the angles"
            ),
            Self::Contradictory { constraint, time } => write!(
                f,
                "constraint `{constraint}` contradicts the others at t = {time}: no accelerations satisfy all; remove it or make it agree"
            ),
            Self::Inconsistent { constraint, rate, residual, time } => write!(
                f,
                "the state violates {constraint} at t = {time}: its {} is {residual:e}, not 0; call `{}` first",
                if *rate { "rate F q_dot + b" } else { "residual" },
                if let Row::WrittenConstraint(_) = constraint { "project" } else { "make_consistent" }
            ),
            Self::NoGradient { constraint, time } => write!(
                f,
                "the gradient of {constraint} vanishes at t = {time}, where it holds, so that it fixes no acceleration; write it by a function that changes sign there, as `sin(a) = 0` for `cos(a) = 1` or `x - y = 0` for `(x - y)^2 = 0`, or leave it out if others imply it, or the parameters alone; if it vanishes at this pose alone, start beside it"
            ),
            Self::Dependent { constraint, time } => write!(
                f,
                "{constraint} depends on others at t = {time}, so that its multiplier is not determined; leave out a constraint that others imply, check that all can hold together and that no mass is 10⁷ times another, or start beside a pose like this one"
            ),
            Self::DependentToFirstOrder { constraints, time } => write!(
                f,
                "constraints {constraints} depend on one another at t = {time} to first order, but not to second, so that they do not determine the accelerations; if they do wherever they hold, they hide a square, as those of |a| = l, |b| = l, |a - b| = 2l hide |a + b|^2 = 0: write its root `a + b = 0` in place of one of them; if at this pose alone, where branches of the motion meet, start beside it"
            ),
            Self::UnboundedMultipliers { constraints, time } => write!(
                f,
                "the multipliers of {constraints} grow without bound towards t = {time}, a pose at which constraints depend on one another, so that no bounded force keeps them; end the motion before it, or give a joint play or a spring"
            ),
            Self::Conflicting { constraints, distance, time } => write!(
                f,
                "the constraints {constraints} conflict near the state given at t = {time}: at best they miss by {distance:.3e}, a distance; change what one of them demands, leave one out, or guess elsewhere"
            ),
            Self::NotProjected { constraint, residual, iterations, time } => write!(
                f,
                "no consistent state found near the one given at t = {time}: {constraint} has residual {residual:e} after {iterations} iterations; start closer to the constraints, or check that they can hold together"
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
            Self::NoEquilibrium { row, residual, iterations, best, time } => write!(
                f,
                "no equilibrium found near the state given at t = {time}: the row of {row} leaves {residual:e} after {iterations} steps, at {}; start closer, or let other coordinates, velocities or parameters change",
                joined(best)
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
                "these accelerations violate {row} at t = {time}: F q_ddot + gamma is {residual:e}, not 0; hold those of fewer coordinates, and `complete_accelerations` gives the others"
            ),
            Self::AccelerationsNotUnique { coordinates, time } => write!(
                f,
                "the constraints and the accelerations that are held do not determine those of {coordinates} at t = {time}: hold one of these too"
            ),
            Self::NotInertial { row, residual, time } => write!(
                f,
                "the generalized forces are not linear in the masses, first moments and inertias of these bodies at t = {time}: the row of {row} differs by {residual:e}; name bodies whose members `m`, `centre` and `inertia` enter by `kinetic` and by their weight alone"
            ),
            Self::LocalChange { found, expected } => write!(
                f,
                "the change has {found} entries, and the state {expected} local coordinates: `local_coordinates` has their names"
            ),
            Self::LocalChangeNotFinite { coordinate } => {
                write!(f, "the change of {coordinate} is infinite or NaN: every entry must be finite")
            }
            Self::OtherBodies => {
                write!(f, "these regressors are of different bodies: ask for all with the same names")
            }
            Self::BaseParametersUndecided { parameter, left } => write!(
                f,
                "it is not decided whether {parameter} is a base parameter: {left:e} of its column is left beside those before it; give more states, with joints and velocities that vary more"
            ),
            Self::InputsNotUnique { inputs, time } => {
                write!(f, "many values of {inputs} give these accelerations at t = {time}: name fewer inputs")
            }
            Self::EigenvaluesNotFound => write!(
                f,
                "the eigenvalues or singular values of a matrix were not found: check that its entries are finite, and the scales of the parameters"
            ),
            Self::UnknownName { name, kind, hint: Some(hint), .. } => {
                write!(f, "there is no {kind} `{name}`: {hint}")
            }
            Self::UnknownName { name, kind, hint: None, known } => {
                write!(f, "there is no {kind} `{name}`; {}", said_of(name, known))
            }
            Self::RepeatedName { name } => write!(f, "`{name}` is given twice: give each entry once"),
            Self::SampleTime { index, time } => write!(
                f,
                "the sample time {index} (counted from 0) is {time}: give finite times in the order of the motion"
            ),
            Self::Orbit(error) => write!(f, "{error}"),
            Self::Ensemble(error) => write!(f, "{error}"),
            Self::Restitution { constraint, value } => write!(
                f,
                "the coefficient of restitution of `{constraint}` is {value}: give it one from 0, where the bodies stay together, to 1, where they lose no energy"
            ),
            Self::ClosedApart { contact, rate, residual, time } => write!(
                f,
                "contact `{contact}` is stated as closed, but its {} is {residual:e} at t = {time}: set the field `{contact}` to `Contact::Open`, and the motion closes it where the bodies touch",
                if *rate { "gap changes: its rate" } else { "gap" }
            ),
            Self::ImpactLaw { contact } => write!(
                f,
                "contact `{contact}` has Poisson's law of impact, but time stepping only Newton's: move by `with_contacts()`, or state `restitution: e`"
            ),
            Self::Penetration { contact, gap, time } => write!(
                f,
                "the gap of contact `{contact}` is {gap:e} at t = {time}: start where no gap is negative, change no parameter so that one becomes negative, and if a motion came here, take shorter steps, so that no contact is passed within one"
            ),
            Self::ContactsContradict { contacts, time } => write!(
                f,
                "no forces keep the gaps of {contacts} open at t = {time}: they close in on one another, so make one of them yield"
            ),
            Self::FrictionJams { friction, time } => write!(
                f,
                "with `{friction}` no force that presses the bodies together goes with any acceleration at t = {time} (Painlevé's paradox): the friction makes the contact dig in, so lower its coefficient, or let one of the bodies yield"
            ),
            Self::FrictionUndecided { friction, time } => write!(
                f,
                "the force of `{friction}` at t = {time} could not be decided: several contacts or velocities of one body share it; take time steps, which share it among all of them, or state fewer contacts, as one foot in the place of two"
            ),
            Self::Friction { friction, bounds: [limit, sliding], time } => write!(
                f,
                "the friction of `{friction}` at t = {time} has {limit} at rest, the limit or the static coefficient, and {sliding} where it slides: both must be numbers, and 0 ≤ sliding ≤ limit"
            ),
            Self::ImpulsesNotFound { friction, time } => write!(
                f,
                "no impulses of `{friction}` and the contacts beside it were found in the step at t = {time}: take shorter steps, or state fewer contacts, as one foot in the place of two"
            ),
            Self::StepTooLong { residual, iterations, time } => write!(
                f,
                "the forces change too much within the step from t = {time}: after {iterations} iterations the balance of momentum is off by {residual:.1e} of its largest term; take shorter steps"
            ),
            Self::Theta { value } => {
                write!(f, "the part θ of a time step is {value}: it must be from 0.5 to 1")
            }
            Self::ImpactsDoNotEnd { time } => write!(
                f,
                "impacts follow one another without end at t = {time}: give the contacts that touch a lower restitution, below 1, or none where one body is much lighter than those beside it"
            ),
            Self::MotionBackwards { start, end } => write!(
                f,
                "a motion with contacts cannot go back from t = {start} to {end}: impacts do not determine what was before them"
            ),
            Self::LegApart { start, end, expected } => write!(
                f,
                "the leg from t = {start} to {end} does not go on from t = {expected}, where the hybrid trajectory has come to: start it there, and lead it the same way in time"
            ),
            Self::EventNotFinite { event, time } => write!(
                f,
                "the function of the event `{event}` is not a number at t = {time}: make it one wherever the motion may lead"
            ),
            Self::EventInTimeSteps { event, time } => write!(
                f,
                "the function of the event `{event}` is not a number at t = {time}: by time steps, an event must not depend on accelerations or multipliers, which are means over a step; take samples with these as quantities, by `every` and `quantity`"
            ),
            Self::NoDerivativeAcross { contact, time, reason } => write!(
                f,
                "the motion has no derivative across the transition of `{contact}` at t = {time}: {reason}"
            ),
            Self::Grazing { event, time } => write!(
                f,
                "the motion grazes the event `{event}` at t = {time}: the rate of its function is zero there to round-off, and the event has no derivative; start so that it is crossed, or missed"
            ),
            Self::OutsideTrajectory { time, start, .. } if start.is_nan() => {
                write!(f, "there is no state at t = {time}: the trajectory has no legs yet")
            }
            Self::OutsideTrajectory { time, start, end } => {
                write!(f, "t = {time} lies outside the trajectory, which covers {start} to {end}")
            }
        }
    }
}

/// Prints the sentence of `Display`, since `main` prints a returned error by `Debug`. Programs tell errors
/// apart by their fields.
impl Debug for Error {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        Display::fmt(self, f)
    }
}

/// Serializes an error as the text of its `Display`.
#[cfg(feature = "serde")]
impl serde::Serialize for Error {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use alloc::{format, string::ToString};

    use super::*;
    use crate::error::Ending;

    /// `main` and `unwrap` print an error by `Debug`.
    #[test]
    fn errors_and_endings_are_debugged_as_sentences() {
        let apart = Error::LegApart { start: 0.5, end: 1.0, expected: 0.25 };
        let ending = Ending::TimeTooCoarse { time: 2.0, step: 1e-17 };
        assert_eq!(
            format!("{apart:?}"),
            "the leg from t = 0.5 to 1 does not go on from t = 0.25, where the hybrid trajectory has come to: start it there, and lead it the same way in time"
        );
        assert_eq!([format!("{apart:?}"), format!("{ending:#?}")], [apart.to_string(), ending.to_string()]);
    }
}
