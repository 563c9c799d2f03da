//! An ensemble, and what it is asked for.

use core::fmt::{self, Debug, Formatter};
use core::ops::ControlFlow;

use super::fingerprint::Fingerprint;
use super::job::Job;
use super::outcome::Outcome;
use super::plan::{EnsembleProgress, MemberPlan, Plan};
use super::table::MemberTable;
use crate::error::{EnsembleError, Error};
use crate::motion::run::check_end;
use crate::motion::{LaneMethod, Method};
use crate::number::{Lanes, Real};
use crate::system::{Lagrangian, Pack, State};

/// Many members, each a system with its start, that are integrated to the same time.
///
/// Members are made when they are needed, from their index, so that a million need no memory. With the feature
/// `rayon` they are spread over the threads of the current pool: to choose how many, integrate inside of
/// `ThreadPool::install`. The [observer](Self::observe) can keep more of a motion than its end.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// #[derive(Lagrangian)]
/// #[coordinates(theta)]
/// #[lagrangian(l^2/2 * theta_dot^2 + g*l*cos(theta))]
/// struct Pendulum<T> { g: T, l: T }
///
/// let swings = Ensemble::from_fn(100, |k| {
///     (Pendulum { g: 9.81, l: 1.0 }, State::at_rest([0.03 * k as f64]))
/// });
/// let outcome = swings.integrate_on_lanes(1.0, Dop853::default())?;
/// assert_eq!(outcome.completed().count(), 100);
/// // The smallest swings have the period 2π √(l/g).
/// let (one, phase) = (outcome.get(1).unwrap().arrival().unwrap(), 9.81_f64.sqrt());
/// assert!((one.state.q[0] - 0.03 * phase.cos()).abs() < 1e-5);
/// # Ok::<(), Error>(())
/// ```
#[must_use = "an ensemble does nothing until it is integrated"]
pub struct Ensemble<'a, L, T, const N: usize, const M: usize = 0, const HAS_DENSE_OUTPUT: bool = false>
where
    L: Lagrangian<N, M, Scalar = T>,
{
    pub(super) plan: Plan<'a, L, T, N, M>,
}

impl<'a, L, T: Real, const N: usize, const M: usize> Ensemble<'a, L, T, N, M>
where
    L: Lagrangian<N, M, Scalar = T>,
{
    /// `count` members, made from their indices 0, 1, …: always the same from the same. `member` is called from any
    /// thread, and from several at once.
    pub fn from_fn(count: usize, member: impl Fn(usize) -> (L, State<T, N>) + Send + Sync + 'a) -> Self {
        let make = Box::new(member);
        let (list, done, observer, watch, tag) = (None, Vec::new(), None, None, None);
        let member_plan = MemberPlan::default();
        Self {
            plan: Plan { count, make, shard: 0, shards: 1, list, done, observer, watch, member_plan, tag },
        }
    }

    /// These members.
    pub fn new(members: &'a [(L, State<T, N>)]) -> Self
    where
        L: Clone + Send + Sync,
    {
        // The closure is not called with another index.
        Self::from_fn(members.len(), |index| members[index].clone())
    }
}

impl<'a, L, T: Real, const N: usize, const M: usize, const HAS_DENSE_OUTPUT: bool>
    Ensemble<'a, L, T, N, M, HAS_DENSE_OUTPUT>
where
    L: Lagrangian<N, M, Scalar = T>,
{
    /// Only one of `of` parts: every `of`-th member, from the one in place `shard` on (counted from 0). The parts differ by one
    /// member at most; they may be run anywhere, and are put together by [`Outcome::merge`] or by [`resume`](Self::resume).
    pub fn shard(mut self, shard: usize, of: usize) -> Self {
        (self.plan.shard, self.plan.shards) = (shard, of);
        self
    }

    /// Only these members, in any order: those that failed, or a few to be looked at. Of them [`shard`](Self::shard) takes its
    /// part.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// # #[derive(Lagrangian)]
    /// # #[coordinates(x)]
    /// # #[lagrangian(x_dot^2/2 - k/2 * x^2)]
    /// # struct Spring<T> { k: T }
    /// let springs = || Ensemble::from_fn(100, |n| (Spring { k: n as f64 }, State::at_rest([1.0])));
    /// let few = springs().members([42, 3, 17]).integrate_on_lanes(1.0, Dop853::default())?;
    /// assert!(few.members().iter().map(|member| member.index).eq([3, 17, 42]));
    /// // Once more, with more steps.
    /// let failed = few.failures().map(|member| member.index);
    /// springs().members(failed).integrate_on_lanes(1.0, Dop853::default().max_steps(1_000_000))?;
    /// # Ok::<(), Error>(())
    /// ```
    pub fn members(mut self, indices: impl IntoIterator<Item = usize>) -> Self {
        self.plan.list = Some(indices.into_iter().collect());
        self
    }

    /// Looks at every member after every step, from any thread. `ControlFlow::Break` ends that member there, with
    /// [`Ending::Cancelled`](crate::Ending::Cancelled), and no other.
    pub fn observe(
        mut self,
        observer: impl Fn(usize, &State<T, N>) -> ControlFlow<()> + Send + Sync + 'a,
    ) -> Self {
        self.plan.observer = Some(Box::new(observer));
        self
    }

    /// Looks at the progress whenever a member is done, under a lock: threads whose members are done meanwhile wait.
    ///
    /// `ControlFlow::Break` stops the ensemble, the members that are on their way at the end of their steps, and
    /// `watch` is not called again. Members that are not done are left out of the outcome, and can be
    /// [resumed](Self::resume).
    pub fn on_progress(
        mut self,
        watch: impl FnMut(EnsembleProgress<'_, T, N>) -> ControlFlow<()> + Send + 'a,
    ) -> Self {
        self.plan.watch = Some(Box::new(watch));
        self
    }

    /// Names the code that this run is made with: closures for [events](Self::event), a
    /// [controller](Self::controlled), an [observer](Self::observe), functions [supplied](crate::Function) to the system,
    /// equations written by hand. No [`Fingerprint`] sees code or what it holds, so a run with any of these takes over rows
    /// of a run with the same tag alone. Give another tag whenever they change: put numbers in them into it,
    /// `format!("gain {gain}")`. Without a tag such a run can be integrated, and not [resumed](Self::resume). The empty tag is
    /// that of a run without one.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// # #[derive(Lagrangian)]
    /// # #[coordinates(x)]
    /// # #[lagrangian(x_dot^2/2 - k/2 * x^2)]
    /// # struct Spring<T> { k: T }
    /// use lagrange_core::ensemble::EnsembleError;
    /// let springs = |level: f64| {
    ///     let rises = Spring { k: 0.0 }.event("rises", move |sample| sample.state().q[0] - level).terminal();
    ///     let springs = Ensemble::from_fn(9, |n| (Spring { k: n as f64 }, State::at_rest([1.0])));
    ///     springs.event(rises).tag(format!("level {level}"))
    /// };
    /// let table = springs(0.5).integrate(9.0, Dop853::default())?.csv().to_string();
    /// assert!(springs(0.5).resume(&table)?.integrate(9.0, Dop853::default()).is_ok());
    /// let other = springs(0.25).resume(&table)?.integrate(9.0, Dop853::default());
    /// assert!(matches!(other, Err(Error::Ensemble(EnsembleError::OtherRun { .. }))));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn tag(mut self, tag: impl Into<String>) -> Self {
        self.plan.tag = Some(tag.into());
        self
    }

    /// The motions to the time `end`, one after the other on each thread, by the method named.
    ///
    /// # Errors
    /// What is wrong with the whole: [`Error::Setting`], [`Error::EndNotFinite`], [`EnsembleError::Shard`],
    /// [`EnsembleError::NoSuchMember`], [`EnsembleError::OtherRun`], [`EnsembleError::Untagged`], [`Error::SampleTime`]. What is wrong with a member is in
    /// the outcome.
    pub fn integrate<P>(self, end: T, method: P) -> Result<Outcome<T, N>, Error>
    where
        P: Method<L, N, M> + Sync,
    {
        method.check()?;
        let run = self.plan.fingerprint(&method, end, false);
        self.run(end, run, |job| job.one_by_one::<P, HAS_DENSE_OUTPUT>(&method))
    }

    /// Leaves out what is done: the members in this table, from [`Outcome::csv`] or from the rows of
    /// [`Member::csv`](super::Member::csv), one run's or those of several in a row. They are taken over into the outcome. Several
    /// tables add up, and of several rows of one member the first counts.
    ///
    /// Members that failed are tried again: with the same settings they give the same failure, but for a limit on
    /// wall time. Rows of another part are ignored, and so are lines that were not written to their end, also where
    /// another row was appended to one. A row says by its [`Fingerprint`] which run it is of: to be taken over, it must have
    /// been computed from the same start and parameters, of the same equations, with the same method and settings (limits
    /// may differ) to the same end, on lanes or not, and under the same [tag](Self::tag). To see that, all members of the table
    /// are made once more.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(x_dot^2/2 - k/2 * x^2)]
    /// struct Spring<T> { k: T }
    ///
    /// let springs = || Ensemble::from_fn(100, |n| (Spring { k: n as f64 }, State::at_rest([1.0])));
    /// let part = |k| springs().shard(k, 2).integrate(1.0, Dop853::default());
    /// let table = part(0)?.csv().to_string();
    /// let whole = springs().resume(&table)?.integrate(1.0, Dop853::default())?;
    /// assert_eq!(whole, part(0)?.merge(part(1)?)?);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`EnsembleError::Resume`] for what is no row of this system, and where rows are of different runs. For members of
    /// another run, to another end or of another start [`integrate`](Self::integrate) gives [`EnsembleError::OtherRun`], and
    /// [`EnsembleError::Untagged`] where code decides about the members that no fingerprint sees, and there is no [tag](Self::tag).
    pub fn resume(self, table: &str) -> Result<Self, Error>
    where
        T: core::str::FromStr,
    {
        let system = Fingerprint::of_system::<L, N, M>();
        let table = MemberTable::of(table, L::COORDINATES, system, self.plan.count)?;
        self.resume_from(table)
    }

    /// Leaves out what is done as [`resume`](Self::resume) does, by a table that was read.
    ///
    /// # Errors
    /// [`EnsembleError::NoSuchMember`], where the table has more members than the ensemble.
    pub fn resume_from(mut self, table: MemberTable<T, N>) -> Result<Self, Error> {
        let count = self.plan.count;
        match table.rows().last() {
            Some(row) if row.index >= count => {
                Err(Error::Ensemble(EnsembleError::NoSuchMember { member: row.index, count }))
            }
            _ => {
                self.plan.done.extend(table.into_rows().filter(|row| !row.has_failed()));
                Ok(self)
            }
        }
    }

    pub(super) fn run(
        self,
        end: T,
        run: Fingerprint,
        work: impl Fn(&Job<'_, L, T, N, M>) + Sync,
    ) -> Result<Outcome<T, N>, Error> {
        check_end(end)?;
        let job = Job::new(self.plan, end, run)?;
        everywhere(|| work(&job));
        Ok(job.outcome())
    }
}

impl<L, const N: usize, const M: usize, const HAS_DENSE_OUTPUT: bool>
    Ensemble<'_, L, f64, N, M, HAS_DENSE_OUTPUT>
where
    L: Lagrangian<N, M, Scalar = f64>,
{
    /// The motions to the time `end`, as many at once on each thread as there are [`Lanes`], by the method named: `Dop853`, `Dopri5`,
    /// [`Taylor`](crate::Taylor) or another [`LaneMethod`].
    ///
    /// Each lane has its own time, step and error, and is given the next member when its motion has ended. Compile
    /// with `RUSTFLAGS="-C target-cpu=native"`, so that the lanes are those of AVX2 or AVX-512. The numbers differ from those of
    /// [`integrate`](Self::integrate) by rounding, as far as the motion carries that. A limit on wall time counts
    /// the time that a lane spends with the others. Where members differ in a field that lanes [share](Pack), order
    /// them so that equal ones follow each other: one that does not fit waits until the lanes beside are empty.
    ///
    /// # Errors
    /// As [`integrate`](Self::integrate).
    pub fn integrate_on_lanes<P>(self, end: f64, method: P) -> Result<Outcome<f64, N>, Error>
    where
        L: Pack<Lanes, Packed: Lagrangian<N, M, Scalar = Lanes>>,
        P: LaneMethod<L, N, M> + Sync,
    {
        method.check()?;
        let run = self.plan.fingerprint(&method, end, true);
        self.run(end, run, |job| job.on_lanes::<P, HAS_DENSE_OUTPUT>(&method))
    }
}

impl<L, T, const N: usize, const M: usize, const HAS_DENSE_OUTPUT: bool> Debug
    for Ensemble<'_, L, T, N, M, HAS_DENSE_OUTPUT>
where
    L: Lagrangian<N, M, Scalar = T>,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Plan { count, shard, shards, .. } = &self.plan;
        f.debug_struct("Ensemble").field("count", count).field("shard", shard).field("of", shards).finish()
    }
}

/// Runs it on every thread of rayon's current pool; without rayon on this thread.
pub(super) fn everywhere(work: impl Fn() + Sync) {
    #[cfg(feature = "rayon")]
    rayon::broadcast(|_| work());
    #[cfg(not(feature = "rayon"))]
    work();
}
