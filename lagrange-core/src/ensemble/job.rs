//! Runs an ensemble: hands out members, records their results, and stops.

#[cfg(feature = "mpi")]
mod batch;

use core::ops::ControlFlow;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::fingerprint::Fingerprint;
use super::names::ColumnNames;
use super::outcome::{Member, Outcome};
use super::plan::{EnsembleProgress, Make, MemberObserver, MemberPlan, Plan, Watch};
use super::row::{MemberRow, TWO_RESULTS};
use crate::error::{Ending, EnsembleError, Error};
use crate::generic::{Element, Length, State};
use crate::motion::integration::progress::unless_broken;
use crate::motion::integration::record::{Moving, Recorded};
use crate::motion::lanes::{Batch, LaneMotion};
use crate::motion::run::{Run, Watchdog};
use crate::motion::{Arrival, LaneMethod, Method, Simulate, SystemChecks};
use crate::number::Real;
use crate::solution::system_checks::ChecksOf;
use crate::{Lagrangian, StateOf};

/// State of a running ensemble, shared by all threads.
pub(super) struct Job<'a, L: Simulate> {
    pub(super) make: Make<'a, L>,
    observer: Option<MemberObserver<'a, L>>,
    pub(super) member_plan: Arc<MemberPlan<'a, L>>,
    pub(super) names: Arc<ColumnNames>,
    pub(super) end: L::Scalar,
    /// Fingerprint of the run, common to all members.
    pub(super) run: Fingerprint,
    part: Part,
    /// Indices of the members whose rows were taken over from an earlier run.
    done: BTreeSet<usize>,
    /// Number of members of this part handed out so far.
    given: AtomicUsize,
    stopped: AtomicBool,
    ledger: Mutex<Ledger<'a, L::Scalar, L::Length>>,
}

/// Members to integrate: all `count`, or those of `list`, divided into `shards` parts.
struct Part {
    count: usize,
    shard: usize,
    shards: usize,
    /// Indices of the members in ascending order, already reduced to this shard.
    list: Option<Vec<usize>>,
}

impl Part {
    fn new(count: usize, shard: usize, shards: usize, list: Option<Vec<usize>>) -> Result<Self, Error> {
        if shard >= shards {
            return Err(Error::Ensemble(EnsembleError::Shard { shard, of: shards }));
        }
        if let Some(&member) = list.iter().flatten().find(|member| **member >= count) {
            return Err(Error::Ensemble(EnsembleError::NoSuchMember { member, count }));
        }
        let list = list.map(|mut list| {
            list.sort_unstable();
            list.dedup();
            list.into_iter().skip(shard).step_by(shards).collect()
        });
        Ok(Self { count, shard, shards, list })
    }

    fn len(&self) -> usize {
        match &self.list {
            Some(list) => list.len(),
            None => self.count.saturating_sub(self.shard).div_ceil(self.shards),
        }
    }

    /// Index in the ensemble of the `place`-th member of this part.
    fn member(&self, place: usize) -> Option<usize> {
        match &self.list {
            Some(list) => list.get(place).copied(),
            None => {
                place.checked_mul(self.shards)?.checked_add(self.shard).filter(|index| *index < self.count)
            }
        }
    }

    fn contains(&self, index: usize) -> bool {
        match &self.list {
            Some(list) => list.binary_search(&index).is_ok(),
            None => index % self.shards == self.shard,
        }
    }
}

/// Results of finished members, and the callback that follows the progress.
struct Ledger<'a, T: Element, N: Length> {
    members: Vec<Member<T, N>>,
    of: usize,
    watch: Option<Watch<'a, T, N>>,
}

impl<'a, L: Simulate> Job<'a, L> {
    pub(super) fn new(plan: Plan<'a, L>, end: L::Scalar, run: Fingerprint) -> Result<Self, Error> {
        plan.check_tag()?;
        let Plan { count, make, shard, shards, list, done, observer, watch, member_plan, tag: _ } = plan;
        member_plan.check()?;
        let part = Part::new(count, shard, shards, list)?;
        let (events, names) = (member_plan.events(), member_plan.names());
        let mut mine: Vec<_> = done.into_iter().filter(|row| part.contains(row.index)).collect();
        mine.iter().try_for_each(|row| {
            let (system, start) = make(row.index);
            check_run_of(row, &run.with_start(&system, &start))
        })?;
        mine.sort_by_key(|row| row.index);
        let mut pairs = mine.windows(2);
        if let Some([row, _]) =
            pairs.find(|pair| pair[0].index == pair[1].index && pair[0].contradicts(&pair[1]))
        {
            return Err(Error::Ensemble(EnsembleError::OtherRun { member: row.index, differs: TWO_RESULTS }));
        }
        mine.dedup_by_key(|row| row.index);
        let done = mine.iter().map(|row| row.index).collect();
        let members = mine.into_iter().map(|row| row.into_member(&events, &names));
        let members = members.collect::<Result<Vec<_>, _>>()?;
        let ledger = Mutex::new(Ledger { members, of: part.len(), watch });
        let (given, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        let member_plan = Arc::new(member_plan);
        Ok(Self { make, observer, member_plan, names, end, run, part, done, given, stopped, ledger })
    }

    pub(super) fn outcome(self) -> Outcome<L::Scalar, L::Length> {
        let ledger = self.ledger.into_inner().unwrap_or_else(PoisonError::into_inner);
        Outcome::new(ledger.members, self.names, (self.end, self.run))
    }

    /// Claims the next unassigned member.
    pub(super) fn next(&self) -> Option<usize> {
        loop {
            let place = self.given.fetch_add(1, Ordering::Relaxed);
            let index = self.part.member(place)?;
            if self.is_stopped() {
                return None;
            }
            if !self.done.contains(&index) {
                return Some(index);
            }
        }
    }

    fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Records the result of a member, and stops the whole job if the progress callback breaks. Once the job is
    /// stopped, results are dropped: the members still running were cut short.
    pub(super) fn report(&self, member: Member<L::Scalar, L::Length>) {
        let mut ledger = self.ledger.lock().unwrap_or_else(PoisonError::into_inner);
        if self.is_stopped() {
            return;
        }
        let Ledger { members, of, watch } = &mut *ledger;
        members.push(member);
        let (done, of) = (members.len(), *of);
        if let Some((watch, member)) = watch.as_mut().zip(members.last())
            && watch(EnsembleProgress { done, of, member }).is_break()
        {
            self.stopped.store(true, Ordering::Relaxed);
        }
    }

    /// Called after each step of a member: asks the observer whether the member goes on.
    pub(super) fn observe(&self, index: usize, state: &StateOf<L>) -> ControlFlow<()> {
        if self.is_stopped() {
            return ControlFlow::Break(());
        }
        match &self.observer {
            Some(observe) => observe(index, state),
            None => ControlFlow::Continue(()),
        }
    }

    /// Integrates members one after the other until none is left.
    pub(super) fn one_by_one<P: Method<L>, const HAS_DENSE_OUTPUT: bool>(&self, method: &P) {
        while let Some(index) = self.next() {
            let (mut system, start) = (self.make)(index);
            let fingerprint = self.run.with_start(&system, &start);
            let result = self.integrate::<P, HAS_DENSE_OUTPUT>(index, &mut system, &start, method);
            self.report(self.member(index, fingerprint, result));
        }
    }

    pub(super) fn member(
        &self,
        index: usize,
        fingerprint: Fingerprint,
        result: Result<Arrival<L::Scalar, L::Length>, Error>,
    ) -> Member<L::Scalar, L::Length> {
        Member { index, fingerprint, names: self.names.clone(), result }
    }

    fn integrate<P: Method<L>, const HAS_DENSE_OUTPUT: bool>(
        &self,
        index: usize,
        system: &mut L,
        start: &StateOf<L>,
        method: &P,
    ) -> Result<Arrival<L::Scalar, L::Length>, Error> {
        ChecksOf::<L>::check_entries(system, start)?;
        let (mut run, _) = Run::<L, _>::begin(system, start, method)?;
        let record = self.member_plan.record(index, system, &run.state, self.end)?;
        let limits = Watchdog::new(method.limits(), &run.statistics);
        let accept = |state: &StateOf<L>, _| unless_broken(self.observe(index, state), state.t.to_f64());
        let mut recorded =
            Recorded::<_, _, _, HAS_DENSE_OUTPUT>::new(Moving::Steered(system), record, accept);
        let driven = run.drive(method, &limits, &mut recorded);
        Ok(recorded.finish(driven, run.state, run.statistics))
    }
}

/// Rejects a member taken over from another run, or with another start or other parameters.
fn check_run_of<T: Real, N: Length>(row: &MemberRow<T, N>, expected: &Fingerprint) -> Result<(), Error> {
    match row.fingerprint.difference(expected) {
        Some(differs) => Err(Error::Ensemble(EnsembleError::OtherRun { member: row.index, differs })),
        None => Ok(()),
    }
}

impl<L: Lagrangian<Scalar = f64>> Job<'_, L> {
    /// Integrates members on SIMD lanes, one member per lane, until none is left.
    pub(super) fn on_lanes<P: LaneMethod<L>, const HAS_DENSE_OUTPUT: bool>(&self, method: &P) {
        let mut next = self.next_seat::<P, HAS_DENSE_OUTPUT>(method);
        while let Some(first) = next.take() {
            let mut batch = Batch::new(method, first);
            next = self.next_seat::<P, HAS_DENSE_OUTPUT>(method);
            while !batch.is_empty() && !self.is_stopped() {
                self.fill::<P, HAS_DENSE_OUTPUT>(&mut batch, &mut next, method);
                batch.step::<HAS_DENSE_OUTPUT>(
                    |index, state| self.observe(index, state),
                    |motion, state, ending| self.report(self.arrived(motion, state, ending)),
                );
            }
        }
    }

    /// Fills free lanes with the next members. A member that cannot run beside those in the batch waits until they have
    /// ended.
    fn fill<'j, P: LaneMethod<L>, const HAS_DENSE_OUTPUT: bool>(
        &'j self,
        batch: &mut Batch<'j, L, P>,
        next: &mut Option<LaneMotion<'j, L, P>>,
        method: &P,
    ) {
        while batch.has_free_lane()
            && let Some(motion) = next.take()
        {
            *next = batch.join(motion);
            if next.is_some() {
                break;
            }
            *next = self.next_seat::<P, HAS_DENSE_OUTPUT>(method);
        }
    }

    fn arrived<P: LaneMethod<L>>(
        &self,
        motion: LaneMotion<'_, L, P>,
        state: State<f64, L::Length>,
        ending: Ending,
    ) -> Member<f64, L::Length> {
        let LaneMotion { index, start, statistics, record, .. } = motion;
        let fingerprint = Fingerprint { start, ..self.run };
        self.member(index, fingerprint, Ok(record.arrive(state, ending, statistics)))
    }

    /// Next member that has a motion. Members without a motion, because their start has an error or they end
    /// there, are reported.
    fn next_seat<P: LaneMethod<L>, const HAS_DENSE_OUTPUT: bool>(
        &self,
        method: &P,
    ) -> Option<LaneMotion<'_, L, P>> {
        loop {
            let index = self.next()?;
            let (system, start) = (self.make)(index);
            let fingerprint = self.run.with_start(&system, &start);
            let motion = ChecksOf::<L>::check_entries(&system, &start).and_then(|()| {
                LaneMotion::new::<HAS_DENSE_OUTPUT>(
                    (index, fingerprint.start),
                    system,
                    &start,
                    self.end,
                    method,
                    |system, state| self.member_plan.record(index, system, state, self.end),
                )
            });
            match motion {
                Err(error) => self.report(self.member(index, fingerprint, Err(error))),
                Ok((mut motion, state)) => match motion.ending_at_start(method) {
                    None => return Some(motion),
                    Some(ending) => self.report(self.arrived(motion, state, ending)),
                },
            }
        }
    }
}
