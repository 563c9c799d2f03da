//! Motions in lock-step: each lane a motion with its own time, step and ending.

use core::array::from_fn;
use core::marker::PhantomData;
use core::ops::ControlFlow;

use super::{Fate, LaneMethod, Seat, Seats};
use crate::ending::Ending;
use crate::motion::event::Stride;
use crate::number::{Lanes, vector};
use crate::solution::flow::{LagrangianFlow, Phase};
use crate::system::{Lagrangian, State};

/// Motions in lock-step.
pub(crate) struct Batch<'o, L, P, const N: usize, const M: usize>
where
    L: Lagrangian<N, M, Scalar = f64>,
    P: LaneMethod<L, N, M>,
{
    method: &'o P,
    abreast: P::LaneMemory,
    seats: Seats<'o, L, P, N, M>,
}

impl<'o, L, P, const N: usize, const M: usize> Batch<'o, L, P, N, M>
where
    L: Lagrangian<N, M, Scalar = f64>,
    P: LaneMethod<L, N, M>,
{
    /// With a first motion, and the other lanes free.
    pub(crate) fn new(method: &'o P, seat: Seat<'o, L, P, N, M>) -> Self {
        let abreast = method.abreast(&seat.system, &seat.memory);
        let mut seats = [const { None }; Lanes::COUNT];
        seats[0] = Some(seat.begin(method));
        Self { method, abreast, seats }
    }

    pub(crate) fn has_free_lane(&self) -> bool {
        self.seats.iter().any(Option::is_none)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.seats.iter().all(Option::is_none)
    }

    /// Gives the motion a free lane; gives it back where there is none that it fits in.
    pub(crate) fn join(&mut self, seat: Seat<'o, L, P, N, M>) -> Option<Seat<'o, L, P, N, M>> {
        let lane = self.seats.iter().position(Option::is_none);
        match lane.filter(|&lane| P::place(&mut self.abreast, lane, &seat.system)) {
            None => Some(seat),
            Some(lane) => {
                self.seats[lane] = Some(seat.begin(self.method));
                self.load(lane);
                None
            }
        }
    }

    /// Tries one step in every lane. `accept` is told each new state; `leave` each motion that has ended.
    /// Where nothing is to be looked for within steps, and `IS_WATCHED` is false, nothing of that is compiled.
    pub(crate) fn step<const IS_WATCHED: bool>(
        &mut self,
        mut accept: impl FnMut(usize, &State<f64, N>) -> ControlFlow<()>,
        mut leave: impl FnMut(Seat<'o, L, P, N, M>, State<f64, N>, Ending),
    ) {
        let starts = self.seats.each_ref().map(|seat| seat.as_ref().map_or(0.0, Seat::now));
        let fates = self.method.attempt::<IS_WATCHED>(&mut self.abreast, &mut self.seats);
        let fates = from_fn(|lane| fates[lane].unwrap_or_else(|| self.step_alone::<IS_WATCHED>(lane)));
        let before = from_fn::<_, { Lanes::COUNT }, _>(|lane| {
            if const { IS_WATCHED } { Some(state(P::phase(&self.abreast, lane), starts[lane])) } else { None }
        });
        self.settle(&fates);
        for (lane, fate) in fates.into_iter().enumerate() {
            let Some(now) = self.seats[lane].as_ref().map(Seat::now) else { continue };
            let mut state = match fate {
                Fate::Accepted => state(P::reached(&self.abreast, lane), now),
                _ => state(P::phase(&self.abreast, lane), now),
            };
            let is_accepted = fate != Fate::Rejected;
            let before = before[lane].as_ref().filter(|_| is_accepted);
            let stopped = before.and_then(|before| self.keep(lane, before, &mut state));
            let Some(seat) = &self.seats[lane] else { continue };
            let mut is_cancelled = || is_accepted && accept(seat.index, &state).is_break();
            let mut ending = match stopped {
                None if is_cancelled() => Some(Ending::Cancelled { time: state.t }),
                stopped => stopped,
            };
            if const { IS_WATCHED } && ending.is_none() {
                ending = self.control(lane, &state);
            }
            if let Some(ending) = ending.or_else(|| self.ending(lane))
                && let Some(seat) = self.seats[lane].take()
            {
                leave(seat, state, ending);
            }
        }
    }

    /// The step of a lane by the scalar method. None is taken in a free one.
    #[cold]
    fn step_alone<const IS_WATCHED: bool>(&mut self, lane: usize) -> Fate {
        let Some(seat) = &mut self.seats[lane] else { return Fate::Rejected };
        P::unload(&self.abreast, lane, &mut seat.memory);
        seat.step_alone::<IS_WATCHED>(self.method)
    }

    /// Moves the lanes whose steps are accepted.
    fn settle(&mut self, fates: &[Fate; Lanes::COUNT]) {
        let chosen = fates.map(|fate| if fate == Fate::Accepted { 1.0 } else { 0.0 });
        P::settle(&mut self.abreast, chosen.into());
        for lane in (0..Lanes::COUNT).filter(|lane| fates[*lane] == Fate::AcceptedAlone) {
            self.load(lane);
        }
    }

    /// Keeps what is due in an accepted step to `end`; where the motion stops before, that is then the end, and why.
    fn keep(&mut self, lane: usize, before: &State<f64, N>, end: &mut State<f64, N>) -> Option<Ending> {
        let Seat { record, system, within, .. } = self.seats[lane].as_mut()?;
        if !record.looks_into(before.t, end.t) {
            return None;
        }
        let (after, flow) = (&{ *end }, PhantomData::<LagrangianFlow>);
        match within.take() {
            Some(interpolant) => {
                let interpolant = &interpolant;
                record.keep(&Stride { system, before, after, interpolant, flow }, end)
            }
            None => {
                let interpolant = &P::within(&self.abreast, lane);
                record.keep(&Stride { system, before, after, interpolant, flow }, end)
            }
        }
    }

    /// Calls the controller of a member, where it is due; the ending, where that is one.
    fn control(&mut self, lane: usize, state: &State<f64, N>) -> Option<Ending> {
        let seat = self.seats[lane].as_mut().filter(|seat| seat.record.is_due(state.t))?;
        if let Err(ending) = seat.control(state, self.method) {
            return Some(ending);
        }
        if !P::place(&mut self.abreast, lane, &seat.system) {
            let said = "it changes a field that is no number, which all lanes share".into();
            return Some(Ending::ControllerFailed { time: state.t, said });
        }
        self.load(lane);
        None
    }

    /// Why there is no further step to take in a lane.
    fn ending(&mut self, lane: usize) -> Option<Ending> {
        let abreast = &self.abreast;
        self.seats[lane].as_mut()?.ending(self.method, |memory| P::unload(abreast, lane, memory))
    }

    /// Puts where its motion is into a lane.
    fn load(&mut self, lane: usize) {
        if let Some(seat) = &self.seats[lane] {
            P::load(&mut self.abreast, lane, &seat.memory);
        }
    }
}

fn state<const N: usize>([q, v]: Phase<f64, N>, t: f64) -> State<f64, N> {
    State { t, q: vector(q), v: vector(v) }
}
