//! Systems that tapes do not describe.

use std::error::Error;
use std::fmt::{self, Display, Formatter};

use quote::ToTokens;

use crate::resolve::Problem;
use crate::syntax::Property;

/// Reason why a system has no [tapes](crate::System::tapes). Its equations and facts are known all the same, and `#[derive(Lagrangian)]`
/// moves it.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unsupported {
    /// A constraint that opens and closes, as a contact, friction or a switched constraint does; the field that says which.
    Switched(String),
    /// The length of an array is a field.
    OpenLength(String),
    /// A function that the user supplies in Rust.
    Function(String),
    /// The numbers are of another type than `f64`.
    Scalar(String),
    /// A field that has to be a rotation or a unit quaternion: its values are not checked here.
    Rotation(String),
}

impl Unsupported {
    /// The first reason that applies to a system.
    pub(crate) fn of(problem: &Problem) -> Option<Self> {
        let parameters = &problem.parameters;
        if problem.many.is_open() {
            let name = problem.many.lengths.first().map_or(String::new(), |length| length.name.clone());
            return Some(Self::OpenLength(name));
        }
        if let Some(function) = problem.functions.first() {
            return Some(Self::Function(function.name.clone()));
        }
        if !parameters.switches.is_empty() {
            return Some(Self::Switched(parameters.name_of_switch(0)));
        }
        let scalar = problem.scalar.to_token_stream().to_string();
        if scalar != "f64" {
            return Some(Self::Scalar(scalar));
        }
        let is_rotation = |field| {
            parameters.property(field) == Some(Property::Rotation) || parameters.is_unit_quaternion(field)
        };
        let rotation = parameters.entries.iter().find(|entry| is_rotation(entry.field));
        rotation.map(|entry| Self::Rotation(parameters.fields[entry.field].text()))
    }
}

impl Display for Unsupported {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Switched(field) => {
                write!(
                    f,
                    "`{field}` opens and closes a constraint: contacts, friction and switched constraints"
                )
            }
            Self::OpenLength(length) => {
                write!(f, "the length `{length}` is known only when the program runs: such systems")
            }
            Self::Function(name) => write!(f, "`{name}` is a function written in Rust: such systems"),
            Self::Scalar(scalar) => {
                write!(f, "the numbers are of the type `{scalar}`: systems of another type than `f64`")
            }
            Self::Rotation(matrix) => write!(f, "`{matrix}` has to be a rotation: such systems"),
        }?;
        f.write_str(" are not evaluated without a compiler; `#[derive(Lagrangian)]` compiles them")
    }
}

impl Error for Unsupported {}
