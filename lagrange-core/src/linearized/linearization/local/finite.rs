//! Changes of a state that are not small, in local coordinates: rotations by exp and log.

use nalgebra::DVector;

use super::blocks::{Blocks, Four, four, times, turned_back};
use crate::error::Error;
use crate::linearized::StateDerivatives;
use crate::number::{Real, Scalar, norm};
use crate::solution::consistent;
use crate::system::StateOf;
use crate::system::finite::check_finite;

/// See [`Linearized::local_change`](super::Linearized::local_change).
pub(crate) fn change<L: StateDerivatives<Scalar: Real>>(
    system: &L,
    states: [&StateOf<L>; 2],
) -> Result<DVector<L::Scalar>, Error> {
    for state in states {
        check_finite(system, state)?;
        consistent::check(system, state)?;
    }
    let (blocks, [from, to]) = (Blocks::of::<L>(), states);
    let count = blocks.counts[1];
    let mut change = DVector::from_element(2 * count, L::Scalar::constant(0.0));
    for &[i, local] in &blocks.others {
        change[local] = to.q[i] - from.q[i];
        change[count + local] = to.v[i] - from.v[i];
    }
    for &[i, local] in &blocks.quaternions {
        let [before, after] = states.map(|state| four(state.q.as_slice(), i));
        let [slow, fast] = states.map(|state| angular_velocity(state.q.as_slice(), state.v.as_slice(), i));
        let rotation = rotation(before, after);
        for k in 0..3 {
            change[local + k] = rotation[k];
            change[count + local + k] = fast[k] - slow[k];
        }
    }
    Ok(change)
}

/// See [`Linearized::locally_changed`](super::Linearized::locally_changed).
pub(crate) fn changed<L: StateDerivatives<Scalar: Real>>(
    system: &L,
    state: &StateOf<L>,
    change: &[L::Scalar],
) -> Result<StateOf<L>, Error> {
    check_finite(system, state)?;
    consistent::check(system, state)?;
    let blocks = Blocks::of::<L>();
    let count = blocks.counts[1];
    if change.len() != 2 * count {
        return Err(Error::LocalChange { found: change.len(), expected: 2 * count });
    }
    if let Some(k) = change.iter().position(|x| !x.to_f64().is_finite()) {
        return Err(Error::LocalChangeNotFinite { coordinate: blocks.names(L::COORDINATES).swap_remove(k) });
    }
    let mut changed = *state;
    for &[i, local] in &blocks.others {
        changed.q[i] += change[local];
        changed.v[i] += change[count + local];
    }
    for &[i, local] in &blocks.quaternions {
        let three = |first: usize| [0, 1, 2].map(|k| change[first + k]);
        let before = angular_velocity(state.q.as_slice(), state.v.as_slice(), i);
        let more = three(count + local);
        let turned = turned(four(state.q.as_slice(), i), three(local));
        let half = L::Scalar::constant(0.5);
        let rate = times(turned, [0, 1, 2].map(|k| (before[k] + more[k]) * half));
        for k in 0..4 {
            changed.q[i + k] = turned[k];
            changed.v[i + k] = rate[k];
        }
    }
    check_finite(system, &changed)?;
    Ok(changed)
}

/// ω = 2 Q̄ ⊗ Q̇, vector part.
fn angular_velocity<T: Real>(q: &[T], v: &[T], first: usize) -> [T; 3] {
    turned_back(four(q, first), four(v, first)).map(|x| x * T::constant(2.0))
}

/// δφ of Q' = Q ⊗ exp(½ δφ), |δφ| ≤ π. Q' and −Q' are one orientation.
fn rotation<T: Real>(before: Four<T>, after: Four<T>) -> [T; 3] {
    let zero = T::constant(0.0);
    let cos = (0..4).fold(zero, |sum, k| sum + before[k] * after[k]);
    let vector = turned_back(before, after);
    let (cos, vector) = if cos < zero { (-cos, vector.map(|x| -x)) } else { (cos, vector) };
    let sin = norm(&vector);
    // atan(sin/cos)/sin, at 0 its limit
    let ratio = if sin == zero { T::constant(1.0) / cos } else { Scalar::atan2(sin, cos) / sin };
    vector.map(|x| x * ratio * T::constant(2.0))
}

/// Q ⊗ exp(½ δφ).
fn turned<T: Real>(q: Four<T>, rotation: [T; 3]) -> Four<T> {
    let half = rotation.map(|x| x * T::constant(0.5));
    let angle = norm(&half);
    let (sin, cos) = Scalar::sin_cos(angle);
    let ratio = if angle == T::constant(0.0) { T::constant(1.0) } else { sin / angle };
    let along = times(q, half.map(|x| x * ratio));
    [0, 1, 2, 3].map(|k| q[k] * cos + along[k])
}
