//! Zeros of a function by bracketing.

/// The times where `f` passes through zero, one between any two of `times` where its signs differ.
pub(crate) fn crossings(times: impl Iterator<Item = f64>, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let values: Vec<_> = times.map(|t| (t, f(t))).collect();
    let brackets = values.windows(2).filter_map(|pair| match *pair {
        [left, right] if left.1 * right.1 < 0.0 => Some((left, right)),
        _ => None,
    });
    brackets.map(|(left, right)| zero(left, right, &f)).collect()
}

/// The zero between two points of the graph of `f` on either side of it.
///
/// The chord's zero replaces the end of its sign; an end that stays has its value halved, so that the next chord leans
/// to it (the Illinois rule). Where a step changes nothing any more, the zero is known to round-off.
pub(super) fn zero(mut kept: (f64, f64), mut newest: (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let x = newest.0 - newest.1 * (newest.0 - kept.0) / (newest.1 - kept.1);
        let y = f(x);
        let change = (x - newest.0).abs();
        if newest.1 * y <= 0.0 {
            kept = newest;
        } else {
            kept.1 /= 2.0;
        }
        newest = (x, y);
        if y == 0.0 || change <= 2.0 * f64::EPSILON * x.abs() {
            break;
        }
    }
    newest.0
}
