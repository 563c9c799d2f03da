//! What Taylor's method carries from step to step.

use super::crossing::SingularStep;
use super::expansion::{Expansion, SolvedState};
use super::sampling::Sampling;
use crate::motion::method::clock::Clock;
use crate::system::State;

/// What Taylor's method carries from step to step.
#[derive(Clone, Debug)]
pub struct TaylorMemory<S, T, const N: usize, const M: usize> {
    pub(crate) clock: Clock<T>,
    pub(crate) state: State<T, N>,
    pub(crate) solved: SolvedState<T, N, M>,
    /// What rounding has left of the state: coordinates and velocities.
    pub(super) rest: [[T; N]; 2],
    /// About the state, or about where the last step started.
    pub(crate) series: Expansion<S, T, N>,
    pub(super) is_expanded: bool,
    /// The length of the next step; zero before the motion begins.
    pub(crate) planned: T,
    pub(super) sampling: Sampling<T>,
    /// Where the step is summed by fewer orders.
    pub(super) crossing: Option<SingularStep<T>>,
    /// What was known where the step taken last starts.
    pub(super) before: Option<Before<T, N, M>>,
}

/// What is known of a state beside its series.
#[derive(Clone, Debug)]
pub(super) struct Before<T, const N: usize, const M: usize> {
    pub(super) solved: SolvedState<T, N, M>,
    pub(super) rest: [[T; N]; 2],
    pub(super) sampling: Sampling<T>,
}
