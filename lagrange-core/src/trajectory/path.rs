//! Accepted steps of a motion, with dense output.

use alloc::boxed::Box;
use alloc::vec::Vec;

use crate::number::Real;
use crate::room::Room;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::StagePoint;
use crate::system::State;
use crate::vector::{Element, Length};

/// States at the ends of the steps, and the interpolants between them. The type of the interpolants depends on
/// the method; [`finish`](Path::finish) erases it.
pub(crate) struct Path<T: Element, N: Length, S = Box<dyn Interpolants<T, N> + Send + Sync>> {
    pub(super) start: Room<State<T, N>>,
    pub(super) last: Room<State<T, N>>,
    /// Start times of the steps.
    times: Vec<T>,
    interpolants: S,
}

/// Interpolants of steps 0, 1, ….
pub(crate) trait Interpolants<T: Element, N: Length> {
    /// Returns the point of the phase space at a time within this step.
    fn at(&self, step: usize, t: T) -> Option<StagePoint<T, N>>;
}

impl<T: Element, N: Length, I: Interpolant<T, N>> Interpolants<T, N> for Vec<I> {
    fn at(&self, step: usize, t: T) -> Option<StagePoint<T, N>> {
        self.get(step).map(|interpolant| interpolant.at(t))
    }
}

/// A time step between two states. Coordinates and velocities are linear in between.
pub(crate) struct Chord<T: Element, N: Length>(pub(crate) [State<T, N>; 2]);

impl<T: Real, N: Length> Interpolant<T, N> for Chord<T, N> {
    const IS_PROJECTED: bool = false;

    fn at(&self, t: T) -> StagePoint<T, N> {
        let Self([before, after]) = self;
        let part = (t - before.t) / (after.t - before.t);
        let between = |x: T, y: T| x + part * (y - x);
        StagePoint::of(&State { t, ..before.each_with(after, between) })
    }
}

impl<T: Real, N: Length, I: Interpolant<T, N> + Send + Sync + 'static> Path<T, N, Vec<I>> {
    pub(crate) fn from(start: State<T, N>) -> Self {
        Self {
            start: Room::of(start.clone()),
            last: Room::of(start),
            times: Vec::new(),
            interpolants: Vec::new(),
        }
    }

    /// Returns the start time.
    pub(crate) fn start(&self) -> T {
        self.start.t
    }

    /// Returns the interpolants; that of the next step is stored here before the step is [pushed](Self::push).
    #[inline(always)]
    pub(crate) fn interpolants(&mut self) -> &mut Vec<I> {
        &mut self.interpolants
    }

    /// Appends the step that ends at `state`. Its interpolant is already stored.
    #[inline(always)]
    pub(crate) fn push(&mut self, state: State<T, N>) {
        self.times.push(self.last.t);
        *self.last = state;
    }

    /// Returns the interpolant of the last step.
    pub(crate) fn last_step(&self) -> Option<&I> {
        self.interpolants.last()
    }

    /// Ends the path at `end`, within the last step or at its start.
    pub(crate) fn cut(&mut self, end: State<T, N>) {
        if self.times.last() == Some(&end.t) {
            self.times.pop();
            self.interpolants.truncate(self.times.len());
        }
        *self.last = end;
    }

    pub(crate) fn finish(self) -> Path<T, N> {
        let Self { start, last, times, interpolants } = self;
        Path { start, last, times, interpolants: Box::new(interpolants) }
    }
}

impl<T: Element, N: Length> Path<T, N> {
    /// Returns the number of steps.
    pub(super) fn len(&self) -> usize {
        self.times.len()
    }
}

impl<T: Real, N: Length> Path<T, N> {
    /// Returns the step of a motion forwards that ends at a time or after it; at the start, the first.
    pub(super) fn step_until(&self, t: T) -> usize {
        self.times.partition_point(|start| *start < t).saturating_sub(1)
    }

    /// Returns the point of the phase space at the start of a step.
    pub(super) fn start_of(&self, step: usize) -> Option<StagePoint<T, N>> {
        self.interpolants.at(step, *self.times.get(step)?)
    }

    /// Returns the point of the phase space at a time; `None` before the start, and from the time of the last
    /// state on.
    pub(super) fn at(&self, t: T) -> Option<StagePoint<T, N>> {
        // Backwards in time, the negated times are sorted.
        let backwards = self.last.t < self.start.t;
        let directed = |t: T| if backwards { -t } else { t };
        if !(directed(t) >= directed(self.start.t) && directed(t) < directed(self.last.t)) {
            return None;
        }
        let step = self.times.partition_point(|start| directed(*start) <= directed(t)).checked_sub(1)?;
        self.interpolants.at(step, t)
    }
}
