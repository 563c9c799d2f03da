//! Assembly of a mechanism from a rough guess: the nearest consistent state, its rank and degrees of freedom, or the
//! constraints that conflict.

use core::fmt::{self, Display, Formatter};

use nalgebra::Const;

use super::level::Level;
use super::{Adjustment, gradient, make_consistent};
use crate::error::Error;
use crate::names::{Names, name};
use crate::number::{Real, Scalar, larger, largest, norm, power_of_epsilon, unit_of};
use crate::solution::eliminate::eliminate;
use crate::solution::kkt::{Rank, Rows};
use crate::solution::pivot::is_trustworthy;
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, Element, Entrywise, StaticLength, Vector, rows};

/// Largest number of steps of the search for the least residuals.
const STEPS: usize = 300;
/// Number of states from which the search begins.
const STARTS: usize = 10;
/// Golden section: the fractional parts of its multiples are evenly distributed.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Factors of the damping after a step that reduces the residuals, and after one that does not.
const DAMPING: [f64; 2] = [0.3, 4.0];

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

/// Residuals of the holonomic constraints in units of their gradients at the guess, with the Jacobian in
/// these units.
struct LinearResiduals<T: Element, N: StaticLength, M: StaticLength> {
    value: Array<T, M>,
    jacobian: Array<Array<T, N>, M>,
    square: T,
}

impl<T: Real, N: StaticLength, M: StaticLength> LinearResiduals<T, N, M> {
    fn at<L: Lagrangian<N = N, M = M, Scalar = T>>(
        system: &L,
        state: &StateOf<L>,
        units: &Array<T, M>,
    ) -> Self {
        let (value, f) = (system.constraint_residual(state), Level::Position.jacobian(system, state));
        let value = Array::from_fn(|a| value[a] / units[a]);
        let jacobian = Array::from_fn(|a| Array::from_fn(|i| f[a][i] / units[a]));
        let square = value.iter().fold(T::constant(0.0), |sum, x| sum + *x * *x);
        Self { value, jacobian, square }
    }

    /// Jᵀr and JᵀJ.
    fn normal_equations(&self) -> (Array<T, N>, Array<Array<T, N>, N>) {
        let sum = |of: &dyn Fn(usize) -> T| (0..M::COUNT).fold(T::constant(0.0), |sum, a| sum + of(a));
        let slope = Array::from_fn(|i| sum(&|a| self.jacobian[a][i] * self.value[a]));
        let square =
            Array::from_fn(|i| Array::from_fn(|j| sum(&|a| self.jacobian[a][i] * self.jacobian[a][j])));
        (slope, square)
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
    let mut least = None;
    for start in 0..STARTS {
        let mut state = *guess;
        for i in 0..<L::N>::COUNT {
            // A guess at which a gradient vanishes is no minimum: the search leaves it along a direction
            // without symmetry.
            let part = if start == 0 { 1e-6 } else { start as f64 / STARTS as f64 };
            let direction = GOLDEN * ((i + 1) * (start + 1)) as f64 % 1.0 - 0.5;
            state.q[i] += size * L::Scalar::constant(part * direction);
        }
        match minimum(system, guess, state) {
            Ok(state) => return Ok(state),
            Err((distance, error)) => {
                if least.as_ref().is_none_or(|(least, _)| distance < *least) {
                    least = Some((distance, error));
                }
            }
        }
    }
    match least {
        Some((_, error)) => Err(error),
        None => Ok(*guess),
    }
}

/// Returns the minimum of the squared residuals near a state, by the method of Levenberg and Marquardt
/// (Nocedal and Wright, *Numerical Optimization*, 10.3). If the constraints do not hold there, returns the
/// largest residual and the error.
fn minimum<L: Lagrangian<Scalar: Real>>(
    system: &L,
    guess: &StateOf<L>,
    mut state: StateOf<L>,
) -> Result<StateOf<L>, (L::Scalar, Error)> {
    let gradients = Level::Position.jacobian(system, guess);
    let units = Array::from_fn(|a| unit_of(norm(&gradients[a])));
    let mut damping = L::Scalar::constant(1e-3);
    let mut residuals = LinearResiduals::at(system, &state, &units);
    for _ in 0..STEPS {
        let (slope, square) = residuals.normal_equations();
        // At a minimum the residuals are orthogonal to every column of the Jacobian.
        let is_orthogonal = |i: usize| {
            let most = Scalar::sqrt(square[i][i] * residuals.square);
            Scalar::abs(slope[i]) <= most * power_of_epsilon::<L::Scalar>(1.0 / 3.0)
        };
        if (0..<L::N>::COUNT).all(is_orthogonal) {
            break;
        }
        let trace = (0..<L::N>::COUNT).fold(L::Scalar::constant(0.0), |sum, i| sum + square[i][i]);
        // Damping in the unit of each coordinate: coordinates outside of a conflict converge as fast as
        // without it.
        let own = |i: usize| square[i][i] + L::Scalar::constant(1e-9) * trace;
        let damped = Array::from_fn(|i| {
            Array::from_fn(|j| if i == j { square[i][i] + damping * own(i) } else { square[i][j] })
        });
        let step = eliminate::<_, L::N, Const<0>>(damped, slope.map(|x| -x), [].into(), [].into());
        let mut next = state;
        (0..<L::N>::COUNT).for_each(|i| next.q[i] += step.accelerations[i]);
        let there = LinearResiduals::at(system, &next, &units);
        let is_nearer = is_trustworthy(&step) && there.square < residuals.square;
        damping *= L::Scalar::constant(DAMPING[usize::from(!is_nearer)]);
        if is_nearer {
            (state, residuals) = (next, there);
        } else if damping > L::Scalar::constant(1e12) {
            break;
        }
    }
    let largest = largest(&residuals.value);
    let size = residual_scale::<L>(&state.q);
    if largest <= size * power_of_epsilon::<L::Scalar>(0.25) {
        return Ok(state);
    }
    let part = largest * power_of_epsilon::<L::Scalar>(0.25);
    let conflicting = (0..<L::M>::COUNT).filter(|&a| Scalar::abs(residuals.value[a]) > part);
    let constraints = conflicting.map(|a| name(L::CONSTRAINTS, a)).collect();
    Err((largest, Error::Conflicting { constraints, distance: largest.to_f64(), time: guess.t.to_f64() }))
}

/// Largest coordinate, and at least 1: the size of distances that count as small.
fn residual_scale<L: Lagrangian<Scalar: Real>>(q: &Vector<L::Scalar, L::N>) -> L::Scalar {
    q.iter().fold(L::Scalar::constant(1.0), |most, x| larger(most, Scalar::abs(*x)))
}
