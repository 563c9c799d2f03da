//! The point of the holonomic constraints that is nearest to one given: M(q₀)(q − q₀) = Fᵀμ with Φ(q) = 0.
//!
//! From a point on the constraints Newton steps along them shorten the distance, each followed by a projection back onto
//! them (Absil, Mahony and Sepulchre, *Optimization Algorithms on Matrix Manifolds*, 6.2). Its Hessian is that of the
//! Lagrange function, M − Σ μ ∇²Φ, on their tangent space; where that is not positive, multiples of M are added, and next to a
//! maximum or a saddle the step goes along a direction in which the distance curves down: neither is taken for the nearest point.
//!
//! Functions that factorize a matrix are not inlined, and matrices that are kept lie on the heap, so that the stack holds few of
//! them at a time: 0.75 MiB for 100 coordinates and 50 constraints.

#[cfg(test)]
mod tests;

use core::array::from_fn;
use core::iter::successors;

use nalgebra::SVector;

use super::level::Level;
use super::{diagonal, hold, project_holding};
use crate::number::{Real, Scalar, entries, is_within, larger, power_of_epsilon, vector};
use crate::room::Room;
use crate::solution::kkt::{Factors, Rank};
use crate::solution::newton::halvings;
use crate::system::{Lagrangian, State};

/// Newton's method takes five or so; far away and where minima are flat it takes more, 31 for a chain of 50 rods.
const STEPS: usize = 100;

/// Moves coordinates along the holonomic constraints to a local minimum of the distance from those given.
pub(super) fn approach<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    given: &State<L::Scalar, N>,
    held: &[bool; N],
    state: &mut State<L::Scalar, N>,
) {
    if state.q == given.q {
        return;
    }
    let metric = metric(system, given, held, state);
    let nearest = Nearest { system, given, held, metric };
    let Some(mut place) = nearest.place(*state) else { return };
    for _ in 0..STEPS {
        let Some(next) = nearest.nearer(&place) else { break };
        place = next;
    }
    *state = place.state;
}

/// The mass matrix at the coordinates given, or minus it, where that is positive; else the masses on its diagonal.
#[inline(never)]
fn metric<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize>(
    system: &L,
    given: &State<L::Scalar, N>,
    held: &[bool; N],
    state: &State<L::Scalar, N>,
) -> Room<[[L::Scalar; N]; N]> {
    let mut f = Level::Position.jacobian(system, state);
    let mut m: [[L::Scalar; N]; N] = system.mass_matrix(given).into();
    if m.iter().enumerate().all(|(i, row)| row[i] <= L::Scalar::constant(0.0)) {
        m.as_flattened_mut().iter_mut().for_each(|x| *x = -*x);
    }
    hold(held, &mut m, &mut f);
    Room::of(if is_semidefinite(&m) && is_regular(&m, &f) { m } else { diagonal(&m) })
}

/// Whether no direction has a negative mass.
#[inline(never)]
fn is_semidefinite<T: Real, const N: usize>(m: &[[T; N]; N]) -> bool {
    Factors::<T, N, 0>::of(m, &[], Rank::off_constraints()).is_semidefinite()
}

/// Whether every direction that the constraints leave free has a mass.
#[inline(never)]
fn is_regular<T: Real, const N: usize, const M: usize>(m: &[[T; N]; N], f: &[[T; N]; M]) -> bool {
    Factors::of(m, f, Rank::off_constraints()).are_regular()
}

struct Nearest<'a, L: Lagrangian<N, M>, const N: usize, const M: usize> {
    system: &'a L,
    given: &'a State<L::Scalar, N>,
    /// Entries that stay as they are.
    held: &'a [bool; N],
    metric: Room<[[L::Scalar; N]; N]>,
}

/// A point on the constraints.
struct ConstrainedPoint<T, const N: usize, const M: usize> {
    state: State<T, N>,
    f: Room<[[T; N]; M]>,
    /// M (q₀ − q)
    pull: [T; N],
    /// The square of the distance.
    square: T,
    /// The part of q₀ − q along the constraints, zero at the nearest point, and μ.
    slip: SVector<T, N>,
    multipliers: SVector<T, M>,
    /// The largest entry of the slip as a part of the coordinates that it is the difference of, and of the distance.
    slip_part: T,
}

impl<L: Lagrangian<N, M, Scalar: Real>, const N: usize, const M: usize> Nearest<'_, L, N, M> {
    #[inline(never)]
    fn place(&self, state: State<L::Scalar, N>) -> Option<ConstrainedPoint<L::Scalar, N, M>> {
        let (Self { system, given, metric, .. }, zero) = (self, L::Scalar::constant(0.0));
        let mut f = Level::Position.jacobian(*system, &state);
        hold(self.held, &mut [], &mut f);
        let way = given.q - state.q;
        let pull = entries(|i| dot(&metric[i], way.as_slice()));
        let found = Factors::of(metric, &f, Rank::off_constraints()).solve(&pull, &[zero; M]).ok()?;
        let square = dot(&pull, way.as_slice());
        // Of each difference, and of what its projection mixes, a part ε is round-off.
        let part = |i: usize| {
            let terms = Scalar::abs(state.q[i]) + Scalar::abs(given.q[i]);
            let slip = Scalar::abs(found.accelerations[i]);
            if slip > zero { slip / (terms + Scalar::sqrt(square / metric[i][i])) } else { zero }
        };
        Some(ConstrainedPoint {
            state,
            f: Room::of(f),
            pull,
            square,
            slip: found.accelerations,
            multipliers: found.multipliers,
            slip_part: (0..N).fold(zero, |most, i| larger(most, part(i))),
        })
    }

    /// A place that is nearer, or whose slip is smaller where round-off hides which is nearer.
    fn nearer(&self, place: &ConstrainedPoint<L::Scalar, N, M>) -> Option<ConstrainedPoint<L::Scalar, N, M>> {
        let half = L::Scalar::constant(0.5);
        let hidden = L::Scalar::constant(64.0 * L::Scalar::EPSILON) * place.square;
        let is_nearer = |next: &ConstrainedPoint<_, N, M>| {
            let change = next.square - place.square;
            change < -hidden || change <= hidden && next.slip_part < half * place.slip_part
        };
        let parts = |step: SVector<L::Scalar, N>| halvings::<L::Scalar>(12).map(move |part| step * part);
        let steps = self.steps(place).into_iter().flatten();
        steps.flat_map(parts).filter_map(|step| self.moved(place, &step)).find(is_nearer)
    }

    /// Back on the constraints after a step.
    fn moved(
        &self,
        place: &ConstrainedPoint<L::Scalar, N, M>,
        step: &SVector<L::Scalar, N>,
    ) -> Option<ConstrainedPoint<L::Scalar, N, M>> {
        let mut state = place.state;
        for i in (0..N).filter(|&i| !self.held[i]) {
            state.q[i] += step[i];
        }
        project_holding(self.system, Level::Position, self.held, &mut state).ok()?;
        self.place(state)
    }

    /// Newton's step, none at a minimum. Where the distance curves down, a damped one, or next to a saddle one along a direction
    /// that leads down, as long as the point given is away; then the slip.
    #[inline(never)]
    fn steps(&self, place: &ConstrainedPoint<L::Scalar, N, M>) -> [Option<SVector<L::Scalar, N>>; 2] {
        let hessian = self.hessian(place);
        let factors = Factors::of(&hessian, &place.f, Rank::off_constraints());
        let first = match factors.downhill() {
            None if is_within(place.slip_part, L::Scalar::constant(16.0 * L::Scalar::EPSILON)) => {
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
        factors: &Factors<L::Scalar, N, M>,
        place: &ConstrainedPoint<L::Scalar, N, M>,
    ) -> Option<SVector<L::Scalar, N>> {
        let found = factors.solve(&place.pull, &[L::Scalar::constant(0.0); M]);
        found.ok().map(|found| found.accelerations)
    }

    /// Newton's step with the least of a few multiples of the metric added to the Hessian that make it positive.
    #[inline(never)]
    fn damped(
        &self,
        place: &ConstrainedPoint<L::Scalar, N, M>,
        hessian: &[[L::Scalar; N]; N],
    ) -> Option<SVector<L::Scalar, N>> {
        let multiples = successors(Some(0.25), |multiple| Some(4.0 * multiple)).take(10);
        multiples.map(L::Scalar::constant).find_map(|multiple| {
            let sum = from_fn(|i| entries(|j| hessian[i][j] + multiple * self.metric[i][j]));
            let factors = Factors::of(&sum, &place.f, Rank::off_constraints());
            if factors.is_semidefinite() { Self::newton(&factors, place) } else { None }
        })
    }

    /// A step in this direction, or the opposite one, towards the point given.
    fn as_long_as_the_way(
        &self,
        place: &ConstrainedPoint<L::Scalar, N, M>,
        down: SVector<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        let down = down.as_slice();
        let length = dot(down, &entries::<_, N>(|i| dot(&self.metric[i], down)));
        let scale = Scalar::sqrt(place.square / length);
        let scale = if dot(&place.pull, down) < L::Scalar::constant(0.0) { -scale } else { scale };
        vector(entries(|i| down[i] * scale))
    }

    /// M − Σ μ ∇²Φ, from central differences of Fᵀμ over a part ε^(1/3) of the distance. As |Fᵀμ| is M times the distance, they are
    /// off by a part ε^(2/3) of M: a step of Newton's method leaves as little of the slip.
    #[inline(never)]
    fn hessian(&self, place: &ConstrainedPoint<L::Scalar, N, M>) -> Room<[[L::Scalar; N]; N]> {
        let (zero, half) = (L::Scalar::constant(0.0), L::Scalar::constant(0.5));
        let is_active = |a: usize| Level::Position.is_active(L::CONSTRAINT_KINDS[a]);
        let multipliers = vector(entries(|a| if is_active(a) { place.multipliers[a] } else { zero }));
        let mut hessian = self.metric.clone();
        for j in 0..N {
            let step = self.difference(place, j);
            let force = |step: L::Scalar| {
                let mut state = place.state;
                state.q[j] += step;
                self.system.constraint_force(&state, &multipliers)
            };
            let change = (force(step) - force(-step)) * (half * half / step);
            for i in 0..N {
                hessian[i][j] -= change[i];
                hessian[j][i] -= change[i];
            }
        }
        hold(self.held, &mut *hessian, &mut []);
        hessian
    }

    /// The length of a difference in coordinate `j`: a small part of the distance, and many round-offs of the coordinate.
    fn difference(&self, place: &ConstrainedPoint<L::Scalar, N, M>, j: usize) -> L::Scalar {
        let (zero, part) = (L::Scalar::constant(0.0), power_of_epsilon(1.0 / 3.0));
        let mass = self.metric[j][j];
        let distance = if mass > zero { Scalar::sqrt(place.square / mass) } else { zero };
        let step = part * (distance + part * Scalar::abs(place.state.q[j]));
        if step > zero { step } else { part }
    }
}

fn dot<T: Real>(x: &[T], y: &[T]) -> T {
    x.iter().zip(y).fold(T::constant(0.0), |sum, (x, y)| sum + *x * *y)
}
