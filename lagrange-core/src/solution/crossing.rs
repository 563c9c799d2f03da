//! Crossings of events that a trajectory stores.

use crate::system::State;
use crate::vector::{Element, Length};

/// A located crossing of an event.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(bound(serialize = "T: nalgebra::Scalar + serde::Serialize"))
)]
pub struct Crossing<T: Element, N: Length> {
    /// Name of the event.
    pub event: &'static str,
    /// Index of the event, in the order in which the events were given.
    pub index: usize,
    /// Number of this crossing among those of the event, counted from 1.
    pub count: usize,
    /// True if the event function rises through zero, false if it falls.
    pub rising: bool,
    /// State at the crossing.
    pub state: State<T, N>,
}

impl<T: Element, N: Length> Copy for Crossing<T, N> where State<T, N>: Copy {}
