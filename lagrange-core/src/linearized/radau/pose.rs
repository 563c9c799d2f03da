//! Poses at which constraints depend on one another, within a step.
//!
//! With their gradients as rows of F₀ at the start of a step, and of F within it, det(F F₀ᵀ) changes its sign where the motion
//! passes such a pose. At other poses it is zero only if a combination of the rows of F is at right angles to all rows of F₀,
//! where forces are bounded. The stages follow the branch of the motion across the pose. But multipliers may have a
//! pole there, so that no bounded force keeps the constraints.

use nalgebra::Const;

use super::collocation::Collocation;
use super::memory::KnownStateOf;
use super::tableau::RadauStages;
use crate::error::Error;
use crate::number::{Real, Scalar, power_of_epsilon};
use crate::numerics::lu::Lu;
use crate::solution::interpolant::Interpolant;
use crate::solution::solve::solve_near;
use crate::solution::vector_field::{LagrangianVectorField, StagePoint, VectorField};
use crate::system::{Lagrangian, StateOf};
use crate::vector::{Array, Element, StaticLength, array};

/// Fails if multipliers grow without bound towards a pose within a step from `from` to `end`.
pub(super) fn check<L: Lagrangian<Scalar: Real>, const S: usize>(
    system: &L,
    orientation: &mut Lu<L::Scalar, L::M>,
    (from, step, end): (&KnownStateOf<L>, &Collocation<L::Scalar, L::N, S>, &StateOf<L>),
) -> Result<(), Error>
where
    Const<S>: RadauStages,
{
    if <L::M>::COUNT == 0 || !is_turned(system, orientation, from, end) {
        return Ok(());
    }
    let [mut before, mut after] = [0.0, 1.0];
    for _ in 0..f64::MANTISSA_DIGITS {
        let middle = f64::midpoint(before, after);
        let state = <LagrangianVectorField as VectorField<L>>::state(system, &within(step, middle));
        match is_turned(system, orientation, from, &state) {
            true => after = middle,
            false => before = middle,
        }
    }
    let part = if before < 0.5 { before - 1.0 } else { before };
    // At a quarter of the distance, a force with a pole is four times as large, a bounded one as large: two is halfway between.
    // So near the pose that rounding decides on the forces, they tell nothing of a pole.
    let loads = |distance: f64| Loads::at(system, from, &within(step, before - part * distance));
    let [Some(far), Some(near)] = [1.0 / 8.0, 1.0 / 32.0].map(loads) else { return Ok(()) };
    let has_grown = |of: fn(&Loads<_, L::N, L::M>, usize) -> L::Scalar, k: usize| {
        of(&near, k) > L::Scalar::constant(2.0) * of(&far, k)
    };
    // A multiplier that is zero has round-off that grows.
    if !(0..<L::N>::COUNT).any(|i| has_grown(|loads, i| loads.forces[i], i)) {
        return Ok(());
    }
    let grown = (0..<L::M>::COUNT).filter(|a| has_grown(|loads, a| loads.multipliers[a], *a));
    let constraints = grown.map(|a| L::CONSTRAINTS[a]).collect();
    Err(Error::UnboundedMultipliers { constraints, time: within(step, before).t.to_f64() })
}

/// Magnitudes of the multipliers, and of the forces on each coordinate, Σₐ |Fₐᵢ λₐ| + |hᵢ|.
struct Loads<T: Element, N: StaticLength, M: StaticLength> {
    multipliers: Array<T, M>,
    forces: Array<T, N>,
}

impl<T: Real, N: StaticLength, M: StaticLength> Loads<T, N, M> {
    /// Loads at a point, which is moved onto the constraints. `None` if rounding leaves less than half of the digits.
    fn at<L: Lagrangian<Scalar = T, N = N, M = M>>(
        system: &L,
        from: &KnownStateOf<L>,
        point: &StagePoint<T, N>,
    ) -> Option<Self> {
        let state = <LagrangianVectorField as VectorField<L>>::project(system, point).ok()?;
        let solution = solve_near(system, &state, Some(&from.active), |solution, _| *solution).ok()?;
        let multipliers = array(solution.multipliers).map(Scalar::abs);
        let (f, h) = (system.constraint_jacobian(&state), system.forcing(&state));
        let force = |i: usize| {
            (0..M::COUNT).fold(Scalar::abs(h[i]), |sum, a| sum + Scalar::abs(f[(a, i)]) * multipliers[a])
        };
        let forces = Array::from_fn(force);
        (solution.pivot > power_of_epsilon(0.5)).then_some(Self { multipliers, forces })
    }
}

/// True if det(F F₀ᵀ) is negative, of the constraints that determine the accelerations at the start.
fn is_turned<L: Lagrangian<Scalar: Real>>(
    system: &L,
    orientation: &mut Lu<L::Scalar, L::M>,
    from: &KnownStateOf<L>,
    state: &StateOf<L>,
) -> bool {
    let start = system.constraint_jacobian(&from.state());
    let now = system.constraint_jacobian(state);
    let (zero, one) = (L::Scalar::constant(0.0), L::Scalar::constant(1.0));
    let entry = |a: usize, b: usize| match (a == b, from.active[a] && from.active[b]) {
        (_, true) => (0..<L::N>::COUNT).fold(zero, |sum, i| sum + now[(a, i)] * start[(b, i)]),
        (true, _) => one,
        _ => zero,
    };
    orientation.factorize(entry) && orientation.has_negative_determinant()
}

/// The point at a part of a step.
fn within<T: Real, N: StaticLength, const S: usize>(
    step: &Collocation<T, N, S>,
    part: f64,
) -> StagePoint<T, N>
where
    Const<S>: RadauStages,
{
    step.at(step.time + T::constant(part) * step.length)
}
