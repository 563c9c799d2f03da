//! Root finding: the crossing of an event within an interval.

use super::definition::AnyEvent;
use super::dense::DenseStep;
use crate::error::Error;
use crate::motion::Interpolant;
use crate::number::{Real, Scalar, larger};
use crate::numerics::bracket::{Probe, narrow};
use crate::solution::vector_field::VectorField;
use crate::system::{State, StateOf, System};
use crate::vector::Length;

/// Finds the state between the two given ones at which an event crosses zero. Its function there is zero; or it has the sign of
/// the second state, or of the first one if it is a condition.
pub(super) fn locate<L, F, I>(
    stride: &DenseStep<'_, L, F, I>,
    event: &impl AnyEvent<L>,
    between: [&StateOf<L>; 2],
    (values, is_condition): ([L::Scalar; 2], bool),
) -> Result<StateOf<L>, Error>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    I: Interpolant<L::Scalar, L::Length>,
{
    let constant = L::Scalar::constant;
    let [a, b] = between;
    let length = b.t - a.t;
    let round_off = constant(L::Scalar::EPSILON) * larger(Scalar::abs(a.t), Scalar::abs(b.t));
    let resolution = round_off / Scalar::abs(length);
    let [low, high] = narrow(ends(between, values), resolution, |x| probe(stride, event, between, x))?;
    // No representable time lies between these two: interpolate between their states.
    let between = |x: L::Scalar| low.what.each_with(&high.what, |low, high| low + (high - low) * x);
    let finest = constant(L::Scalar::EPSILON);
    let [low, high] =
        narrow(ends([&low.what, &high.what], [low.value, high.value]), finest, |x| -> Result<_, Error> {
            let state = between(x);
            let value = event.value(stride.system, &state)?;
            Ok((state, value))
        })?;
    let ends_low = is_condition && high.value != constant(0.0);
    Ok(if ends_low { low.what } else { high.what })
}

/// Two states and the function's values there, as the points x = 0 and x = 1.
fn ends<T: Real, N: Length>(
    [low, high]: [&State<T, N>; 2],
    [at_low, at_high]: [T; 2],
) -> [Probe<T, State<T, N>>; 2] {
    [
        Probe { x: T::constant(0.0), what: low.clone(), value: at_low },
        Probe { x: T::constant(1.0), what: high.clone(), value: at_high },
    ]
}

/// State at a fraction x of an interval, and the value of the event's function there.
fn probe<L, F, I>(
    stride: &DenseStep<'_, L, F, I>,
    event: &impl AnyEvent<L>,
    [a, b]: [&StateOf<L>; 2],
    x: L::Scalar,
) -> Result<(StateOf<L>, L::Scalar), Error>
where
    L: System<Scalar: Real>,
    F: VectorField<L>,
    I: Interpolant<L::Scalar, L::Length>,
{
    let state = stride.at(a.t + x * (b.t - a.t))?;
    let value = event.value(stride.system, &state)?;
    Ok((state, value))
}
