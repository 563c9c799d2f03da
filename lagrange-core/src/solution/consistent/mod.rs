//! Consistent states: coordinates on Φ = 0, velocities on F q̇ + b = 0.
//!
//! Newton's iteration with corrections δ that are least in the metric of the mass matrix: M δ − Fᵀμ = 0,
//! F δ = −residual, the system of the dynamics with other right-hand sides (Hairer, Lubich and Wanner,
//! *Geometric Numerical Integration*, IV.4).

#[cfg(test)]
mod tests;

use core::array::from_fn;
use core::fmt::{self, Display, Formatter};
use nalgebra::{ComplexField, SVector};

use crate::number::numeric::{exceeds, largest, power_of_epsilon};
use crate::solution::eliminate::eliminate_active;
use crate::solution::kkt::{self, Equations, Rank};
use crate::solution::solve::{is_trustworthy, name};
use crate::{ConstraintKind, Error, Lagrangian, Real, Scalar, State};

/// Newton iterations before giving up; a start within its reach takes four or five.
const ITERATIONS: usize = 50;

/// How far a projection onto the constraints moved a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adjustment<T, const N: usize> {
    /// New minus old generalized coordinates.
    pub q: SVector<T, N>,
    /// New minus old generalized velocities.
    pub v: SVector<T, N>,
}

impl<T: Real, const N: usize> Adjustment<T, N> {
    /// The largest change of a coordinate, in magnitude.
    pub fn largest_coordinate_change(&self) -> T {
        largest(self.q.as_slice())
    }

    /// The largest change of a velocity, in magnitude.
    pub fn largest_velocity_change(&self) -> T {
        largest(self.v.as_slice())
    }
}

impl<T: Real, const N: usize> Display for Adjustment<T, N> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (q, v) = (self.largest_coordinate_change().to_f64(), self.largest_velocity_change().to_f64());
        write!(f, "coordinates moved by at most {q:e}, velocities by at most {v:e}")
    }
}

/// The consistent state and how far it is from the one given.
pub type Consistent<T, const N: usize> = (State<T, N>, Adjustment<T, N>);

/// See [`Simulate::make_consistent`](crate::Simulate::make_consistent).
pub(crate) fn make_consistent<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<Consistent<L::Scalar, N>, Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let mut consistent = *state;
    project(system, &mut consistent)?;
    Ok((consistent, Adjustment { q: consistent.q - state.q, v: consistent.v - state.v }))
}

/// Moves the state to the nearest consistent one.
pub(crate) fn project<L, const N: usize, const M: usize>(
    system: &L,
    state: &mut State<L::Scalar, N>,
) -> Result<(), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    project_coordinates(system, state)?;
    newton::<L, Velocity, N, M>(system, state)
}

/// Moves the coordinates to the nearest ones on Φ = 0.
pub(crate) fn project_coordinates<L, const N: usize, const M: usize>(
    system: &L,
    state: &mut State<L::Scalar, N>,
) -> Result<(), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    newton::<L, Position, N, M>(system, state)
}

/// See [`Simulate::check_consistent`](crate::Simulate::check_consistent).
pub(crate) fn check<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<(), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    check_level::<L, Position, N, M>(system, state)?;
    check_level::<L, Velocity, N, M>(system, state)
}

fn check_level<L, K, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<(), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
    K: Level,
{
    let residual = Residual::of::<L, K>(system, state);
    match residual.first_above(power_of_epsilon(0.5)) {
        None => Ok(()),
        Some(row) => Err(Error::Inconsistent {
            constraint: name(&L::CONSTRAINTS, row),
            rate: K::RATE,
            residual: residual.value[row].to_f64(),
            time: state.t.to_f64(),
        }),
    }
}

/// What is projected: the coordinates onto the holonomic constraints, or the velocities onto all.
trait Level {
    const RATE: bool;

    /// The entries that move.
    fn unknowns<T, const N: usize>(state: &mut State<T, N>) -> &mut SVector<T, N>;

    fn is_active(kind: ConstraintKind) -> bool;
}

struct Position;
struct Velocity;

impl Level for Position {
    const RATE: bool = false;

    fn unknowns<T, const N: usize>(state: &mut State<T, N>) -> &mut SVector<T, N> {
        &mut state.q
    }

    fn is_active(kind: ConstraintKind) -> bool {
        kind == ConstraintKind::Holonomic
    }
}

impl Level for Velocity {
    const RATE: bool = true;

    fn unknowns<T, const N: usize>(state: &mut State<T, N>) -> &mut SVector<T, N> {
        &mut state.v
    }

    fn is_active(_: ConstraintKind) -> bool {
        true
    }
}

/// What should be zero, with the Jacobian and the size of the terms that it is the sum of.
struct Residual<T, const N: usize, const M: usize> {
    value: [T; M],
    jacobian: [[T; N]; M],
    /// Σ |F_αa| |x_a|: of this, a part ε is round-off.
    terms: [T; M],
    /// Σ |F_αa|: the terms where the unknowns are about 1.
    sensitivity: [T; M],
    active: [bool; M],
}

impl<T: Real, const N: usize, const M: usize> Residual<T, N, M> {
    fn of<L, K>(system: &L, state: &State<T, N>) -> Self
    where
        L: Lagrangian<N, M, Scalar = T>,
        K: Level,
    {
        let zero = T::constant(0.0);
        let active = L::CONSTRAINT_KINDS.map(K::is_active);
        let jacobian = system.constraint_jacobian(state);
        let jacobian = from_fn(|a| from_fn(|i| if active[a] { jacobian[(a, i)] } else { zero }));
        let value = if K::RATE { system.constraint_rate(state) } else { system.constraint_residual(state) };
        let x = *K::unknowns(&mut { *state });
        Self {
            value: from_fn(|a| if active[a] { value[a] } else { zero }),
            terms: jacobian.map(|row| magnitude(from_fn::<T, N, _>(|i| row[i] * x[i]))),
            sensitivity: jacobian.map(magnitude),
            jacobian,
            active,
        }
    }

    /// The first constraint with a residual of more than this part of its terms (and of ε^(3/4) where they vanish).
    fn first_above(&self, part: T) -> Option<usize> {
        let floor = power_of_epsilon::<T>(0.75);
        let bound = |a: usize| part * self.terms[a] + floor * self.sensitivity[a];
        (0..M).find(|&a| exceeds(Scalar::abs(self.value[a]), bound(a)))
    }

    /// Whether nothing but round-off is left.
    fn is_rounded(&self) -> bool {
        let bound = |a: usize| T::constant(4.0 * T::EPSILON) * self.terms[a];
        (0..M).all(|a| Scalar::abs(self.value[a]) <= bound(a))
    }

    /// Whether what is left may be round-off of terms that cancel.
    fn is_negligible(&self) -> bool {
        self.first_above(T::constant(16.0 * T::EPSILON)).is_none()
    }

    /// The distance to the constraint farthest off, as if each stood alone, and which one that is.
    fn distance(&self) -> (T, usize) {
        let zero = T::constant(0.0);
        let mut farthest = (zero, 0);
        for a in 0..M {
            let value = Scalar::abs(self.value[a]);
            let distance = if self.sensitivity[a] > zero { value / self.sensitivity[a] } else { value };
            // What is not a number is farthest of all, and stays that.
            if is_number(farthest.0) && exceeds(distance, farthest.0) {
                farthest = (distance, a);
            }
        }
        farthest
    }
}

/// Whether `x` is anything but NaN.
fn is_number<T: Real>(x: T) -> bool {
    x.partial_cmp(&x).is_some()
}

/// Σ |x_i|.
fn magnitude<T: Real, const N: usize>(x: [T; N]) -> T {
    x.iter().fold(T::constant(0.0), |sum, x| sum + Scalar::abs(*x))
}

/// Newton's iteration to round-off.
fn newton<L, K, const N: usize, const M: usize>(
    system: &L,
    state: &mut State<L::Scalar, N>,
) -> Result<(), Error>
where
    L: Lagrangian<N, M, Scalar: Real>,
    K: Level,
{
    if !L::CONSTRAINT_KINDS.iter().any(|kind| K::is_active(*kind)) {
        return Ok(());
    }
    let half = L::Scalar::constant(0.5);
    let mut residual = Residual::of::<L, K>(system, state);
    for iteration in 0..ITERATIONS {
        if residual.is_rounded() {
            return Ok(());
        }
        let before = residual.distance().0;
        // Constraints nearly dependent here are dependent where they hold, as a rule; if not, they all count.
        let mut step_with = |rank| {
            let step = correction(system, state, &residual, rank)?;
            descend::<L, K, N, M>(system, state, &residual, step)
        };
        let next = step_with(Rank::towards_constraints()).or_else(|| step_with(Rank::off_constraints()));
        let converged = residual.is_negligible();
        match next {
            Some(next) if converged && next.distance().0 > half * before => return Ok(()),
            Some(next) => residual = next,
            None if converged => return Ok(()),
            None => return Err(not_projected::<L, N, M>(state, &residual, iteration)),
        }
    }
    Err(not_projected::<L, N, M>(state, &residual, ITERATIONS))
}

/// Takes the step, halved while it leads away from the constraints; `None`, and no step, where nothing helps.
fn descend<L, K, const N: usize, const M: usize>(
    system: &L,
    state: &mut State<L::Scalar, N>,
    residual: &Residual<L::Scalar, N, M>,
    mut step: SVector<L::Scalar, N>,
) -> Option<Residual<L::Scalar, N, M>>
where
    L: Lagrangian<N, M, Scalar: Real>,
    K: Level,
{
    let start = *K::unknowns(state);
    // Where only round-off is left, halving cannot help.
    let attempts = if residual.is_negligible() { 1 } else { 12 };
    for _ in 0..attempts {
        *K::unknowns(state) = start + step;
        let next = Residual::of::<L, K>(system, state);
        if next.distance().0 < residual.distance().0 {
            return Some(next);
        }
        step *= L::Scalar::constant(0.5);
    }
    *K::unknowns(state) = start;
    None
}

/// The least δ with F δ = −residual.
fn correction<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    residual: &Residual<L::Scalar, N, M>,
    rank: Rank<L::Scalar>,
) -> Option<SVector<L::Scalar, N>>
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let h = [L::Scalar::constant(0.0); N];
    let m: [[L::Scalar; N]; N] = system.mass_matrix(state).into();
    let fast = eliminate_active(m, h, residual.jacobian, residual.value, residual.active);
    if is_trustworthy(&fast) {
        return Some(fast.accelerations);
    }
    let general = |m| {
        let equations = Equations { m, h, f: residual.jacobian, gamma: residual.value };
        kkt::solve(&equations, rank).ok().map(|(solution, _)| solution.accelerations)
    };
    // Without the velocity constraints a massless coordinate may have no metric: take the plain one.
    general(m).or_else(|| general(diagonal(&m))).filter(|step| step.iter().all(|x| x.is_finite()))
}

/// The masses on the diagonal, 1 where there is none.
fn diagonal<T: Real, const N: usize>(m: &[[T; N]; N]) -> [[T; N]; N] {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    let mass = |i: usize| if m[i][i] == zero { one } else { Scalar::abs(m[i][i]) };
    from_fn(|i| from_fn(|j| if i == j { mass(i) } else { zero }))
}

#[cold]
fn not_projected<L, const N: usize, const M: usize>(
    state: &State<L::Scalar, N>,
    residual: &Residual<L::Scalar, N, M>,
    iterations: usize,
) -> Error
where
    L: Lagrangian<N, M, Scalar: Real>,
{
    let (_, row) = residual.distance();
    Error::NotProjected {
        constraint: name(&L::CONSTRAINTS, row),
        residual: residual.value.get(row).map_or(f64::NAN, |value| value.to_f64()),
        iterations,
        time: state.t.to_f64(),
    }
}
