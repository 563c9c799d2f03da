//! Multipliers that go among the coordinates: where loops hang on something that they share, a plate on legs, each is
//! closed before that, and what is left is as large as the plate. A multiplier goes after the coordinates that are the
//! loop's own; had it to wait for those that loops share, all of them would be tied to one another.
//!
//! M is positive definite, and remains so where a multiplier is taken out, whose pivot is negative (Vanderbei,
//! "Symmetric quasidefinite matrices", *SIAM Journal on Optimization* 5, 1995) unless the loop's own coordinates cannot
//! move what it holds. Then pivots cancel, or those of what is shared grow, and `Solution::pivot` tells before digits are lost.

use super::order::{Pattern, reduction_order};

/// The order of coordinates and multipliers, the latter behind the former by index, where it takes at most three quarters
/// of what it does to leave the multipliers to the end.
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
    (4 * cost <= 3 * in_order(&held).1).then_some(order)
}

/// The coordinates of a constraint that at most so many constraints hold; all of them if there are none.
fn own(row: &[usize], sharing: &[usize], most: usize) -> Vec<usize> {
    let own: Vec<usize> = row.iter().copied().filter(|&i| sharing[i] <= most).collect();
    if own.is_empty() { row.to_vec() } else { own }
}

/// M and F, each multiplier after its own coordinates.
fn together(matrix: &[Vec<bool>], rows: &[Vec<bool>], own: &[Vec<usize>]) -> Pattern {
    let (n, m) = (matrix.len(), rows.len());
    let top = (0..n).map(|i| matrix[i].iter().copied().chain(rows.iter().map(|row| row[i])).collect());
    let bottom = rows.iter().map(|row| row.iter().copied().chain((0..m).map(|_| false)).collect());
    let after = (0..n).map(|_| Vec::new()).chain(own.iter().cloned()).collect();
    Pattern { matrix: top.chain(bottom).collect(), definitions: Vec::new(), after }
}

/// Whether each constraint can be given an own coordinate that no other one gets (Kuhn, *Naval Research Logistics Quarterly*
/// 2, 1955).
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

    /// Loops of two coordinates and two constraints each on a plate of three.
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
        // The last loop ties no more together than the plate does then.
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

    /// Two constraints on one own coordinate: one of them has to wait for what is shared.
    #[test]
    fn a_loop_cannot_be_closed_by_too_few_coordinates() {
        let own = [vec![0], vec![0], vec![1, 2]];
        assert!(!are_enough(&own, 3));
        assert!(are_enough(&[vec![0, 1], vec![0], vec![1, 2]], 3));
    }
}
