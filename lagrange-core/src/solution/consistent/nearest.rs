//! Nearest point on the holonomic constraints to a given point: M(q₀)(q − q₀) = Fᵀμ with Φ(q) = 0.
//!
//! From a point on the constraints, Newton steps along the constraints shorten the distance; each is followed
//! by a projection back onto them (Absil, Mahony and Sepulchre, *Optimization Algorithms on Matrix Manifolds*,
//! 6.2). The Hessian is that of the Lagrange function, M − Σ μ ∇²Φ, on the tangent space. If it is not
//! positive, multiples of M are added. Next to a maximum or a saddle the step follows a direction of negative
//! curvature, so neither is mistaken for the nearest point.
//!
//! Functions that factorize a matrix are not inlined, and stored matrices lie on the heap. The stack thus holds
//! few matrices at a time: 1000 KiB for 100 coordinates and 50 constraints.

#[cfg(test)]
mod tests;

use nalgebra::Const;

use super::level::Level;
use super::{diagonal, hold, mass_matrix, project_holding};
use crate::number::limits::{ACCUMULATED, CANCELLED, ITERATIONS};
use crate::number::{Real, Scalar, dot, is_within, larger, power_of_epsilon};
use crate::numerics::newton::{dampings, halvings};
use crate::room::Room;
use crate::solution::kkt::{Factors, Rank};
use crate::system::{Lagrangian, State, StateOf};
use crate::vector::{Array, Element, Entrywise, StaticLength, Vector, from_fn, vector};

/// Moves the coordinates along the holonomic constraints to a local minimum of the distance from the given
/// ones.
pub(super) fn approach<L: Lagrangian<Scalar: Real>>(
    system: &L,
    given: &StateOf<L>,
    held: &Array<bool, L::N>,
    state: &mut StateOf<L>,
) {
    if state.q == given.q {
        return;
    }
    let metric = metric(system, given, held, state);
    let nearest = Nearest { system, given, held, metric };
    let Some(mut place) = nearest.place(*state) else { return };
    for _ in 0..ITERATIONS {
        let Some(next) = nearest.nearer(&place) else { break };
        place = next;
    }
    *state = place.state;
}

/// Metric of the distance: the mass matrix at the given coordinates, or its negative, if positive semidefinite
/// and regular along the constraints; else its diagonal.
#[inline(never)]
fn metric<L: Lagrangian<Scalar: Real>>(
    system: &L,
    given: &StateOf<L>,
    held: &Array<bool, L::N>,
    state: &StateOf<L>,
) -> Room<Array<Array<L::Scalar, L::N>, L::N>> {
    let mut m = Room::of(mass_matrix(system, given));
    let mut f = gradients(system, state);
    if m.iter().enumerate().all(|(i, row)| row[i] <= L::Scalar::constant(0.0)) {
        m.iter_mut().flatten().for_each(|x| *x = -*x);
    }
    hold(held, &mut m, &mut f);
    if is_semidefinite(&m) && is_regular(&m, &f) { m } else { diagonal(&m) }
}

/// Gradients of the holonomic constraints, in a function of their own: while they are made they take more of the stack than the result.
#[inline(never)]
fn gradients<L: Lagrangian<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
) -> Room<Array<Array<L::Scalar, L::N>, L::M>> {
    Room::of(Level::Position.jacobian(system, state))
}

/// True if no direction has negative mass.
#[inline(never)]
fn is_semidefinite<T: Real, N: StaticLength>(m: &Array<Array<T, N>, N>) -> bool {
    Factors::<T, N, Const<0>>::of(m, &Array([]), Rank::off_constraints()).is_semidefinite()
}

/// True if every direction that the constraints leave free has mass.
#[inline(never)]
fn is_regular<T: Real, N: StaticLength, M: StaticLength>(
    m: &Array<Array<T, N>, N>,
    f: &Array<Array<T, N>, M>,
) -> bool {
    Factors::of(m, f, Rank::off_constraints()).are_regular()
}

struct Nearest<'a, L: Lagrangian> {
    system: &'a L,
    given: &'a StateOf<L>,
    /// True for entries that keep their value.
    held: &'a Array<bool, L::N>,
    metric: Room<Array<Array<L::Scalar, L::N>, L::N>>,
}

/// A point on the constraints, with its distance from the given point q₀.
struct ConstrainedPoint<T: Element, N: StaticLength, M: StaticLength> {
    state: State<T, N>,
    f: Room<Array<Array<T, N>, M>>,
    /// Gradient of half the squared distance, with opposite sign: M (q₀ − q).
    pull: Array<T, N>,
    /// Squared distance in the metric M.
    square: T,
    /// Tangential part of q₀ − q, zero at the nearest point; with the multipliers μ.
    slip: Vector<T, N>,
    multipliers: Vector<T, M>,
    /// Largest |slipᵢ| / (|qᵢ| + |q₀ᵢ| + d/√Mᵢᵢ), with the distance d in the metric M.
    slip_part: T,
}

impl<L: Lagrangian<Scalar: Real>> Nearest<'_, L> {
    #[inline(never)]
    fn place(&self, state: StateOf<L>) -> Option<ConstrainedPoint<L::Scalar, L::N, L::M>> {
        let (Self { system, given, metric, .. }, zero) = (self, L::Scalar::constant(0.0));
        let mut f = gradients(*system, &state);
        hold(self.held, &mut [], &mut f);
        let way = given.q.minus(&state.q);
        let pull = Array::from_fn(|i| dot(&metric[i], way.as_slice()));
        let found =
            Factors::of(metric, &f, Rank::off_constraints()).solve(&pull, &Array::filled(zero)).ok()?;
        let square = dot(&pull, way.as_slice());
        // Round-off of each difference, and of the terms that the projection combines, is ε times this scale.
        let part = |i: usize| {
            let terms = Scalar::abs(state.q[i]) + Scalar::abs(given.q[i]);
            let slip = Scalar::abs(found.accelerations[i]);
            if slip > zero { slip / (terms + Scalar::sqrt(square / metric[i][i])) } else { zero }
        };
        Some(ConstrainedPoint {
            state,
            f,
            pull,
            square,
            slip: found.accelerations,
            multipliers: found.multipliers,
            slip_part: (0..<L::N>::COUNT).fold(zero, |most, i| larger(most, part(i))),
        })
    }

    /// Returns a nearer point. If round-off hides which point is nearer, returns one whose `slip_part` is
    /// less than half as large.
    fn nearer(
        &self,
        place: &ConstrainedPoint<L::Scalar, L::N, L::M>,
    ) -> Option<ConstrainedPoint<L::Scalar, L::N, L::M>> {
        let half = L::Scalar::constant(0.5);
        let hidden = L::Scalar::constant(ACCUMULATED * L::Scalar::EPSILON) * place.square;
        let is_nearer = |next: &ConstrainedPoint<_, L::N, L::M>| {
            let change = next.square - place.square;
            change < -hidden || change <= hidden && next.slip_part < half * place.slip_part
        };
        let parts = |step: Vector<L::Scalar, L::N>| {
            halvings::<L::Scalar>(false).map(move |part| step.each(|x| x * part))
        };
        let steps = self.steps(place).into_iter().flatten();
        steps.flat_map(parts).filter_map(|step| self.moved(place, &step)).find(is_nearer)
    }

    /// Takes a step and projects the result back onto the constraints.
    fn moved(
        &self,
        place: &ConstrainedPoint<L::Scalar, L::N, L::M>,
        step: &Vector<L::Scalar, L::N>,
    ) -> Option<ConstrainedPoint<L::Scalar, L::N, L::M>> {
        let mut state = place.state;
        for i in (0..<L::N>::COUNT).filter(|&i| !self.held[i]) {
            state.q[i] += step[i];
        }
        project_holding(self.system, Level::Position, self.held, &mut state).ok()?;
        self.place(state)
    }

    /// Returns trial steps, none at a minimum. First, Newton's step; where the distance has negative
    /// curvature, a damped step, or next to a saddle a step of the length of the distance along a direction
    /// of negative curvature. Second, a step by `slip`.
    #[inline(never)]
    fn steps(&self, place: &ConstrainedPoint<L::Scalar, L::N, L::M>) -> [Option<Vector<L::Scalar, L::N>>; 2] {
        let hessian = self.hessian(place);
        let factors = Factors::of(&hessian, &place.f, Rank::off_constraints());
        let first = match factors.downhill() {
            None if is_within(place.slip_part, L::Scalar::constant(CANCELLED * L::Scalar::EPSILON)) => {
                return [None; 2];
            }
            None => Self::newton(&factors, place),
            Some(down) if place.slip_part < power_of_epsilon(0.25) => {
                Some(self.as_long_as_the_way(place, down))
            }
            Some(_) => self.damped(place, &hessian),
        };
        [first, Some(place.slip)]
    }

    fn newton(
        factors: &Factors<L::Scalar, L::N, L::M>,
        place: &ConstrainedPoint<L::Scalar, L::N, L::M>,
    ) -> Option<Vector<L::Scalar, L::N>> {
        let found = factors.solve(&place.pull, &Array::filled(L::Scalar::constant(0.0)));
        found.ok().map(|found| found.accelerations)
    }

    /// Newton's step with a multiple of the metric added to the Hessian: the smallest that makes it
    /// positive.
    #[inline(never)]
    fn damped(
        &self,
        place: &ConstrainedPoint<L::Scalar, L::N, L::M>,
        hessian: &Array<Array<L::Scalar, L::N>, L::N>,
    ) -> Option<Vector<L::Scalar, L::N>> {
        let one = L::Scalar::constant(1.0);
        dampings(one, one).find_map(|[multiple, _]| {
            let sum = from_fn(|i| Array::from_fn(|j| hessian[i][j] + multiple * self.metric[i][j]));
            let factors = Factors::of(&sum, &place.f, Rank::off_constraints());
            if factors.is_semidefinite() { Self::newton(&factors, place) } else { None }
        })
    }

    /// Step along `down` or against it, toward the given point and as long as the distance from it.
    fn as_long_as_the_way(
        &self,
        place: &ConstrainedPoint<L::Scalar, L::N, L::M>,
        down: Vector<L::Scalar, L::N>,
    ) -> Vector<L::Scalar, L::N> {
        let down = down.as_slice();
        let length = dot(down, &Array::<_, L::N>::from_fn(|i| dot(&self.metric[i], down)));
        let scale = Scalar::sqrt(place.square / length);
        let scale = if dot(&place.pull, down) < L::Scalar::constant(0.0) { -scale } else { scale };
        vector(Array::from_fn(|i| down[i] * scale))
    }

    /// Hessian M − Σ μ ∇²Φ, from central differences of Fᵀμ over ε^(1/3) of the distance. |Fᵀμ| is M times
    /// the distance, so the error is ε^(2/3) of M: a Newton step reduces `slip` by that factor.
    #[inline(never)]
    fn hessian(
        &self,
        place: &ConstrainedPoint<L::Scalar, L::N, L::M>,
    ) -> Room<Array<Array<L::Scalar, L::N>, L::N>> {
        let (zero, half) = (L::Scalar::constant(0.0), L::Scalar::constant(0.5));
        let is_active = |a: usize| Level::Position.is_active(L::CONSTRAINT_KINDS[a]);
        let multipliers = vector(Array::from_fn(|a| if is_active(a) { place.multipliers[a] } else { zero }));
        let mut hessian = self.metric.clone();
        for j in 0..<L::N>::COUNT {
            let step = self.difference(place, j);
            let force = |step: L::Scalar| {
                let mut state = place.state;
                state.q[j] += step;
                self.system.constraint_force(&state, &multipliers)
            };
            let change = force(step).minus(&force(-step)).each(|x| x * (half * half / step));
            for i in 0..<L::N>::COUNT {
                hessian[i][j] -= change[i];
                hessian[j][i] -= change[i];
            }
        }
        hold(self.held, &mut hessian, &mut []);
        hessian
    }

    /// Step length of the central difference in coordinate `j`: ε^(1/3) of the distance, plus ε^(2/3) of the
    /// coordinate, well above its round-off.
    fn difference(&self, place: &ConstrainedPoint<L::Scalar, L::N, L::M>, j: usize) -> L::Scalar {
        let (zero, part) = (L::Scalar::constant(0.0), power_of_epsilon(1.0 / 3.0));
        let mass = self.metric[j][j];
        let distance = if mass > zero { Scalar::sqrt(place.square / mass) } else { zero };
        let step = part * (distance + part * Scalar::abs(place.state.q[j]));
        if step > zero { step } else { part }
    }
}
