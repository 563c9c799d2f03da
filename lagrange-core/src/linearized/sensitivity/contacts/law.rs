//! Derivatives of the laws of contacts: restitutions, and limits of friction.

use super::fails;
use crate::contact::Contacts;
use crate::derivatives::tangent::parameter;
use crate::error::Error;
use crate::linearized::Linearized;
use crate::linearized::sensitivity::state::{ChangingState, ChangingStateOf};
use crate::number::limits::CANCELLED;
use crate::number::{Real, Scalar, larger, largest, power_of_epsilon, unit_of};
use crate::system::{Direction, State, StateOf};
use crate::vector::{Entrywise, StaticLength};

/// A law, of the contact or friction of a name.
pub(super) struct NamedLaw<'a, L: Linearized> {
    pub(super) name: &'static str,
    pub(super) value: &'a dyn Fn(&L, &StateOf<L>) -> Option<L::Scalar>,
}

impl<L: Linearized<Scalar: Real> + Contacts + Clone> NamedLaw<'_, L> {
    pub(super) fn at(&self, system: &L, state: &StateOf<L>) -> L::Scalar {
        (self.value)(system, state).unwrap_or(L::Scalar::constant(0.0))
    }

    /// Derivative at a changing state, by differences of order six. Their steps are 4⁻⁴ of the arguments, 4⁻⁵ and so on, down to √ε of
    /// them, until those of three lengths agree to half of their digits, or to the round-off of the law: the error of the
    /// last is 4⁻⁶ of that. The first is off by 2·10⁻¹⁷ of a law that varies over its arguments. A law that varies only within a
    /// sixteenth of the shortest step is taken for a constant one.
    pub(super) fn change(
        &self,
        system: &L,
        ChangingState { state, direction, argument }: &ChangingStateOf<'_, L>,
    ) -> Result<L::Scalar, Error> {
        let parameter = argument.and_then(parameter::<L>).map(|k| (k, system.parameters()[k]));
        let step = step(state, direction, parameter.map(|(_, value)| value));
        let at = |part: f64| {
            let along = step * L::Scalar::constant(part);
            let mut moved = system.clone();
            let is_set = parameter.is_none_or(|(k, value)| moved.set_parameter(k, value + along));
            let add = |x: L::Scalar, rate: L::Scalar| x + rate * along;
            let q = state.q.each_with(&direction.q, add);
            let state = State { t: add(state.t, direction.t), q, v: state.v.each_with(&direction.v, add) };
            let value = self.at(&moved, &state);
            let is_known = is_set || value == L::Scalar::constant(0.0);
            let reason = "the parameter cannot be set, on which its law may depend";
            if is_known { Ok(value) } else { fails(self.name, state.t, reason) }
        };
        let (mut known, mut agree, mut part) = (None, 0, 1.0 / 256.0);
        while part * part >= L::Scalar::EPSILON {
            let length = step * L::Scalar::constant(part);
            let [derivative, size] = differences(|count| at(count * part))?.map(|sum| sum / length);
            let noise = L::Scalar::constant(L::Scalar::EPSILON * CANCELLED) * size;
            let allowed = power_of_epsilon::<L::Scalar>(0.5) * Scalar::abs(derivative) + noise;
            let is_same = |before: L::Scalar| Scalar::abs(derivative - before) <= allowed;
            agree = if known.is_some_and(is_same) { agree + 1 } else { 0 };
            if agree == 2 {
                return Ok(derivative);
            }
            (known, part) = (Some(derivative), part / 4.0);
        }
        let reason = "its law varies too fast for differences of it";
        fails(self.name, state.t, reason)
    }
}

/// Σ of differences of order six, and the largest value, at parts of a step.
fn differences<T: Real>(at: impl Fn(f64) -> Result<T, Error>) -> Result<[T; 2], Error> {
    let (mut sum, mut size) = (T::constant(0.0), T::constant(0.0));
    for (part, weight) in [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)] {
        let [after, before] = [at(part)?, at(-part)?];
        sum += (after - before) * T::constant(weight / 60.0);
        size = larger(size, larger(Scalar::abs(after), Scalar::abs(before)));
    }
    Ok([sum, size])
}

/// Unit of the steps of the differences: the time, the largest coordinate, the largest velocity or the parameter, or one if they are
/// zero.
fn step<T: Real, N: StaticLength>(
    state: &State<T, N>,
    direction: &Direction<T, N>,
    parameter: Option<T>,
) -> T {
    let rate = |size: T, change: T| change / unit_of(size);
    let rates = [
        rate(Scalar::abs(state.t), Scalar::abs(direction.t)),
        rate(largest(state.q.as_slice()), largest(direction.q.as_slice())),
        rate(largest(state.v.as_slice()), largest(direction.v.as_slice())),
        parameter.map_or(T::constant(0.0), |value| rate(Scalar::abs(value), T::constant(1.0))),
    ];
    T::constant(1.0) / unit_of(rates.into_iter().fold(T::constant(0.0), larger))
}
