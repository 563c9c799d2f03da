//! Crossings of events: what a trajectory keeps of them.

use crate::system::State;

/// A crossing that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "T: nalgebra::Scalar + serde::Serialize")))]
pub struct Crossing<T, const N: usize> {
    /// The name of the event.
    pub event: &'static str,
    /// The place of the event among those given.
    pub index: usize,
    /// Which crossing of this event it is, counted from 1.
    pub count: usize,
    /// Whether the function grows through zero there (else it falls).
    pub rising: bool,
    /// The state there.
    pub state: State<T, N>,
}
