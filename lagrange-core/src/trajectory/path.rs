//! The accepted steps, and what lies between them.

use alloc::boxed::Box;
use alloc::vec::Vec;

use crate::number::Real;
use crate::room::Room;
use crate::solution::crossing::Crossing;
use crate::solution::interpolant::Interpolant;
use crate::solution::vector_field::StagePoint;
use crate::system::State;

/// The states at the ends of the steps, and the interpolants between them: those of one method, whose type is
/// forgotten when it is finished.
pub(crate) struct Path<T, const N: usize, S = Box<dyn Interpolants<T, N> + Send + Sync>> {
    pub(super) start: Room<State<T, N>>,
    pub(super) last: Room<State<T, N>>,
    /// Where events were on the way.
    pub(crate) crossings: Vec<Crossing<T, N>>,
    /// The times at the starts of the steps.
    times: Vec<T>,
    interpolants: S,
}

/// The interpolants of steps 0, 1, …
pub(crate) trait Interpolants<T, const N: usize> {
    /// The place at a time within this step.
    fn at(&self, step: usize, t: T) -> Option<StagePoint<T, N>>;
}

impl<T, const N: usize, I: Interpolant<T, N>> Interpolants<T, N> for Vec<I> {
    fn at(&self, step: usize, t: T) -> Option<StagePoint<T, N>> {
        self.get(step).map(|interpolant| interpolant.at(t))
    }
}

impl<T: Real, const N: usize, I: Interpolant<T, N> + Send + Sync + 'static> Path<T, N, Vec<I>> {
    pub(crate) fn from(start: State<T, N>) -> Self {
        Self {
            start: Room::of(start),
            last: Room::of(start),
            crossings: Vec::new(),
            times: Vec::new(),
            interpolants: Vec::new(),
        }
    }

    /// When it starts.
    pub(crate) fn start(&self) -> T {
        self.start.t
    }

    /// Where the interpolant of the next step is put, before the step is [pushed](Self::push).
    #[inline(always)]
    pub(crate) fn interpolants(&mut self) -> &mut Vec<I> {
        &mut self.interpolants
    }

    /// A step to this state, whose interpolant is there.
    #[inline(always)]
    pub(crate) fn push(&mut self, state: State<T, N>) {
        self.times.push(self.last.t);
        *self.last = state;
    }

    /// What lies within the last step, and where crossings within it belong.
    pub(crate) fn last_step(&mut self) -> Option<(&I, &mut Vec<Crossing<T, N>>)> {
        Some((self.interpolants.last()?, &mut self.crossings))
    }

    /// Ends within the last step, or where it starts.
    pub(crate) fn cut(&mut self, end: State<T, N>) {
        if self.times.last() == Some(&end.t) {
            self.times.pop();
            self.interpolants.truncate(self.times.len());
        }
        *self.last = end;
    }

    pub(crate) fn finish(self) -> Path<T, N> {
        let Self { start, last, crossings, times, interpolants } = self;
        Path { start, last, crossings, times, interpolants: Box::new(interpolants) }
    }
}

impl<T: Real, const N: usize> Path<T, N> {
    /// Where step `step` starts.
    pub(super) fn start_of(&self, step: usize) -> Option<StagePoint<T, N>> {
        self.interpolants.at(step, *self.times.get(step)?)
    }

    /// `None` before the start and from the last state on.
    pub(super) fn at(&self, t: T) -> Option<StagePoint<T, N>> {
        // Backwards, times are sorted by their negatives.
        let backwards = self.last.t < self.start.t;
        let directed = |t: T| if backwards { -t } else { t };
        if !(directed(t) >= directed(self.start.t) && directed(t) < directed(self.last.t)) {
            return None;
        }
        let step = self.times.partition_point(|start| directed(*start) <= directed(t)).checked_sub(1)?;
        self.interpolants.at(step, t)
    }
}
