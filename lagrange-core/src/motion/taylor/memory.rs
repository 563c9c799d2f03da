//! State that Taylor's method carries from step to step.

use super::expansion::{Expansion, SolvedState};
use super::sampling::Sampling;
use crate::motion::method::clock::Clock;
use crate::system::State;
use crate::vector::{Array, Element, StaticLength};

/// State that Taylor's method carries from step to step.
#[derive(Clone, Debug)]
pub struct TaylorMemory<S, T: Element, N: StaticLength, M: StaticLength> {
    pub(crate) clock: Clock<T>,
    pub(crate) state: State<T, N>,
    pub(crate) solved: SolvedState<T, N, M>,
    /// Compensation terms of coordinates and velocities: the rounding errors of `state`.
    pub(super) rest: [Array<T, N>; 2],
    /// Expansion about `state`; before it is expanded, about the start of the last step.
    pub(crate) series: Expansion<S, T, N>,
    pub(super) is_expanded: bool,
    /// Length of the next step; zero before the motion begins.
    pub(crate) planned: T,
    pub(super) sampling: Sampling<T>,
    /// Data of the start of the last accepted step, to undo the step.
    pub(super) before: Option<Before<T, N, M>>,
}

/// Data of a state that its series does not contain.
#[derive(Clone, Debug)]
pub(super) struct Before<T: Element, N: StaticLength, M: StaticLength> {
    pub(super) solved: SolvedState<T, N, M>,
    pub(super) rest: [Array<T, N>; 2],
    pub(super) sampling: Sampling<T>,
}
