//! Elimination order for constraints that share few coordinates. Bars in a row: each multiplier follows the coordinates
//! of its constraint, and precedes the other coordinates. If the multipliers followed all coordinates, and M⁻¹ is dense,
//! each would couple to each. A plate on several legs: the multipliers of a loop follow its own coordinates and precede
//! the shared ones. So each loop is closed on its own, and the rest is as large as the plate.
//!
//! M is positive definite and remains so when a multiplier is eliminated, which has a negative pivot (Vanderbei,
//! "Symmetric quasidefinite matrices", *SIAM Journal on Optimization* 5, 1995). The exception is a loop whose own
//! coordinates hardly move the constrained point. Then pivots cancel, or those of shared coordinates grow, and errors with them, up to
//! a third of the digits: then `Solution::pivot` leaves the solution to the general elimination.

use super::order::{Pattern, reduction_order};

/// Returns an order of coordinates and multipliers; the indices of the multipliers follow those of the coordinates.
/// `None` unless it takes at most three quarters of the operations of an order with all multipliers last.
pub(super) fn order(matrix: &[Vec<bool>], rows: &[Vec<bool>]) -> Option<Vec<usize>> {
    let n = matrix.len();
    let held: Vec<Vec<usize>> = rows.iter().map(|row| (0..n).filter(|&i| row[i]).collect()).collect();
    let sharing: Vec<usize> = (0..n).map(|i| rows.iter().filter(|row| row[i]).count()).collect();
    let in_order = |own: &[Vec<usize>]| reduction_order(&together(matrix, rows, own));
    let closed = |most: &usize| {
        let own: Vec<Vec<usize>> = held.iter().map(|row| own(row, &sharing, *most)).collect();
        are_enough(&own, n).then(|| in_order(&own))
    };
    let levels: std::collections::BTreeSet<usize> = sharing.iter().copied().collect();
    let (order, cost) = levels.iter().filter_map(closed).min_by_key(|&(_, cost)| cost)?;
    let last = vec![(0..n).collect(); rows.len()];
    (4 * cost <= 3 * in_order(&last).1).then_some(order)
}

/// Coordinates of a constraint that occur in at most `most` constraints. If there are none, all its coordinates.
fn own(row: &[usize], sharing: &[usize], most: usize) -> Vec<usize> {
    let own: Vec<usize> = row.iter().copied().filter(|&i| sharing[i] <= most).collect();
    if own.is_empty() { row.to_vec() } else { own }
}

/// Pattern of M and F, where each multiplier must follow the own coordinates of its constraint.
fn together(matrix: &[Vec<bool>], rows: &[Vec<bool>], own: &[Vec<usize>]) -> Pattern {
    let (n, m) = (matrix.len(), rows.len());
    let top = (0..n).map(|i| matrix[i].iter().copied().chain(rows.iter().map(|row| row[i])).collect());
    let bottom = rows.iter().map(|row| row.iter().copied().chain((0..m).map(|_| false)).collect());
    let after = (0..n).map(|_| Vec::new()).chain(own.iter().cloned()).collect();
    Pattern { matrix: top.chain(bottom).collect(), definitions: Vec::new(), after }
}

/// True if each constraint can be assigned an own coordinate that no other constraint gets (bipartite matching: Kuhn,
/// *Naval Research Logistics Quarterly* 2, 1955).
fn are_enough(own: &[Vec<usize>], n: usize) -> bool {
    let mut given = vec![None; n];
    (0..own.len()).all(|a| give(a, own, &mut given, &mut vec![false; n]))
}

fn give(a: usize, own: &[Vec<usize>], given: &mut [Option<usize>], seen: &mut [bool]) -> bool {
    for &i in &own[a] {
        if std::mem::replace(&mut seen[i], true) {
            continue;
        }
        if given[i].is_none_or(|b| give(b, own, given, seen)) {
            given[i] = Some(a);
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loops with two coordinates and two constraints each, on a plate with three coordinates.
    fn plate(loops: usize) -> (Vec<Vec<bool>>, Vec<Vec<bool>>) {
        let n = 3 + 2 * loops;
        let is_of = |k: usize, i: usize| i < 3 || (i - 3) / 2 == k;
        let mass = |i: usize, j: usize| (i < 3 && j < 3) || (i >= 3 && j >= 3 && (i - 3) / 2 == (j - 3) / 2);
        let matrix = (0..n).map(|i| (0..n).map(|j| mass(i, j)).collect()).collect();
        let rows = (0..2 * loops).map(|a| (0..n).map(|i| is_of(a / 2, i)).collect()).collect();
        (matrix, rows)
    }

    #[test]
    fn each_loop_is_closed_before_what_they_share() {
        let (matrix, rows) = plate(6);
        let order = order(&matrix, &rows).expect("cheaper");
        let place = |variable: usize| order.iter().position(|&other| other == variable);
        // Skip the last loop: once the others are eliminated, its own coordinates and those of the plate are equally
        // cheap to eliminate.
        for k in 0..10 {
            let (coordinate, multiplier) = (place(3 + k), place(15 + k));
            assert!(
                coordinate < multiplier && multiplier < place(0).min(place(1)).min(place(2)),
                "{order:?}"
            );
        }
    }

    #[test]
    fn one_loop_leaves_its_multipliers_to_the_end() {
        let (matrix, rows) = plate(1);
        assert_eq!(order(&matrix, &rows), None);
    }

    /// Two constraints with one own coordinate: one constraint has to wait for the shared coordinates.
    #[test]
    fn a_loop_cannot_be_closed_by_too_few_coordinates() {
        let own = [vec![0], vec![0], vec![1, 2]];
        assert!(!are_enough(&own, 3));
        assert!(are_enough(&[vec![0, 1], vec![0], vec![1, 2]], 3));
    }
}
