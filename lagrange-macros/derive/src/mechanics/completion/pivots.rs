//! Number of pivots of a symmetric matrix, by elimination with diagonal pivoting.

pub(super) type Matrix = Vec<Vec<f64>>;

/// Largest pivot, relative to the largest entry of its row, that counts as zero.
const SMALL: f64 = 1e-8;

/// Condition on every pivot.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Wanted {
    /// Positive.
    Definite,
    /// Not zero.
    Regular,
}

/// Counts the pivots of an LDLᵀ factorization that always takes the largest diagonal entry.
pub(super) fn pivots(matrix: &Matrix, wanted: Wanted) -> usize {
    let mut a = matrix.clone();
    let scales: Vec<f64> = a.iter().map(|row| row.iter().fold(0.0, |most, x| x.abs().max(most))).collect();
    let mut left: Vec<usize> = (0..a.len()).collect();
    let size = |a: &Matrix, i: usize| match wanted {
        Wanted::Definite => a[i][i] / scales[i],
        Wanted::Regular => a[i][i].abs() / scales[i],
    };
    loop {
        let sized = left.iter().enumerate().map(|(place, &i)| (place, size(&a, i)));
        let next = sized.filter(|&(_, size)| size > SMALL).max_by(|(_, x), (_, y)| x.total_cmp(y));
        let Some((place, _)) = next else { return a.len() - left.len() };
        let pivot = left.swap_remove(place);
        eliminate(&mut a, pivot, &left);
    }
}

fn eliminate(a: &mut Matrix, pivot: usize, left: &[usize]) {
    let row = a[pivot].clone();
    let beside: Vec<usize> = left.iter().copied().filter(|&j| row[j] != 0.0).collect();
    for &i in &beside {
        let l = row[i] / row[pivot];
        beside.iter().for_each(|&j| a[i][j] -= l * row[j]);
    }
}

/// `matrix` + `weight` `row` `row`ᵀ
pub(super) fn add_square(matrix: &mut Matrix, weight: f64, row: &[f64]) {
    for (entries, &x) in matrix.iter_mut().zip(row).filter(|(_, x)| **x != 0.0) {
        entries.iter_mut().zip(row).for_each(|(entry, &y)| *entry += weight * x * y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pivots_are_counted_by_what_they_must_be() {
        let cases: [(&[&[f64]], usize, usize); 5] = [
            (&[&[2.0, 1.0], &[1.0, 2.0]], 2, 2),
            // Semidefinite: the last pivot is a rounding error.
            (&[&[0.01, 0.03], &[0.03, 0.09]], 1, 1),
            // Indefinite; the second one has a zero diagonal.
            (&[&[1.0, 2.0], &[2.0, 1.0]], 1, 2),
            (&[&[0.0, 1.0], &[1.0, 0.0]], 0, 0),
            (&[&[1.0, 0.0, 0.0], &[0.0, 0.0, 0.0], &[0.0, 0.0, f64::NAN]], 1, 1),
        ];
        for (rows, definite, regular) in cases {
            let matrix: Matrix = rows.iter().map(|row| row.to_vec()).collect();
            assert_eq!(pivots(&matrix, Wanted::Definite), definite, "{rows:?}");
            assert_eq!(pivots(&matrix, Wanted::Regular), regular, "{rows:?}");
        }
    }

    #[test]
    fn the_square_of_a_row_makes_up_for_what_is_missing() {
        let mut matrix = vec![vec![1.0, 2.0], vec![2.0, 4.0]];
        add_square(&mut matrix, 0.5, &[2.0, -1.0]);
        assert_eq!(matrix, [[3.0, 1.0], [1.0, 4.5]]);
        assert_eq!(pivots(&matrix, Wanted::Definite), 2);
    }
}
