//! Reasons why a system does not become a model.

use std::error::Error;
use std::fmt::{self, Display, Formatter};

use lagrange_derive::Unsupported;

/// Reason why a system with these parameters does not move.
///
/// ```
/// use lagrange_interpreter::{Model, System};
///
/// let text = "#[coordinates(x)] #[lagrangian(mass/2*x_dot^2 - k/2*x^2)] struct Spring { mass: f64, k: f64 }";
/// let error = Model::new(&System::parse(text)?, [("masss", 1.0), ("k", f64::NAN)]).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "the equations contain no parameter `masss`: did you mean `mass`?\n\
///      the parameter `k` is NaN: give a finite number\n\
///      the parameter `mass` has no value"
/// );
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum ModelError {
    /// The system has parts that are not evaluated without a compiler.
    Unsupported(Unsupported),
    /// All errors in the parameters.
    Parameters(Vec<ParameterError>),
}

/// Error in a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum ParameterError {
    /// A parameter has no value.
    Missing {
        /// Its name.
        name: String,
    },
    /// No parameter has this name.
    Unknown {
        /// The name given.
        name: String,
        /// A similar name of a parameter.
        similar: Option<String>,
    },
    /// A parameter has two values.
    Repeated {
        /// Its name.
        name: String,
    },
    /// An array has another number of entries.
    Count {
        /// Name of the field.
        name: String,
        /// Entries given.
        found: usize,
        /// Entries of the field.
        expected: usize,
    },
    /// A value is infinite or NaN.
    NotFinite {
        /// Name of the parameter.
        name: String,
        /// Its value.
        value: f64,
    },
    /// A matrix that is declared symmetric is not.
    Asymmetric {
        /// Name of the field.
        name: String,
    },
}

impl Display for ParameterError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { name } => write!(f, "the parameter `{name}` has no value"),
            Self::Unknown { name, similar } => {
                write!(f, "the equations contain no parameter `{name}`")?;
                similar.iter().try_for_each(|similar| write!(f, ": did you mean `{similar}`?"))
            }
            Self::Repeated { name } => write!(f, "the parameter `{name}` has two values"),
            Self::Count { name, found, expected } => {
                write!(f, "the field `{name}` has {expected} entries, not {found}")
            }
            Self::NotFinite { name, value } => {
                write!(f, "the parameter `{name}` is {value}: give a finite number")
            }
            Self::Asymmetric { name } => write!(f, "the matrix `{name}` is declared symmetric, and is not"),
        }
    }
}

impl Display for ModelError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsupported(unsupported) => unsupported.fmt(f),
            Self::Parameters(errors) => errors.iter().enumerate().try_for_each(|(number, error)| {
                f.write_str(if number == 0 { "" } else { "\n" })?;
                error.fmt(f)
            }),
        }
    }
}

impl Error for ParameterError {}

impl Error for ModelError {}

impl From<Unsupported> for ModelError {
    fn from(unsupported: Unsupported) -> Self {
        Self::Unsupported(unsupported)
    }
}

impl From<Vec<ParameterError>> for ModelError {
    fn from(errors: Vec<ParameterError>) -> Self {
        Self::Parameters(errors)
    }
}
