//! The order in which a symmetric matrix is eliminated: always the row with the fewest others left in it
//! (minimum degree: George and Liu, *SIAM Review* 31, 1989).

use std::collections::BTreeSet;

/// The order, and how many multiplications and subtractions it takes.
pub(super) fn elimination_order(pattern: &[Vec<bool>]) -> (Vec<usize>, usize) {
    let n = pattern.len();
    let mut neighbours: Vec<BTreeSet<usize>> =
        (0..n).map(|i| (0..n).filter(|&j| j != i && (pattern[i][j] || pattern[j][i])).collect()).collect();
    let mut left: BTreeSet<usize> = (0..n).collect();
    let (mut order, mut cost) = (Vec::with_capacity(n), 0);
    while let Some(&next) = left.iter().min_by_key(|&&i| neighbours[i].len()) {
        left.remove(&next);
        let clique = std::mem::take(&mut neighbours[next]);
        for &i in &clique {
            neighbours[i].remove(&next);
            neighbours[i].extend(clique.iter().filter(|&&j| j != i));
        }
        cost += clique.len() * (clique.len() + 2);
        order.push(next);
    }
    (order, cost)
}

/// Rows and columns in the order given.
pub(super) fn permuted<T: Copy>(matrix: Vec<Vec<T>>, order: &[usize]) -> Vec<Vec<T>> {
    order.iter().map(|&i| order.iter().map(|&j| matrix[i][j]).collect()).collect()
}

pub(super) fn reordered<T: Copy>(x: Vec<T>, order: &[usize]) -> Vec<T> {
    order.iter().map(|&i| x[i]).collect()
}

/// Back from the order given.
pub(super) fn restored<T: Copy>(x: Vec<T>, order: &[usize]) -> Vec<T> {
    let mut places: Vec<(usize, T)> = order.iter().copied().zip(x).collect();
    places.sort_unstable_by_key(|(place, _)| *place);
    places.into_iter().map(|(_, x)| x).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(n: usize, occupied: impl Fn(usize, usize) -> bool) -> Vec<Vec<bool>> {
        (0..n).map(|i| (0..n).map(|j| i == j || occupied(i, j)).collect()).collect()
    }

    #[test]
    fn the_hub_of_an_arrow_goes_last_and_nothing_fills_in() {
        let (order, cost) = elimination_order(&pattern(6, |i, j| i == 0 || j == 0));
        assert!(order.iter().position(|&i| i == 0) >= Some(4), "{order:?}");
        assert_eq!(cost, 5 * 3);
    }

    #[test]
    fn a_band_costs_as_much_as_its_length() {
        let cost = |n| elimination_order(&pattern(n, |i, j| i.abs_diff(j) == 1)).1;
        assert_eq!((cost(5), cost(10), cost(20)), (4 * 3, 9 * 3, 19 * 3));
    }

    #[test]
    fn what_is_reordered_can_be_restored() {
        let order = [2, 0, 3, 1];
        assert_eq!(restored(reordered(vec![10, 11, 12, 13], &order), &order), [10, 11, 12, 13]);
        assert_eq!(permuted(vec![vec![0, 1], vec![2, 3]], &[1, 0]), [[3, 2], [1, 0]]);
    }
}
