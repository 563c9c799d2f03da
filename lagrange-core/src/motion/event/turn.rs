//! Where a function that has the same sign at two places turns back in between, and beyond zero.

use super::narrow::Probe;
use crate::number::{Real, Scalar};

/// So many places are looked at.
const PLACES: usize = 16;

/// So many parabolas in a row tell that the function stays on its side.
const CONVINCING: usize = 3;

/// What one neighbour may be farther away than the other: with more a parabola says little.
const UNEVEN: f64 = 8.0;

/// A place between these two at which the function has the other sign than at both ends, of which one may be zero: the vertex of
/// the parabola through three of its values, again and again, until it does not come half as near to zero as the least of
/// them, a few times in a row. `at` gives what is at a place, and the value there.
///
/// Where both ends are zero, anything else is on the other side.
pub(super) fn beyond<T: Real, S: Copy, E>(
    [low, high]: [Probe<T, S>; 2],
    mut at: impl FnMut(T) -> Result<(S, T), E>,
) -> Result<Option<Probe<T, S>>, E> {
    let (zero, half) = (T::constant(0.0), T::constant(0.5));
    let sign = if low.value == zero { high.value.signum() } else { low.value.signum() };
    let mut outer = [low, high].map(|Probe { x, value, .. }| [x, value * sign]);
    let mut least: Option<[T; 2]> = None;
    let (mut x, mut staying) = (low.x + (high.x - low.x) * half, 0);
    let ends_at_zero = low.value == zero && high.value == zero;
    for _ in 0..PLACES {
        let (what, value) = at(x)?;
        if value * sign < zero || ends_at_zero && value != zero {
            return Ok(Some(Probe { x, what, value }));
        }
        let middle = inner(&mut outer, least, [x, value * sign]);
        least = Some(middle);
        let Some([vertex, lowest]) = vertex(outer[0], middle, outer[1]) else { return Ok(None) };
        if let Some(nearer) = nearer(outer, middle) {
            x = nearer;
            continue;
        }
        staying = if lowest > half * middle[1] { staying + 1 } else { 0 };
        if staying == CONVINCING || vertex == middle[0] {
            return Ok(None);
        }
        x = vertex;
    }
    Ok(None)
}

/// The lower of the least point so far and a new one; the other is an outer one from now on.
fn inner<T: Real>(outer: &mut [[T; 2]; 2], least: Option<[T; 2]>, new: [T; 2]) -> [T; 2] {
    let Some(old) = least else { return new };
    let [lower, higher] = if new[1] < old[1] { [new, old] } else { [old, new] };
    outer[usize::from(higher[0] > lower[0])] = higher;
    lower
}

/// Where to look instead of at the vertex, if one neighbour of the least point is much farther away than the other.
fn nearer<T: Real>([low, high]: [[T; 2]; 2], [x, _]: [T; 2]) -> Option<T> {
    let ([before, after], uneven) = ([x - low[0], high[0] - x], T::constant(UNEVEN));
    let two = T::constant(2.0);
    match () {
        () if after > before * uneven => Some(x + before * two),
        () if before > after * uneven => Some(x - after * two),
        () => None,
    }
}

/// The place at which the parabola through three points is least, and the value there: between the outer two, close to the
/// end where it is a little beyond.
fn vertex<T: Real>([x0, y0]: [T; 2], [x1, y1]: [T; 2], [x2, y2]: [T; 2]) -> Option<[T; 2]> {
    let two = T::constant(2.0);
    let [before, after] = [(y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1)];
    let bend = (after - before) / (x2 - x0);
    if bend <= T::constant(0.0) || !Scalar::abs(bend).is_finite() {
        return None;
    }
    let slope_in_the_middle = before + bend * (x1 - x0);
    let away = -slope_in_the_middle / (two * bend);
    let [least, most] = [x0 - x1, x2 - x1];
    let (nearly, lowest) = (T::constant(0.875), y1 - bend * away * away);
    match () {
        () if away < two * least || away > two * most => None,
        () if away <= least => Some([x1 + nearly * least, lowest]),
        () if away >= most => Some([x1 + nearly * most, lowest]),
        () => Some([x1 + away, lowest]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the function is below zero, though above at 0 and 1, and the evaluations.
    fn below(f: impl Fn(f64) -> f64) -> (Option<f64>, usize) {
        let ends = [0.0, 1.0].map(|x| Probe { x, what: x, value: f(x) });
        let mut evaluations = 0;
        let found = beyond(ends, |x| {
            evaluations += 1;
            Ok::<_, ()>((x, f(x)))
        });
        (found.expect("no error").map(|probe| probe.what), evaluations)
    }

    #[test]
    fn a_function_that_dips_a_little_is_found_below_zero() {
        for k in 1..100 {
            let (place, depth) = (0.01 * f64::from(k), 1e-12);
            let shapes: [&dyn Fn(f64) -> f64; 3] =
                [&|s| s * s, &|s| s * s * (1.0 + 0.3 * s), &|s| s.exp() - 1.0 - s];
            for shape in shapes {
                for sign in [1.0, -1.0] {
                    let (found, evaluations) = below(|x| sign * (shape(x - place) - depth));
                    let found = found.unwrap_or_else(|| panic!("no dip at {place} after {evaluations}"));
                    assert!(shape(found - place) < depth && evaluations <= PLACES, "{place}, {found}");
                }
                let (found, evaluations) = below(|x| shape(x - place) + depth);
                assert!(found.is_none() && evaluations <= PLACES);
            }
        }
    }

    #[test]
    fn what_does_not_turn_back_costs_one_evaluation() {
        for function in [|x: f64| 0.1 + x, |x: f64| 2.0 - x * x] {
            assert_eq!(below(function), (None, 1));
        }
        assert_eq!(below(|x| 0.2 + (x - 0.3).powi(2)), (None, 2));
        assert_eq!((below(|_| 0.0), below(|x| x * (1.0 - x))), ((None, 1), (Some(0.5), 1)));
        // From a zero on, it may go either way.
        assert!(below(|x| x * (x - 0.001)).0.is_some_and(|x| x < 0.001));
        assert_eq!(below(|x| x * (x + 0.001)).0, None);
    }
}
