//! An ensemble and its settings.

use core::fmt::{self, Debug, Formatter};
use core::ops::ControlFlow;

use super::fingerprint::Fingerprint;
use super::job::Job;
use super::outcome::Outcome;
use super::plan::{EnsembleProgress, MemberPlan, Plan};
use crate::error::Error;
use crate::motion::run::check_end;
use crate::motion::{LaneMethod, Method, Simulate, SystemChecks};
use crate::number::Lanes;
use crate::solution::system_checks::ChecksOf;
use crate::system::check_contacts;
use crate::{Lagrangian, Pack, StateOf};

/// Many members, each a system with its initial state, that are integrated to the same time.
///
/// A member is made from its index when it is needed, so that a million members need no memory. With the feature
/// `rayon` members are distributed over the threads of the current pool; to choose the number of threads, integrate
/// inside `ThreadPool::install`. The [observer](Self::observe) can keep more of a motion than its end.
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
pub struct Ensemble<'a, L: Simulate, const HAS_DENSE_OUTPUT: bool = false> {
    pub(super) plan: Plan<'a, L>,
}

impl<'a, L: Simulate> Ensemble<'a, L> {
    /// Makes `count` members from their indices 0, 1, …. `member` must return the same member for the same index. It is
    /// called from any thread, and from several at once.
    pub fn from_fn(count: usize, member: impl Fn(usize) -> (L, StateOf<L>) + Send + Sync + 'a) -> Self {
        let make = Box::new(member);
        let (list, done, observer, watch, tag) = (None, Vec::new(), None, None, None);
        let member_plan = MemberPlan::default();
        Self {
            plan: Plan { count, make, shard: 0, shards: 1, list, done, observer, watch, member_plan, tag },
        }
    }

    /// An ensemble of these members.
    pub fn new(members: &'a [(L, StateOf<L>)]) -> Self
    where
        L: Clone + Send + Sync,
    {
        // In range: the closure is only called with indices below `members.len()`.
        Self::from_fn(members.len(), |index| members[index].clone())
    }
}

impl<'a, L: Simulate, const HAS_DENSE_OUTPUT: bool> Ensemble<'a, L, HAS_DENSE_OUTPUT> {
    /// Keeps one of `of` parts: every `of`-th member, starting at index `shard` (counted from 0). The sizes of the
    /// parts differ by one member at most. Parts may run on different machines; [`Outcome::merge`] or
    /// [`resume`](Self::resume) combines them.
    pub fn shard(mut self, shard: usize, of: usize) -> Self {
        (self.plan.shard, self.plan.shards) = (shard, of);
        self
    }

    /// Keeps only these members, in any order: those that failed, for example, or a few to inspect.
    /// [`shard`](Self::shard) divides this list.
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

    /// Calls `observer` with the index and state of every member after each step, from any thread. `ControlFlow::Break`
    /// ends that member alone, with [`Ending::Cancelled`](crate::Ending::Cancelled).
    pub fn observe(
        mut self,
        observer: impl Fn(usize, &StateOf<L>) -> ControlFlow<()> + Send + Sync + 'a,
    ) -> Self {
        self.plan.observer = Some(Box::new(observer));
        self
    }

    /// Calls `watch` whenever a member is finished, under a lock: other threads that finish a member meanwhile wait.
    ///
    /// `ControlFlow::Break` stops the ensemble: running members stop after their current step, and `watch` is not
    /// called again. Unfinished members are left out of the outcome, and can be [resumed](Self::resume).
    pub fn on_progress(
        mut self,
        watch: impl FnMut(EnsembleProgress<'_, L::Scalar, L::Length>) -> ControlFlow<()> + Send + 'a,
    ) -> Self {
        self.plan.watch = Some(Box::new(watch));
        self
    }

    /// Names the code that this run uses: closures for [events](Self::event), [quantities](Self::quantity), a
    /// [controller](Self::controlled), an [observer](Self::observe), functions [supplied](crate::Function) to the system, equations written by hand. A
    /// [`Fingerprint`] cannot see code or the values that it captures, so a run with such code takes over rows only of
    /// a run with the same tag. Choose another tag whenever the code changes, and include captured numbers:
    /// `format!("gain {gain}")`. Without a tag such a run can be integrated, but not [resumed](Self::resume). The empty
    /// tag gives the same fingerprint as no tag.
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
    /// # #[cfg(feature = "tables")] {
    /// let table = springs(0.5).integrate(9.0, Dop853::default())?.json_lines().to_string();
    /// assert!(springs(0.5).resume(&table)?.integrate(9.0, Dop853::default()).is_ok());
    /// let other = springs(0.25).resume(&table)?.integrate(9.0, Dop853::default());
    /// assert!(matches!(other, Err(Error::Ensemble(EnsembleError::OtherRun { .. }))));
    /// # }
    /// # Ok::<(), Error>(())
    /// ```
    pub fn tag(mut self, tag: impl Into<String>) -> Self {
        self.plan.tag = Some(tag.into());
        self
    }

    /// Integrates all members to the time `end` by `method`, one after the other on each thread.
    ///
    /// # Errors
    /// Errors of the whole ensemble: [`Error::Setting`], [`Error::EndNotFinite`], [`Error::SampleTime`],
    /// [`EnsembleError::Shard`](super::EnsembleError::Shard), [`NoSuchMember`](super::EnsembleError::NoSuchMember),
    /// [`OtherRun`](super::EnsembleError::OtherRun), [`Untagged`](super::EnsembleError::Untagged),
    /// [`QuantityName`](super::EnsembleError::QuantityName). The errors of single members are in the outcome.
    pub fn integrate<P: Method<L> + Sync>(
        self,
        end: L::Scalar,
        method: P,
    ) -> Result<Outcome<L::Scalar, L::Length>, Error> {
        const { check_contacts(ChecksOf::<L>::HAS_CONTACTS) };
        method.check()?;
        let run = self.plan.fingerprint(&method, end, false);
        self.run(end, run, |job| job.one_by_one::<P, HAS_DENSE_OUTPUT>(&method))
    }

    pub(super) fn run(
        self,
        end: L::Scalar,
        run: Fingerprint,
        work: impl Fn(&Job<'_, L>) + Sync,
    ) -> Result<Outcome<L::Scalar, L::Length>, Error> {
        check_end(end)?;
        let job = Job::new(self.plan, end, run)?;
        everywhere(|| work(&job));
        Ok(job.outcome())
    }
}

impl<L: Lagrangian<Scalar = f64>, const HAS_DENSE_OUTPUT: bool> Ensemble<'_, L, HAS_DENSE_OUTPUT> {
    /// Integrates all members to the time `end` by `method`, on each thread as many at once as [`Lanes`] holds. The
    /// method is `Dop853`, `Dopri5`, [`Taylor`](crate::Taylor) or another [`LaneMethod`].
    ///
    /// Each lane has its own time, step and error, and takes the next member when its motion has ended. Compile with
    /// `RUSTFLAGS="-C target-cpu=native"` to use the lanes of AVX2 or AVX-512. Results differ from those of
    /// [`integrate`](Self::integrate) by rounding, and by as much as the motion amplifies it. A limit on wall-clock
    /// time includes the time that a lane spends with the others. If members differ in a field that lanes
    /// [share](Pack), order them so that members with equal fields are adjacent: a member that does not fit waits until
    /// all lanes are empty.
    ///
    /// # Errors
    /// The errors of [`integrate`](Self::integrate).
    pub fn integrate_on_lanes<P>(self, end: f64, method: P) -> Result<Outcome<f64, L::Length>, Error>
    where
        L: Pack<Lanes, Packed: Lagrangian<N = L::Length, M = L::M, Scalar = Lanes>>,
        P: LaneMethod<L> + Sync,
    {
        const { check_contacts(L::HAS_CONTACTS) };
        method.check()?;
        let run = self.plan.fingerprint(&method, end, true);
        self.run(end, run, |job| job.on_lanes::<P, HAS_DENSE_OUTPUT>(&method))
    }
}

impl<L, const HAS_DENSE_OUTPUT: bool> Debug for Ensemble<'_, L, HAS_DENSE_OUTPUT>
where
    L: Simulate,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Plan { count, shard, shards, .. } = &self.plan;
        f.debug_struct("Ensemble").field("count", count).field("shard", shard).field("of", shards).finish()
    }
}

/// Calls `work` on every thread of rayon's current pool; without rayon, on this thread.
pub(super) fn everywhere(work: impl Fn() + Sync) {
    #[cfg(feature = "rayon")]
    rayon::broadcast(|_| work());
    #[cfg(not(feature = "rayon"))]
    work();
}
