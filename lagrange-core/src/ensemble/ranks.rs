//! An ensemble on the ranks of MPI: rank 0 hands out members in batches, and integrates too.
//!
//! A rank has at most one batch, asks for the next by sending the rows of the last, and waits for it: no message is on its
//! way to one who computes, so that no send waits for a receive that does not come. All calls of MPI are made by the thread
//! that asked for the integration; on rank 0 another thread integrates meanwhile.

mod message;

use core::fmt::{self, Debug, Formatter};
use core::time::Duration;
use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Instant;

use mpi::Threading;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, Source};

use super::fingerprint::Fingerprint;
use super::job::Job;
use super::outcome::Outcome;
use super::settings::{Ensemble, everywhere};
use crate::error::{EnsembleError, Error};
use crate::motion::run::check_end;
use crate::motion::{LaneMethod, Method};
use crate::number::{Lanes, Real};
use crate::system::{Lagrangian, Pack};
use message::MemberMessage;

/// An ensemble on all ranks of a communicator of MPI, from [`Ensemble::on_ranks`].
#[must_use = "an ensemble does nothing until it is integrated"]
pub struct OnRanks<'a, L, T, const N: usize, const M: usize = 0, const HAS_DENSE_OUTPUT: bool = false>
where
    L: Lagrangian<N, M, Scalar = T>,
{
    ensemble: Ensemble<'a, L, T, N, M, HAS_DENSE_OUTPUT>,
    world: SimpleCommunicator,
    batch: Duration,
}

/// How long rank 0 sleeps where no rank asks for anything.
const PAUSE: Duration = Duration::from_millis(1);
/// A batch has as many members as this or more, where there are enough of them.
const LEAST: usize = 16;

impl<'a, L, T: Real, const N: usize, const M: usize, const HAS_DENSE_OUTPUT: bool>
    Ensemble<'a, L, T, N, M, HAS_DENSE_OUTPUT>
where
    L: Lagrangian<N, M, Scalar = T>,
{
    /// This ensemble on all ranks of the communicator, each of which must call this and then integrate: a
    /// [chapter](super#on-many-machines) tells how.
    ///
    /// Rank 0 hands out members in batches as ranks become free, and integrates too. It alone has the outcome, needs
    /// the tables to [resume](Self::resume) from, and calls [`on_progress`](Self::on_progress). Members, method, end and part
    /// must be the same on all ranks. What a member gives is bit for bit the same for any number of ranks; what went wrong with
    /// one is told in words, as a table does.
    ///
    /// With the feature `rayon` each rank integrates on all threads of rayon's global pool.
    pub fn on_ranks(self, communicator: &impl Communicator) -> OnRanks<'a, L, T, N, M, HAS_DENSE_OUTPUT> {
        // Its messages do not meet those of the program.
        OnRanks { ensemble: self, world: communicator.duplicate(), batch: Duration::from_secs(1) }
    }
}

impl<L, T: Real, const N: usize, const M: usize, const HAS_DENSE_OUTPUT: bool>
    OnRanks<'_, L, T, N, M, HAS_DENSE_OUTPUT>
where
    L: Lagrangian<N, M, Scalar = T>,
{
    /// About how long a rank is to work on a batch; 1 s where nothing is said. It is what is lost at most where the job is
    /// killed. Rank 0 hears of each rank about as often. Batches become shorter toward the end, so that all end together.
    pub fn batch(mut self, time: Duration) -> Self {
        self.batch = time;
        self
    }

    /// The motions to the time `end`, one after the other on each thread, as by [`Ensemble::integrate`]: at rank 0 the outcome
    /// of all, elsewhere none.
    ///
    /// # Errors
    /// As there, on the rank where it is wrong, and on the others [`EnsembleError::Ranks`]; that also where the ensembles of the ranks
    /// differ, and where MPI is not to be used beside threads. Nothing is integrated then.
    ///
    /// Where a rank panics, it ends the whole job: the others could only wait.
    pub fn integrate<P>(self, end: T, method: P) -> Result<Option<Outcome<T, N>>, Error>
    where
        P: Method<L, N, M> + Sync,
    {
        let run = self.ensemble.plan.fingerprint(&method, end, false);
        self.run(method.check(), end, run, |job| job.one_by_one::<P, HAS_DENSE_OUTPUT>(&method))
    }

    fn run(
        mut self,
        checked: Result<(), Error>,
        end: T,
        run: Fingerprint,
        work: impl Fn(&Job<'_, L, T, N, M>) + Sync,
    ) -> Result<Option<Outcome<T, N>>, Error> {
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
            MemberMessage::of(batch.outcome().members())
        };
        if !is_first {
            follow(&self.world, integrate);
            return Ok(None);
        }
        lead(&self.world, &job, self.batch, integrate);
        Ok(Some(job.outcome()))
    }
}

impl<L, const N: usize, const M: usize, const HAS_DENSE_OUTPUT: bool>
    OnRanks<'_, L, f64, N, M, HAS_DENSE_OUTPUT>
where
    L: Lagrangian<N, M, Scalar = f64>,
{
    /// The motions to the time `end`, as many at once on each thread as there are [`Lanes`], as by [`Ensemble::integrate_on_lanes`]: at
    /// rank 0 the outcome of all, elsewhere none.
    ///
    /// # Errors
    /// As [`integrate`](Self::integrate).
    pub fn integrate_on_lanes<P>(self, end: f64, method: P) -> Result<Option<Outcome<f64, N>>, Error>
    where
        L: Pack<Lanes, Packed: Lagrangian<N, M, Scalar = Lanes>>,
        P: LaneMethod<L, N, M> + Sync,
    {
        let run = self.ensemble.plan.fingerprint(&method, end, true);
        self.run(method.check(), end, run, |job| job.on_lanes::<P, HAS_DENSE_OUTPUT>(&method))
    }
}

impl<L, T, const N: usize, const M: usize, const HAS_DENSE_OUTPUT: bool> Debug
    for OnRanks<'_, L, T, N, M, HAS_DENSE_OUTPUT>
where
    L: Lagrangian<N, M, Scalar = T>,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("OnRanks").field("ensemble", &self.ensemble).field("batch", &self.batch).finish()
    }
}

/// Ends the whole job where this rank unwinds: the others would wait for it for ever.
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

/// Nobody begins where one cannot, or would compute something else than rank 0.
fn agreed<'a, L, T: Real, const N: usize, const M: usize>(
    world: &SimpleCommunicator,
    job: Result<Job<'a, L, T, N, M>, Error>,
) -> Result<Job<'a, L, T, N, M>, Error>
where
    L: Lagrangian<N, M, Scalar = T>,
{
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

/// Integrates what rank 0 hands out, until that is nothing.
fn follow(world: &SimpleCommunicator, integrate: impl Fn(Vec<usize>) -> MemberMessage) {
    let first = world.process_at_rank(0);
    loop {
        let (list, _) = first.receive_vec();
        if list.is_empty() {
            return;
        }
        integrate(list).send(&first);
    }
}

/// Hands out members and takes them in, while another thread integrates what this rank hands to itself.
fn lead<L, T: Real, const N: usize, const M: usize>(
    world: &SimpleCommunicator,
    job: &Job<'_, L, T, N, M>,
    batch: Duration,
    integrate: impl Fn(Vec<usize>) -> MemberMessage + Send,
) where
    L: Lagrangian<N, M, Scalar = T>,
{
    thread::scope(|scope| {
        let (own, lists) = channel();
        let (finished, parcels) = channel();
        let hands = scope
            .spawn(move || lists.into_iter().map(integrate).try_for_each(|message| finished.send(message)));
        let open = vec![None; size(world)];
        let mut desk = Desk { world, own, job, batch, open, members: 0, time: Duration::ZERO };
        desk.serve(&parcels, || hands.is_finished());
        drop(desk);
        if let Err(panic) = hands.join() {
            resume_unwind(panic);
        }
    });
}

/// Where rank 0 keeps the books.
struct Desk<'w, 'a, L: Lagrangian<N, M, Scalar = T>, T, const N: usize, const M: usize> {
    world: &'w SimpleCommunicator,
    /// To the thread that integrates on this rank.
    own: Sender<Vec<usize>>,
    job: &'w Job<'a, L, T, N, M>,
    batch: Duration,
    /// Of each rank, when it was given its batch, and how many members are in it.
    open: Vec<Option<(Instant, usize)>>,
    /// How many members were in the batches that are done, and how long ranks took for them.
    members: usize,
    time: Duration,
}

impl<L, T: Real, const N: usize, const M: usize> Desk<'_, '_, L, T, N, M>
where
    L: Lagrangian<N, M, Scalar = T>,
{
    /// Until all members are done, or the job is stopped, or the thread of this rank has panicked.
    fn serve(&mut self, parcels: &Receiver<MemberMessage>, is_lost: impl Fn() -> bool) {
        let events = self.job.events();
        (0..self.open.len()).for_each(|rank| self.hand_out(rank));
        while self.open.iter().any(Option::is_some) && !is_lost() {
            let own = parcels.try_recv().ok().map(|message| (0, message));
            let Some((rank, message)) = own.or_else(|| MemberMessage::arrived(self.world)) else {
                thread::sleep(PAUSE);
                continue;
            };
            // The rank waits: it comes first.
            self.close(rank);
            self.hand_out(rank);
            message.members(self.job.run(), &events).for_each(|member| self.job.report(member));
        }
    }

    fn close(&mut self, rank: usize) {
        if let Some((since, members)) = self.open[rank].take() {
            self.members += members;
            self.time += since.elapsed();
        }
    }

    /// Gives the rank its next batch; nothing, if there is none, which another rank takes for the end.
    fn hand_out(&mut self, rank: usize) {
        let members = std::iter::from_fn(|| self.job.next()).take(self.size());
        let list: Vec<usize> = members.collect();
        self.open[rank] = (!list.is_empty()).then(|| (Instant::now(), list.len()));
        match rank {
            0 if list.is_empty() => {}
            // Where the thread has panicked, nobody takes it.
            0 => drop(self.own.send(list)),
            _ => self.world.process_at_rank(rank as i32).send(&list[..]),
        }
    }

    /// As many members as take about the time asked for. Toward the end each rank is given half of its share of what is left.
    fn size(&self) -> usize {
        let share = self.job.left() / (2 * self.open.len());
        let each = self.time.as_secs_f64() / self.members.max(1) as f64;
        let timed = if self.members == 0 { LEAST } else { (self.batch.as_secs_f64() / each) as usize };
        timed.max(LEAST).min(share).max(1)
    }
}
