//! What errors hold on the heap.

mod ensemble;
pub(crate) mod similar;

use alloc::boxed::Box;
use alloc::format;
use alloc::vec::Vec;
use core::fmt::Display;

use super::{Ending, Error};

pub(super) use alloc::string::String;
pub use ensemble::EnsembleError;
use similar::listed;

/// Several texts.
pub(super) type Strings = Vec<String>;
/// The ending of a motion, which may hold an error in its turn.
pub(super) type BoxedEnding = Box<Ending>;
/// The error of a search of a periodic orbit.
pub(super) type BoxedOrbitError = Box<crate::orbits::OrbitError>;

/// Joins texts by commas.
pub(super) fn joined(texts: &[String]) -> impl Display {
    texts.join(", ")
}

/// Says which names are known, the most similar to `name` first.
pub(super) fn said_of(name: &str, known: &[String]) -> impl Display {
    match known {
        [] => "the system has none".into(),
        _ => format!("there are {}", listed(name, known)),
    }
}

/// Lets `?` convert the [`Ending`] of a failed [`Motion`](crate::Motion) into an [`Error`].
impl From<Ending> for Error {
    fn from(ending: Ending) -> Self {
        Self::Unfinished(Box::new(ending))
    }
}
