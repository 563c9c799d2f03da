//! An ensemble on the ranks of MPI: rank 0 distributes members in batches, and integrates as well.
//!
//! A rank has at most one batch. It sends the rows of a batch to ask for the next, then waits for it. Rank 0 never
//! sends to a rank that computes, so no send blocks on a receive that does not come. The thread that started the
//! integration makes all MPI calls; on rank 0 another thread integrates meanwhile.

use core::fmt::{self, Debug, Formatter};
use core::time::Duration;
use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Instant;

use mpi::Threading;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, MatchedReceiveVec, Source};

use super::fingerprint::Fingerprint;
use super::job::Job;
use super::limits::{LEAST, PAUSE};
use super::outcome::Outcome;
use super::settings::{Ensemble, everywhere};
use super::table::rows;
use crate::contact::Contacts;
use crate::error::{EnsembleError, Error};
use crate::motion::run::check_end;
use crate::motion::{LaneMethod, Method};
use crate::number::{Lanes, Real};
use crate::system::check_contacts;
use crate::{Lagrangian, Pack};

/// An ensemble on all ranks of an MPI communicator, from [`Ensemble::on_ranks`].
#[must_use = "an ensemble does nothing until it is integrated"]
pub struct OnRanks<'a, L: Lagrangian<Scalar: Real>, const HAS_DENSE_OUTPUT: bool = false> {
    ensemble: Ensemble<'a, L, HAS_DENSE_OUTPUT>,
    world: SimpleCommunicator,
    batch: Duration,
}

impl<'a, L: Lagrangian<Scalar: Real>, const HAS_DENSE_OUTPUT: bool> Ensemble<'a, L, HAS_DENSE_OUTPUT> {
    /// Runs this ensemble on all ranks of the communicator. Each rank must call this and then integrate; see the
    /// [chapter](super#on-many-machines).
    ///
    /// Rank 0 hands out members in batches as ranks become free, and integrates too. Rank 0 alone returns the outcome,
    /// reads the tables to [resume](Self::resume) from, and calls [`on_progress`](Self::on_progress). Members, method,
    /// end and part must be the same on all ranks. The result of a member is the same bit for bit for any number of
    /// ranks. The error of a member arrives as text, as in a table.
    ///
    /// With the feature `rayon` each rank integrates on all threads of rayon's global pool.
    pub fn on_ranks(self, communicator: &impl Communicator) -> OnRanks<'a, L, HAS_DENSE_OUTPUT> {
        // A duplicate keeps messages of the ensemble apart from those of the program.
        OnRanks { ensemble: self, world: communicator.duplicate(), batch: Duration::from_secs(1) }
    }
}

impl<L: Lagrangian<Scalar: Real>, const HAS_DENSE_OUTPUT: bool> OnRanks<'_, L, HAS_DENSE_OUTPUT> {
    /// Sets the approximate time that a rank works on one batch; 1 s by default. At most this much work is lost if the
    /// job is killed. Rank 0 hears from each rank about as often. Batches become shorter toward the end, so that all
    /// ranks finish together.
    pub fn batch(mut self, time: Duration) -> Self {
        self.batch = time;
        self
    }

    /// Integrates all members to the time `end`, one after the other on each thread, like [`Ensemble::integrate`].
    /// Returns the outcome of all members on rank 0, and `None` on the others.
    ///
    /// # Errors
    /// The errors of [`Ensemble::integrate`] on the rank where they occur, and [`EnsembleError::Ranks`] on the others.
    /// [`EnsembleError::Ranks`] also if the ensembles of the ranks differ, or if MPI does not support threads. After an
    /// error nothing is integrated.
    ///
    /// A rank that panics aborts the whole job, because the other ranks would wait forever.
    pub fn integrate<P: Method<L> + Sync>(
        self,
        end: L::Scalar,
        method: P,
    ) -> Result<Option<Outcome<L::Scalar, L::N>>, Error> {
        const { check_contacts(L::HAS_CONTACTS) };
        let run = self.ensemble.plan.fingerprint(&method, end, false);
        self.run(method.check(), end, run, |job| job.one_by_one::<P, HAS_DENSE_OUTPUT>(&method))
    }

    /// Integrates all members across their contacts, like [`Ensemble::integrate_with_contacts`]. Returns the outcome of all
    /// members on rank 0, and `None` on the others.
    ///
    /// # Errors
    /// Those of [`integrate`](Self::integrate).
    pub fn integrate_with_contacts<P: Method<L> + Sync>(
        self,
        end: L::Scalar,
        method: P,
    ) -> Result<Option<Outcome<L::Scalar, L::N>>, Error>
    where
        L: Contacts + Clone,
    {
        let run = self.ensemble.plan.fingerprint(&method, end, false);
        self.run(method.check(), end, run, |job| job.across_contacts(&method))
    }

    fn run(
        mut self,
        checked: Result<(), Error>,
        end: L::Scalar,
        run: Fingerprint,
        work: impl Fn(&Job<'_, L>) + Sync,
    ) -> Result<Option<Outcome<L::Scalar, L::N>>, Error> {
        let _guard = AbortOnPanic(&self.world);
        let is_first = self.world.rank() == 0;
        if !is_first {
            self.ensemble.plan.done.clear();
        }
        let job = checked.and_then(|()| check_threads(&self.world)).and_then(|()| check_end(end));
        let job = job.and_then(|()| Job::new(self.ensemble.plan, end, run));
        let job = agreed(&self.world, job)?;
        let integrate = |list: Vec<usize>| {
            let batch = job.batch(list);
            everywhere(|| work(&batch));
            batch.outcome().json_lines().to_string()
        };
        if !is_first {
            follow(&self.world, integrate);
            return Ok(None);
        }
        lead(&self.world, &job, self.batch, integrate);
        Ok(Some(job.outcome()))
    }
}

impl<L: Lagrangian<Scalar = f64>, const HAS_DENSE_OUTPUT: bool> OnRanks<'_, L, HAS_DENSE_OUTPUT> {
    /// Integrates all members to the time `end`, on each thread as many at once as [`Lanes`] holds, like
    /// [`Ensemble::integrate_on_lanes`]. Returns the outcome of all members on rank 0, and `None` on the others.
    ///
    /// # Errors
    /// The errors of [`integrate`](Self::integrate).
    pub fn integrate_on_lanes<P>(self, end: f64, method: P) -> Result<Option<Outcome<f64, L::N>>, Error>
    where
        L: Pack<Lanes, Packed: Lagrangian<N = L::N, M = L::M, Scalar = Lanes>>,
        P: LaneMethod<L> + Sync,
    {
        const { check_contacts(L::HAS_CONTACTS) };
        let run = self.ensemble.plan.fingerprint(&method, end, true);
        self.run(method.check(), end, run, |job| job.on_lanes::<P, HAS_DENSE_OUTPUT>(&method))
    }
}

impl<L: Lagrangian<Scalar: Real>, const HAS_DENSE_OUTPUT: bool> Debug for OnRanks<'_, L, HAS_DENSE_OUTPUT> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("OnRanks").field("ensemble", &self.ensemble).field("batch", &self.batch).finish()
    }
}

/// Aborts the whole job if this rank panics: the other ranks would wait forever.
struct AbortOnPanic<'w>(&'w SimpleCommunicator);

impl Drop for AbortOnPanic<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.abort(101);
        }
    }
}

fn check_threads(world: &SimpleCommunicator) -> Result<(), Error> {
    let reason =
        "MPI is not to be used beside threads: begin with `initialize_with_threading(Threading::Funneled)`";
    match mpi::environment::threading_support() {
        Threading::Single => {
            Err(Error::Ensemble(EnsembleError::Ranks { rank: world.rank().unsigned_abs() as usize, reason }))
        }
        _ => Ok(()),
    }
}

/// Checks, before any rank integrates, that every rank can integrate and agrees with rank 0.
fn agreed<'a, L: Lagrangian<Scalar: Real>>(
    world: &SimpleCommunicator,
    job: Result<Job<'a, L>, Error>,
) -> Result<Job<'a, L>, Error> {
    let mine = job.as_ref().map_or([0; 4], |job| {
        let [run, count, members] = job.identity();
        [1, run, count, members]
    });
    let mut all = vec![0_u64; mine.len() * size(world)];
    world.all_gather_into(&mine[..], &mut all[..]);
    let job = job?;
    for (rank, theirs) in all.chunks_exact(mine.len()).enumerate() {
        if theirs[0] == 0 {
            return Err(Error::Ensemble(EnsembleError::Ranks {
                rank,
                reason: "something is wrong that is told there",
            }));
        }
        if theirs != &all[..mine.len()] {
            let reason = "system, method, settings, tag, end, members or part are others than on rank 0";
            return Err(Error::Ensemble(EnsembleError::Ranks { rank, reason }));
        }
    }
    Ok(job)
}

fn size(world: &SimpleCommunicator) -> usize {
    world.size().unsigned_abs() as usize
}

/// Integrates the batches that rank 0 sends, until an empty batch arrives.
fn follow(world: &SimpleCommunicator, integrate: impl Fn(Vec<usize>) -> String) {
    let first = world.process_at_rank(0);
    loop {
        let (list, _) = first.receive_vec();
        if list.is_empty() {
            return;
        }
        first.send(integrate(list).as_bytes());
    }
}

/// Receives the first rows that have arrived from any rank; returns that rank and the rows as JSON lines.
fn arrived(world: &SimpleCommunicator) -> Option<(usize, String)> {
    let message = world.any_process().immediate_matched_probe()?;
    let rank = message.1.source_rank().unsigned_abs() as usize;
    Some((rank, String::from_utf8_lossy(&message.matched_receive_vec().0).into_owned()))
}

/// Distributes members and collects their results, while another thread integrates the batches of rank 0.
fn lead<L: Lagrangian<Scalar: Real>>(
    world: &SimpleCommunicator,
    job: &Job<'_, L>,
    batch: Duration,
    integrate: impl Fn(Vec<usize>) -> String + Send,
) {
    thread::scope(|scope| {
        let (own, lists) = channel();
        let (finished, parcels) = channel();
        let hands =
            scope.spawn(move || lists.into_iter().map(integrate).try_for_each(|lines| finished.send(lines)));
        let open = vec![None; size(world)];
        let mut desk = Desk { world, own, job, batch, open, members: 0, time: Duration::ZERO };
        desk.serve(&parcels, || hands.is_finished());
        drop(desk);
        if let Err(panic) = hands.join() {
            resume_unwind(panic);
        }
    });
}

/// State of rank 0: the open batches and their timing.
struct Desk<'w, 'a, L: Lagrangian<Scalar: Real>> {
    world: &'w SimpleCommunicator,
    /// Channel to the thread that integrates on this rank.
    own: Sender<Vec<usize>>,
    job: &'w Job<'a, L>,
    batch: Duration,
    /// For each rank, the time when it received its batch, and the number of members in it.
    open: Vec<Option<(Instant, usize)>>,
    /// Number of members in all finished batches, and the total time that ranks took for them.
    members: usize,
    time: Duration,
}

impl<L: Lagrangian<Scalar: Real>> Desk<'_, '_, L> {
    /// Serves ranks until all members are done, the job is stopped, or the integrating thread of this rank has
    /// panicked.
    fn serve(&mut self, parcels: &Receiver<String>, is_lost: impl Fn() -> bool) {
        let events = self.job.events();
        (0..self.open.len()).for_each(|rank| self.hand_out(rank));
        while self.open.iter().any(Option::is_some) && !is_lost() {
            let own = parcels.try_recv().ok().map(|lines| (0, lines));
            let Some((rank, lines)) = own.or_else(|| arrived(self.world)) else {
                thread::sleep(PAUSE);
                continue;
            };
            // Hand out the next batch before unpacking: the rank is idle meanwhile.
            self.close(rank);
            self.hand_out(rank);
            let rows = rows(&lines, L::COORDINATES).into_iter().flatten();
            let members = rows.filter_map(|(_, row)| row.into_member(&events, &self.job.names).ok());
            members.for_each(|member| self.job.report(member));
        }
    }

    fn close(&mut self, rank: usize) {
        if let Some((since, members)) = self.open[rank].take() {
            self.members += members;
            self.time += since.elapsed();
        }
    }

    /// Sends the rank its next batch. An empty batch tells another rank that the work is done; rank 0 gets none.
    fn hand_out(&mut self, rank: usize) {
        let members = std::iter::from_fn(|| self.job.next()).take(self.size());
        let list: Vec<usize> = members.collect();
        self.open[rank] = (!list.is_empty()).then(|| (Instant::now(), list.len()));
        match rank {
            0 if list.is_empty() => {}
            // Sending fails if the integrating thread has panicked; `serve` detects that.
            0 => drop(self.own.send(list)),
            _ => self.world.process_at_rank(rank as i32).send(&list[..]),
        }
    }

    /// Number of members in the next batch: as many as take about the requested time. Toward the end each rank gets
    /// half of its share of the remaining members.
    fn size(&self) -> usize {
        let share = self.job.left() / (2 * self.open.len());
        let each = self.time.as_secs_f64() / self.members.max(1) as f64;
        let timed = if self.members == 0 { LEAST } else { (self.batch.as_secs_f64() / each) as usize };
        timed.max(LEAST).min(share).max(1)
    }
}
