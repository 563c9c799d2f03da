//! Assembly of a mechanism from a rough guess: the nearest consistent state, its rank and degrees of freedom, or the
//! constraints that conflict.

use core::fmt::{self, Display, Formatter};

use nalgebra::Const;

use super::level::Level;
use super::{Adjustment, gradient, make_consistent};
use crate::error::Error;
use crate::names::{Names, name};
use crate::number::limits::DAMPING;
use crate::number::{Real, Scalar, larger, largest, norm, power_of_epsilon, unit_of};
use crate::numerics::newton::{self, Left, Search, dampings};
use crate::numerics::spread::spread;
use crate::solution::eliminate::eliminate;
use crate::solution::kkt::{Rank, Rows};
use crate::solution::limits::STARTS;
use crate::solution::pivot::is_trustworthy;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, Element, Entrywise, StaticLength, Vector, rows};

/// A mechanism that satisfies its constraints, as [`assemble`](crate::Simulate::assemble) finds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assembly<T: Element, N: StaticLength> {
    /// Consistent state.
    pub state: State<T, N>,
    /// Displacement of the state from the guess.
    pub adjustment: Adjustment<T, N>,
    /// Number of independent constraints at the state.
    pub rank: usize,
    /// Number of velocities that can be chosen there: coordinates less independent constraints.
    pub degrees_of_freedom: usize,
    /// Constraints that follow from the others at the state.
    pub redundant: Names,
}

impl<T: Real, N: StaticLength> Display for Assembly<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { adjustment, rank, degrees_of_freedom, redundant, .. } = self;
        write!(
            f,
            "assembled with {degrees_of_freedom} degrees of freedom, {rank} independent constraints; {adjustment}"
        )?;
        match redundant.as_slice() {
            [] => Ok(()),
            _ => write!(f, "; redundant: {redundant}"),
        }
    }
}

/// Implements [`Simulate::assemble`](crate::Simulate::assemble).
pub(crate) fn assemble<L: Lagrangian<Scalar: Real>>(
    system: &L,
    guess: &StateOf<L>,
) -> Result<Assembly<L::Scalar, L::N>, Error> {
    gradient::check_parameters(system, guess)?;
    let free = [Array::filled(false); 2];
    let found = match make_consistent(system, guess, &free) {
        Err(Error::NotProjected { .. } | Error::NoGradient { .. }) => {
            let near = least_residuals(system, guess)?;
            make_consistent(system, &near, &free).map(|(state, _)| state)
        }
        found => found.map(|(state, _)| state),
    };
    let state = found?;
    let (m, f) = (system.mass_matrix(&state).into(), rows(&system.constraint_jacobian(&state)));
    let independent = Rows::of(&m, &f, Rank::on_constraints()).independent();
    let rank = independent.iter().filter(|is_independent| **is_independent).count();
    let redundant =
        (0..<L::M>::COUNT).filter(|&a| !independent[a]).map(|a| name(L::CONSTRAINTS, a)).collect();
    let adjustment = Adjustment { q: state.q.minus(&guess.q), v: state.v.minus(&guess.v) };
    Ok(Assembly { state, adjustment, rank, degrees_of_freedom: <L::N>::COUNT - rank, redundant })
}

/// Jᵀr and JᵀJ.
type NormalEquations<T, N> = (Array<T, N>, Array<Array<T, N>, N>);

/// State of a search for the least residuals: the residuals of the holonomic constraints in units of their gradients at
/// the guess, with the Jacobian in these units.
struct AssemblyTrial<T: Element, N: StaticLength, M: StaticLength> {
    state: State<T, N>,
    value: Array<T, M>,
    jacobian: Array<Array<T, N>, M>,
    damping: T,
}

impl<T: Real, N: StaticLength, M: StaticLength> AssemblyTrial<T, N, M> {
    fn normal_equations(&self) -> NormalEquations<T, N> {
        let sum = |of: &dyn Fn(usize) -> T| (0..M::COUNT).fold(T::constant(0.0), |sum, a| sum + of(a));
        let slope = Array::from_fn(|i| sum(&|a| self.jacobian[a][i] * self.value[a]));
        let square =
            Array::from_fn(|i| Array::from_fn(|j| sum(&|a| self.jacobian[a][i] * self.jacobian[a][j])));
        (slope, square)
    }

    /// True at a minimum: the residuals are orthogonal to every column of the Jacobian.
    fn is_least(&self, slope: &Array<T, N>, square: &Array<Array<T, N>, N>) -> bool {
        let distance = norm::<T>(&self.value);
        let most = |i: usize| distance * Scalar::sqrt(square[i][i]) * power_of_epsilon(1.0 / 3.0);
        (0..N::COUNT).all(|i| Scalar::abs(slope[i]) <= most(i))
    }
}

/// Search for the least squares of the residuals, by the method of Levenberg and Marquardt (Nocedal and Wright,
/// *Numerical Optimization*, 10.3).
struct LeastResiduals<'a, L: Lagrangian> {
    system: &'a L,
    /// Lengths of the gradients at the guess.
    units: Array<L::Scalar, L::M>,
    /// Largest squares so far of the columns of the Jacobian (Moré 1978).
    largest: Array<L::Scalar, L::N>,
}

impl<L: Lagrangian<Scalar: Real>> LeastResiduals<'_, L> {
    fn trial(&self, state: StateOf<L>, damping: L::Scalar) -> AssemblyTrial<L::Scalar, L::N, L::M> {
        let value = self.system.constraint_residual(&state);
        let f = Level::Position.jacobian(self.system, &state);
        AssemblyTrial {
            value: Array::from_fn(|a| value[a] / self.units[a]),
            jacobian: Array::from_fn(|a| Array::from_fn(|i| f[a][i] / self.units[a])),
            state,
            damping,
        }
    }

    /// Weight of the damping of coordinate `i`, in its unit: coordinates outside of a conflict converge as fast as without it.
    fn weight(&self, i: usize) -> L::Scalar {
        unit_of(self.largest[i])
    }

    fn step(
        &self,
        (slope, square): &NormalEquations<L::Scalar, L::N>,
        damping: L::Scalar,
    ) -> Option<Vector<L::Scalar, L::N>> {
        let mut damped = *square;
        (0..<L::N>::COUNT).for_each(|i| damped[i][i] += damping * self.weight(i));
        let step = eliminate::<_, L::N, Const<0>>(damped, slope.map(|x| -x), [].into(), [].into());
        is_trustworthy(&step).then_some(step.accelerations)
    }
}

impl<L: Lagrangian<Scalar: Real>> Search for LeastResiduals<'_, L> {
    type Scalar = L::Scalar;
    /// Largest residual, and the error.
    type Error = (L::Scalar, Error);
    type Trial = AssemblyTrial<L::Scalar, L::N, L::M>;
    type Linear = NormalEquations<L::Scalar, L::N>;

    fn linearize(&mut self, trial: &Self::Trial) -> Result<Self::Linear, Self::Error> {
        let (slope, square) = trial.normal_equations();
        self.largest = Array::from_fn(|i| larger(self.largest[i], square[i][i]));
        Ok((slope, square))
    }

    fn left(&self, _: &Self::Linear, trial: &Self::Trial) -> Left<L::Scalar> {
        let distance = norm::<L::Scalar>(&trial.value);
        let small = residual_scale::<L>(&trial.state.q) * power_of_epsilon::<L::Scalar>(0.25);
        Left {
            distance,
            is_rounded: distance == L::Scalar::constant(0.0),
            is_negligible: largest(&trial.value) <= small,
        }
    }

    fn corrected(
        &self,
        equations: &Self::Linear,
        from: &Self::Trial,
        _: bool,
    ) -> Result<impl Iterator<Item = Self::Trial>, Self::Error> {
        let steps = dampings(from.damping, L::Scalar::constant(1.0))
            .filter_map(move |[damping, next]| Some((self.step(equations, damping)?, next)));
        let is_least = from.is_least(&equations.0, &equations.1);
        Ok(steps.take_while(move |_| !is_least).map(|(step, next)| {
            let state = State { q: from.state.q.each_with(&step, |q, change| q + change), ..from.state };
            self.trial(state, next)
        }))
    }

    #[cold]
    fn not_found(&self, _: &Self::Linear, trial: &Self::Trial, _: usize) -> Self::Error {
        let largest = largest(&trial.value);
        let part = largest * power_of_epsilon::<L::Scalar>(0.25);
        let conflicting = (0..<L::M>::COUNT).filter(|&a| Scalar::abs(trial.value[a]) > part);
        let constraints = conflicting.map(|a| name(L::CONSTRAINTS, a)).collect();
        let (distance, time) = (largest.to_f64(), trial.state.t.to_f64());
        (largest, Error::Conflicting { constraints, distance, time })
    }
}

/// A state near the guess at which the constraints hold. The search begins at the guess, and at states around it if it
/// ends at a minimum of the residuals that is not zero.
///
/// # Errors
/// [`Error::Conflicting`] for the least of these minima, if the constraints hold at none.
#[cold]
#[inline(never)]
fn least_residuals<L: Lagrangian<Scalar: Real>>(system: &L, guess: &StateOf<L>) -> Result<StateOf<L>, Error> {
    let size = residual_scale::<L>(&guess.q);
    let gradients = Level::Position.jacobian(system, guess);
    let units = Array::from_fn(|a| unit_of(norm(&gradients[a])));
    let mut least: Option<(L::Scalar, Error)> = None;
    for start in 0..STARTS {
        let mut state = *guess;
        for i in 0..<L::N>::COUNT {
            // A guess at which a gradient vanishes is no minimum: the search leaves it along a direction
            // without symmetry.
            let part = match start {
                0 => power_of_epsilon(0.5),
                _ => L::Scalar::constant(start as f64 / STARTS as f64),
            };
            state.q[i] += size * part * L::Scalar::constant(spread((i + 1) * (start + 1)));
        }
        let mut search = LeastResiduals { system, units, largest: Array::filled(L::Scalar::constant(0.0)) };
        let first = search.trial(state, L::Scalar::constant(DAMPING));
        match newton::find(&mut search, first) {
            Ok((found, _)) => return Ok(found.state),
            Err(found) if least.as_ref().is_none_or(|least| found.0 < least.0) => least = Some(found),
            Err(_) => {}
        }
    }
    least.map_or(Ok(*guess), |(_, error)| Err(error))
}

/// Largest coordinate, and at least 1: the size of distances that count as small.
fn residual_scale<L: Lagrangian<Scalar: Real>>(q: &Vector<L::Scalar, L::N>) -> L::Scalar {
    q.iter().fold(L::Scalar::constant(1.0), |most, x| larger(most, Scalar::abs(*x)))
}
