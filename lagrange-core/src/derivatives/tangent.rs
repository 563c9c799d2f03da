//! Directional derivatives of accelerations and multipliers: K δ(q̈, λ) = −∂R, with one factorization for all
//! directions.

use core::cell::OnceCell;
use core::ops::Range;

use nalgebra::ComplexField;

use super::jacobian::name_of;
use super::{Linearized, StateDerivatives};
use crate::error::Error;
use crate::names::Entry;
use crate::number::Broadcast;
use crate::number::{Real, Scalar, Wide};
use crate::room::Room;
use crate::solution::kkt::{Factors, Rank};
use crate::solution::pivot::{is_trustworthy, least_pivot};
use crate::solution::solve::{fault, first_row, solve};
use crate::system::Direction;
use crate::system::{ConstraintKind, unit};
use crate::system::{Lagrangian, ResidualChange, Solution, SolutionOf, State, StateOf, System};
use crate::vector::from_fn;
use crate::vector::{Array, Element, Entrywise, StaticLength, Vector, rows, zeros};

/// Equations of motion at a state: solved, factorized and differentiated.
pub(crate) struct Tangent<'a, L: StateDerivatives> {
    pub(crate) system: &'a L,
    pub(crate) state: &'a StateOf<L>,
    pub(crate) solution: SolutionOf<L>,
    factor: L::Factor,
    slopes: OnceCell<L::Slopes>,
    matrices: OnceCell<Matrices<L::Scalar, L::N, L::M>>,
}

/// SIMD type of preferred width for the numbers of the system.
pub(crate) type WideOf<L> = <<L as System>::Scalar as Real>::Wide;

/// Mass matrix, constraint Jacobian and factors of the general solver. They are used if the pivot of the
/// emitted factorization is too small, or if rows and null spaces are needed.
pub(crate) struct Matrices<T: Element, N: StaticLength, M: StaticLength> {
    /// Mass matrix, row by row.
    pub(crate) m: Room<Array<Array<T, N>, N>>,
    /// Constraint Jacobian, row by row.
    pub(crate) f: Room<Array<Array<T, N>, M>>,
    pub(crate) factors: Room<Factors<T, N, M>>,
}

// Separate functions, so that at most one of the matrices is on the stack.

#[inline(never)]
fn mass_rows<L: Lagrangian>(system: &L, state: &StateOf<L>) -> Room<Array<Array<L::Scalar, L::N>, L::N>> {
    Room::of(system.mass_matrix(state).into())
}

#[inline(never)]
fn constraint_rows<L: Lagrangian>(
    system: &L,
    state: &StateOf<L>,
) -> Room<Array<Array<L::Scalar, L::N>, L::M>> {
    Room::of(rows(&system.constraint_jacobian(state)))
}

impl<T: Real, N: StaticLength, M: StaticLength> Matrices<T, N, M> {
    fn at<L: Lagrangian<N = N, M = M, Scalar = T>>(system: &L, state: &State<T, N>) -> Self {
        let (m, f) = (mass_rows(system, state), constraint_rows(system, state));
        // Off the constraints, dependent ones may contradict each other: rows left out as dependent are not
        // checked.
        let factors = Room::of(Factors::of(&m, &f, Rank::off_constraints()));
        Self { m, f, factors }
    }
}

impl<'a, L: StateDerivatives<Scalar: Real>> Tangent<'a, L> {
    pub(crate) fn at(system: &'a L, state: &'a StateOf<L>) -> Result<Self, Error> {
        Ok(Self::of(system, state, solve(system, state)?))
    }

    /// Builds the tangent from a known solution of the equations.
    #[inline]
    pub(crate) fn of(system: &'a L, state: &'a StateOf<L>, solution: SolutionOf<L>) -> Self {
        let factor = system.factor(state);
        Self { system, state, solution, factor, slopes: OnceCell::new(), matrices: OnceCell::new() }
    }

    /// Returns the slopes of the residual, computed at first use and in place: they may be large.
    fn slopes(&self) -> &L::Slopes {
        self.slopes.get_or_init(|| self.system.residual_slopes(self.state, &self.solution))
    }

    /// Returns the matrices and the factors of the general solver, computed at first use.
    pub(crate) fn matrices(&self) -> &Matrices<L::Scalar, L::N, L::M> {
        self.matrices.get_or_init(|| Matrices::at(self.system, self.state))
    }

    /// Rows of F for holonomic constraints; zeros for the others.
    pub(crate) fn holonomic_rows(&self) -> Array<Array<L::Scalar, L::N>, L::M> {
        let f = &self.matrices().f;
        from_fn(|a| match L::CONSTRAINT_KINDS[a] {
            ConstraintKind::Holonomic => f[a],
            ConstraintKind::Velocity => Array::filled(L::Scalar::constant(0.0)),
        })
    }

    /// Passes δq̈ and δλ along each of `count` directions to `give`. Directions are processed one per lane: `put`
    /// writes direction `k` into a zero lane, `entry` names it for errors.
    pub(crate) fn along_each(
        &self,
        count: usize,
        put: impl Fn(usize, &mut Direction<WideOf<L>, L::N>, usize),
        entry: impl Fn(usize) -> Entry,
        mut give: impl FnMut(usize, &SolutionOf<L>),
    ) -> Result<(), Error> {
        let changes = |block: Range<usize>| {
            let mut directions = Direction::<WideOf<L>, L::N>::zero();
            block.clone().for_each(|k| put(k, &mut directions, k - block.start));
            self.changes(&directions)
        };
        self.respond_to_each(count, changes, entry, &mut give)
    }

    /// Passes the δq̈ and δλ that compensate each of `count` changes of the residual to `give`. `changes` computes those
    /// of a range, one per lane.
    fn respond_to_each(
        &self,
        count: usize,
        changes: impl Fn(Range<usize>) -> ResidualChange<WideOf<L>, L::N, L::M>,
        entry: impl Fn(usize) -> Entry,
        give: &mut impl FnMut(usize, &SolutionOf<L>),
    ) -> Result<(), Error> {
        for first in (0..count).step_by(WideOf::<L>::COUNT) {
            let block = first..count.min(first + WideOf::<L>::COUNT);
            let changes = changes(block.clone());
            // In its own place: a copy of all lanes would take a few percent of the time.
            let mut responses =
                self.system.solve_with(&self.factor, &changes.motion.negated(), &changes.acceleration);
            self.mend(block.len(), &changes, |lane| entry(first + lane), &mut responses)?;
            block.for_each(|k| give(k, &responses.lane(k - first)));
        }
        Ok(())
    }

    /// Passes δq̈ and δλ by each of `count` arguments to `give`, with the number of the argument: 0 is the time, then
    /// coordinates, then velocities.
    pub(crate) fn by_each(
        &self,
        count: usize,
        argument: impl Fn(usize) -> usize,
        mut give: impl FnMut(usize, &SolutionOf<L>),
    ) -> Result<(), Error> {
        self.respond_to_each(
            count,
            |block| self.changes_by(block.map(&argument)),
            |k| name_of::<L>(argument(k)),
            &mut give,
        )
    }

    /// Passes δq̈ and δλ by each of these arguments to `give`, but for those by which they are zero: 0 is the time, then
    /// coordinates, then velocities.
    pub(crate) fn by_arguments(
        &self,
        arguments: Range<usize>,
        mut give: impl FnMut(usize, &SolutionOf<L>),
    ) -> Result<(), Error> {
        let known = L::STATE_ARGUMENTS;
        let place = |end| known.map_or(end, |all| all.partition_point(|&argument| argument < end));
        let (first, last) = (place(arguments.start), place(arguments.end));
        let argument = |k: usize| known.map_or(first + k, |all| all[first + k]);
        self.by_each(last - first, argument, |k, change| give(argument(k), change))
    }

    /// Passes δq̈ and δλ by each of these parameters to `give`.
    pub(crate) fn by_parameters(
        &self,
        count: usize,
        parameter: impl Fn(usize) -> usize,
        mut give: impl FnMut(usize, &SolutionOf<L>),
    ) -> Result<(), Error>
    where
        L: Linearized,
    {
        if count == 0 {
            return Ok(());
        }
        let slopes = self.parameter_slopes();
        let changes = |block: Range<usize>| {
            let mut rates = zeros::<WideOf<L>, L::P>();
            block.clone().for_each(|k| rates[parameter(k)].put(k - block.start, L::Scalar::constant(1.0)));
            self.changes_by_parameters(&slopes, &rates)
        };
        self.respond_to_each(count, changes, |k| Entry::Parameter(L::PARAMETERS[parameter(k)]), &mut give)
    }

    /// Derivatives of the residual along these directions.
    #[inline]
    pub(crate) fn changes(
        &self,
        directions: &Direction<WideOf<L>, L::N>,
    ) -> ResidualChange<WideOf<L>, L::N, L::M> {
        self.system.residual_change_with(self.slopes(), directions)
    }

    /// Derivatives of the residual by these arguments, one per lane.
    pub(crate) fn changes_by(
        &self,
        arguments: impl Iterator<Item = usize> + Clone,
    ) -> ResidualChange<WideOf<L>, L::N, L::M> {
        self.system.residual_change_by(self.slopes(), arguments)
    }

    /// Numbers from which the derivatives of the residual by parameters are computed.
    pub(crate) fn parameter_slopes(&self) -> L::ParameterSlopes
    where
        L: Linearized,
    {
        self.system.residual_slopes_by_parameters(self.state, &self.solution)
    }

    /// Derivatives of the residual if parameters change at these rates.
    #[inline]
    pub(crate) fn changes_by_parameters(
        &self,
        slopes: &L::ParameterSlopes,
        rates: &Vector<WideOf<L>, L::P>,
    ) -> ResidualChange<WideOf<L>, L::N, L::M>
    where
        L: Linearized,
    {
        self.system.residual_change_by_parameters_with(slopes, rates)
    }

    /// Derivative of the residual along this direction. It is computed on all lanes, so that the long function is
    /// compiled for lanes alone.
    fn change_in(&self, direction: &Direction<L::Scalar, L::N>) -> ResidualChange<L::Scalar, L::N, L::M> {
        let of = WideOf::<L>::of;
        let Direction { t, q, v } = direction;
        self.changes(&Direction { t: of(*t), q: q.each(of), v: v.each(of) }).lane(0)
    }

    /// Derivative of the residual if the state changes along this direction, and the argument at unit rate if it is a
    /// parameter of the system.
    pub(crate) fn change_with(
        &self,
        direction: &Direction<L::Scalar, L::N>,
        argument: Option<Entry>,
    ) -> ResidualChange<L::Scalar, L::N, L::M>
    where
        L: Linearized,
    {
        let change = self.change_in(direction);
        let Some(k) = argument.and_then(parameter::<L>) else { return change };
        change.plus(&self.changes_by_parameters(&self.parameter_slopes(), &unit(k)).lane(0))
    }

    /// Solves for the δq̈ and δλ that compensate this change of the residual; `entry` names it for errors.
    pub(crate) fn response(
        &self,
        change: &ResidualChange<L::Scalar, L::N, L::M>,
        entry: Entry,
    ) -> Result<SolutionOf<L>, Error> {
        Ok(self.responses(1, &change.each(WideOf::<L>::of), |_| entry)?.lane(0))
    }

    /// Solves for the δq̈ and δλ that compensate these changes of the residual, in `lanes` lanes; `entry` names a lane
    /// for errors.
    #[inline]
    pub(crate) fn responses(
        &self,
        lanes: usize,
        changes: &ResidualChange<WideOf<L>, L::N, L::M>,
        entry: impl Fn(usize) -> Entry,
    ) -> Result<Solution<WideOf<L>, L::N, L::M>, Error> {
        let mut responses =
            self.system.solve_with(&self.factor, &changes.motion.negated(), &changes.acceleration);
        self.mend(lanes, changes, entry, &mut responses)?;
        Ok(responses)
    }

    /// Solves again in those of the first `lanes` lanes in which the emitted factor does not.
    #[inline]
    fn mend(
        &self,
        lanes: usize,
        changes: &ResidualChange<WideOf<L>, L::N, L::M>,
        entry: impl Fn(usize) -> Entry,
        responses: &mut Solution<WideOf<L>, L::N, L::M>,
    ) -> Result<(), Error> {
        if are_sound::<L::Scalar, L::N, L::M>(changes, responses) {
            return Ok(());
        }
        for lane in 0..lanes {
            let change = self.checked(changes.lane(lane), entry(lane))?;
            if !is_trustworthy::<L::Scalar, _, _>(&responses.lane(lane)) {
                self.respond_in_general(&change, entry(lane), (responses, lane))?;
            }
        }
        Ok(())
    }

    /// Writes the δq̈ and δλ that compensate a change into a lane, by the general solver.
    #[cold]
    fn respond_in_general(
        &self,
        change: &ResidualChange<L::Scalar, L::N, L::M>,
        entry: Entry,
        (responses, lane): (&mut Solution<WideOf<L>, L::N, L::M>, usize),
    ) -> Result<(), Error> {
        let (time, factors) = (self.state.t.to_f64(), &self.matrices().factors);
        let Solution { accelerations, multipliers, .. } = factors
            .solve(&change.motion.negated().into(), &change.acceleration.into())
            .map_err(|found| fault::<L>(&found, time))?;
        self.check_finite(&accelerations, &[multipliers], entry)?;
        let places = responses.accelerations.iter_mut().chain(&mut responses.multipliers);
        places.zip(accelerations.iter().chain(&multipliers)).for_each(|(wide, x)| wide.put(lane, *x));
        Ok(())
    }

    /// Derivative of the residual along one direction; an error if it is not finite.
    pub(crate) fn residual_change(
        &self,
        direction: &Direction<L::Scalar, L::N>,
        entry: Entry,
    ) -> Result<ResidualChange<L::Scalar, L::N, L::M>, Error> {
        self.checked(self.change_in(direction), entry)
    }

    /// Derivative of the residual by parameter `k`, with these accelerations and multipliers; an error if it is not
    /// finite.
    pub(crate) fn change_by_parameter(
        &self,
        solution: &SolutionOf<L>,
        k: usize,
    ) -> Result<ResidualChange<L::Scalar, L::N, L::M>, Error>
    where
        L: Linearized,
    {
        let slopes = self.system.residual_slopes_by_parameters(self.state, solution);
        let change = self.changes_by_parameters(&slopes, &unit(k)).lane(0);
        self.checked(change, Entry::Parameter(L::PARAMETERS[k]))
    }

    fn checked(
        &self,
        change: ResidualChange<L::Scalar, L::N, L::M>,
        entry: Entry,
    ) -> Result<ResidualChange<L::Scalar, L::N, L::M>, Error> {
        let ResidualChange { motion, acceleration, rate, position } = change;
        self.check_finite(&motion, &[acceleration, rate, position], entry)?;
        Ok(change)
    }

    /// Fails at the first row, of a coordinate or a constraint, that is not finite, and names it.
    fn check_finite(
        &self,
        motion: &Vector<L::Scalar, L::N>,
        constraints: &[Vector<L::Scalar, L::M>],
        entry: Entry,
    ) -> Result<(), Error> {
        let finite = |a: usize| constraints.iter().all(|x| x[a].is_finite());
        match first_row::<L>(|i| !motion[i].is_finite(), |a| !finite(a)) {
            None => Ok(()),
            Some(row) => Err(Error::DerivativeNotFinite { row, entry, time: self.state.t.to_f64() }),
        }
    }
}

/// Index of this parameter among those of the system; `None` if the system does not have it.
pub(crate) fn parameter<L: Linearized>(entry: Entry) -> Option<usize> {
    match entry {
        Entry::Parameter(name) => L::PARAMETERS.iter().position(|known| *known == name),
        _ => None,
    }
}

/// True if all lanes are reliable: the pivots are large enough, and the sum of all magnitudes is finite, hence every
/// number.
#[inline]
fn are_sound<T: Real, N: StaticLength, M: StaticLength>(
    changes: &ResidualChange<T::Wide, N, M>,
    responses: &Solution<T::Wide, N, M>,
) -> bool {
    let ResidualChange { motion, acceleration, rate, position } = changes;
    let Solution { accelerations, multipliers, pivot, .. } = responses;
    let mut size = sum_of_magnitudes(T::Wide::constant(0.0), motion.as_slice());
    size = sum_of_magnitudes(size, accelerations.as_slice());
    for constraints in [acceleration, rate, position, multipliers] {
        size = sum_of_magnitudes(size, constraints.as_slice());
    }
    (0..T::Wide::COUNT).all(|lane| pivot.lane(lane) > least_pivot() && size.lane(lane).is_finite())
}

#[inline(always)]
fn sum_of_magnitudes<W: Scalar>(start: W, numbers: &[W]) -> W {
    numbers.iter().fold(start, |sum, x| sum + x.abs())
}
