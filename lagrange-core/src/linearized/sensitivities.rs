//! A motion with its derivatives by where it starts and by parameters.

use alloc::{string::String, string::ToString, vec::Vec};
use core::fmt::{self, Debug, Formatter};

use super::dual_sample::DifferentiableEvent;
use super::sensitivity::{Sensitivity, at_event};
use super::tangent::{Tangent, WideOf};
use super::variation::{DifferentiableMethod, Variations};
use super::{Direction, Linearized};
use crate::ending::Ending;
use crate::error::Error;
use crate::motion::event::{EventSearch, Watched};
use crate::motion::run::{Run, Watchdog, check_end};
use crate::names::Entry;
use crate::number::{Over, Real, Scalar, Wide};
use crate::solution::flow::{LagrangianFlow, Phase};
use crate::system::finite::check_finite;
use crate::system::{State, lookup};
use crate::trajectory::{Path, Trajectory};

/// A motion, and how it changes with entries of its start and with parameters.
///
/// What changes is named in the call that integrates: coordinates and velocities of the start, and parameters. On
/// constraints, derivatives lie in their tangent space at every time.
pub struct Sensitivities<
    'a,
    L: Linearized<N, M, P, Scalar: Real>,
    const N: usize,
    const M: usize,
    const P: usize,
> {
    trajectory: Trajectory<&'a L, N, M>,
    course: Course<L, N, M, P>,
    end: Result<Sensitivity<L::Scalar, N>, Error>,
}

/// The derivatives along a motion.
struct Course<L: Linearized<N, M, P, Scalar: Real>, const N: usize, const M: usize, const P: usize> {
    /// As they are where the last step ends.
    variations: Variations<L, N, M, P>,
    /// When it does: a motion may have ended within it.
    end: L::Scalar,
    /// Start and length of each step.
    steps: Vec<[L::Scalar; 2]>,
    /// Step by step and block by block, the coefficients of what lies between, as many for each.
    coefficients: Vec<Phase<WideOf<L, N, M>, N>>,
    /// What they are the coefficients of.
    between: Between<WideOf<L, N, M>, N>,
}

/// What lies after a part of a step, by its coefficients.
type Between<W, const N: usize> = fn(&[Phase<W, N>], W) -> Phase<W, N>;

/// See [`AcrossEvents::integrate_sensitivities_until`](super::AcrossEvents::integrate_sensitivities_until).
pub(super) fn integrate<'a, L, D, const N: usize, const M: usize, const P: usize>(
    system: &'a L,
    start: &Sensitivity<L::Scalar, N>,
    end: L::Scalar,
    method: &D,
    events: &mut [&mut dyn DifferentiableEvent<L, N, M, P>],
) -> Result<Sensitivities<'a, L, N, M, P>, Error>
where
    L: Linearized<N, M, P, Scalar: Real>,
    D: DifferentiableMethod<L, N, M, P>,
{
    check_finite(system, &start.state)?;
    check_end(end)?;
    let (mut run, adjustment) = Run::begin::<L, LagrangianFlow, _, M>(system, &start.state, method)?;
    let mut path = Path::from(run.state);
    let (mut course, mut companion) = Course::from(system, &run.state, start, method)?;
    let mut watched: Vec<_> =
        events.iter_mut().map(|event| &mut **event as &mut dyn Watched<L, N, M>).collect();
    let mut search = EventSearch::begin(&mut watched, system, &run.state)?;
    let limits = Watchdog::new(method.limits(), &run.statistics);
    let mut stopped = search.record_due(&run.state, &mut path.crossings);
    let ending = loop {
        if let Some(ending) = stopped {
            break ending;
        }
        if run.state.t == end {
            break Ending::Complete { time: end.to_f64() };
        }
        let variations = &mut course.variations;
        if let Err(ending) = method.prepare(system, &mut run, end, variations, &mut companion) {
            break ending;
        }
        let along = |run: &mut Run<_, _, N>| {
            method.follow(system, run, variations, &mut companion)?;
            let (within, coefficients) = (path.interpolants(), &mut course.coefficients);
            method.interpolate(system, run, variations, &mut companion, within, coefficients)
        };
        if let Err(ending) = run.step_with::<L, LagrangianFlow, _, _, M>(system, method, end, &limits, along)
        {
            break ending;
        }
        course.push(run.before.t, run.state.t);
        path.push(run.state);
        stopped = search.record_in::<LagrangianFlow, _>(&mut path, system, [&run.before, &run.state]);
    };
    let event = path.crossings.last().map(|crossing| crossing.index);
    let event = event.filter(|_| matches!(ending, Ending::Event { .. })).and_then(|index| events.get(index));
    let trajectory = Trajectory::new(system, path.finish(), ending, run.statistics, adjustment);
    let end = trajectory.check_finished().and_then(|()| course.at(system, trajectory.end().state()));
    let end = end.and_then(|at| match event {
        None => Ok(at),
        Some(event) => at_event(system, at, &**event, &run.before),
    });
    Ok(Sensitivities { trajectory, course, end })
}

impl<L, const N: usize, const M: usize, const P: usize> Course<L, N, M, P>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    /// With what the variations take along.
    fn from<D: DifferentiableMethod<L, N, M, P>>(
        system: &L,
        state: &State<L::Scalar, N>,
        start: &Sensitivity<L::Scalar, N>,
        method: &D,
    ) -> Result<(Self, D::Companion), Error> {
        let tangent = Tangent::at(system, state)?;
        // At the time given, not at that of the event where the start is one.
        let column = |j| {
            let Direction { t, q, v } = start.direction(j);
            [q - state.v * t, v - tangent.solution.accelerations * t]
        };
        let variations = Variations::begin(&tangent, start.arguments().to_vec(), column)?;
        let companion = method.companion(system, state, &variations)?;
        let (steps, coefficients) = (Vec::new(), Vec::new());
        Ok((Self { variations, end: state.t, steps, coefficients, between: D::between }, companion))
    }

    /// After a step that was followed.
    fn push(&mut self, start: L::Scalar, end: L::Scalar) {
        self.steps.push([start, end - start]);
        self.end = end;
    }

    /// The derivatives of a state of the motion.
    fn at(&self, system: &L, state: &State<L::Scalar, N>) -> Result<Sensitivity<L::Scalar, N>, Error> {
        let (lanes, blocks) = (<WideOf<L, N, M> as Wide<L::Scalar>>::COUNT, self.variations.blocks.len());
        let mut at = Sensitivity::of(*state, self.variations.arguments().to_vec());
        let found = if state.t == self.end { None } else { self.step(state.t) };
        let tangent = if const { M > 0 } { Some(Tangent::at(system, state)) } else { None };
        let tangent = tangent.transpose()?;
        for block in 0..blocks {
            let mut y = match found {
                None => *self.variations.block(block),
                Some((step, part)) => {
                    let each = self.coefficients.len() / (self.steps.len() * blocks);
                    let first = each * (step * blocks + block);
                    (self.between)(&self.coefficients[first..first + each], WideOf::<L, N, M>::of(part))
                }
            };
            if let Some(tangent) = &tangent {
                y = self.variations.projected(block, tangent, y)?;
            }
            for column in lanes * block..at.arguments().len().min(lanes * (block + 1)) {
                let [q, v] = y.map(|half| half.map(|x| x.lane(column - lanes * block)));
                at.set(column, [&q, &v]);
            }
        }
        Ok(at)
    }

    /// The step of this time, and which part of it has passed.
    fn step(&self, t: L::Scalar) -> Option<(usize, L::Scalar)> {
        let is_past = |[start, length]: &[L::Scalar; 2]| (t - *start) / *length >= L::Scalar::constant(0.0);
        let step = self.steps.partition_point(is_past).checked_sub(1)?;
        let [start, length] = self.steps[step];
        Some((step, (t - start) / length))
    }
}

impl<L, const N: usize, const M: usize, const P: usize> Debug for Sensitivities<'_, L, N, M, P>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut sensitivities = f.debug_struct("Sensitivities");
        sensitivities.field("trajectory", &self.trajectory).field("arguments", &self.arguments()).finish()
    }
}

impl<'a, L, const N: usize, const M: usize, const P: usize> Sensitivities<'a, L, N, M, P>
where
    L: Linearized<N, M, P, Scalar: Real>,
{
    /// The motion, if nothing but an event kept it from its end.
    ///
    /// # Errors
    /// [`Error::Unfinished`] with the ending.
    pub fn finished(self) -> Result<Self, Error> {
        self.trajectory.check_finished()?;
        Ok(self)
    }

    /// The motion.
    pub fn trajectory(&self) -> &Trajectory<&'a L, N, M> {
        &self.trajectory
    }

    /// The motion alone, for a leg of a [`Journey`](crate::Journey) say.
    pub fn into_trajectory(self) -> Trajectory<&'a L, N, M> {
        self.trajectory
    }

    /// The arguments, in the order of the columns.
    pub fn arguments(&self) -> &[Entry] {
        self.course.variations.arguments()
    }

    /// The state at this time and its derivatives.
    ///
    /// # Errors
    /// As [`Trajectory::at`]; as [`Linearized::jacobian`].
    pub fn at(&self, t: L::Scalar) -> Result<Sensitivity<L::Scalar, N>, Error> {
        self.course.at(self.trajectory.system(), self.trajectory.at(t)?.state())
    }

    /// The last state and its derivatives: at an event, where one has ended the motion, with those of its time; else at
    /// the end that was asked for.
    ///
    /// # Errors
    /// [`Error::Unfinished`] where the motion got to neither; [`Error::Grazing`], and [`Error::EventNotFinite`] where the function of the event has no derivative; as
    /// [`at`](Self::at).
    pub fn end(&self) -> Result<&Sensitivity<L::Scalar, N>, Error> {
        self.end.as_ref().map_err(Error::clone)
    }

    /// The derivative of coordinate `coordinate` by `argument` at this time.
    ///
    /// # Errors
    /// As [`at`](Self::at); [`Error::UnknownName`].
    pub fn coordinate(&self, t: L::Scalar, coordinate: &str, argument: &str) -> Result<L::Scalar, Error> {
        let row = lookup::index::<L, N, M>(&L::COORDINATES, "coordinate", coordinate)?;
        let names: Vec<String> = self.arguments().iter().map(Entry::to_string).collect();
        let column = lookup::index::<L, N, M>(&names, "argument of these derivatives", argument)?;
        Ok(self.at(t)?.q[(row, column)])
    }
}
