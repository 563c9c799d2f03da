//! The rank of a matrix whose entries are known to within error bounds.

use super::evaluate::Approximate;

/// The rank by Gaussian elimination with complete pivoting, whose pivots are entries that are surely not zero:
/// the exact matrix has at least this rank, and no more is seen in its values.
pub(crate) fn rank(mut rows: Vec<Vec<Approximate>>) -> usize {
    let mut rank = 0;
    while let Some((row, column)) = largest(&rows[rank..]) {
        rows.swap(rank, rank + row);
        let (done, rest) = rows.split_at_mut(rank + 1);
        let pivot = &done[rank];
        for row in rest {
            let factor = row[column].over(pivot[column]);
            for (entry, &above) in row.iter_mut().zip(pivot) {
                *entry = entry.minus(factor.times(above));
            }
            row[column] = Approximate { value: 0.0, error: 0.0 };
        }
        rank += 1;
    }
    rank
}

/// Where the largest of the entries stands that are surely not zero.
fn largest(rows: &[Vec<Approximate>]) -> Option<(usize, usize)> {
    let places = rows.iter().enumerate().flat_map(|(i, row)| (0..row.len()).map(move |j| (i, j)));
    let sure = places.filter(|&(i, j)| rows[i][j].excludes_zero());
    sure.max_by(|&(i, j), &(k, l)| rows[i][j].value.abs().total_cmp(&rows[k][l].value.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(rows: &[&[f64]]) -> usize {
        let entry = |&value: &f64| Approximate { value, error: 0.0 };
        rank(rows.iter().map(|row| row.iter().map(entry).collect()).collect())
    }

    #[test]
    fn of_exact_matrices() {
        assert_eq!(exact(&[]), 0);
        assert_eq!(exact(&[&[0.0, 0.0]]), 0);
        assert_eq!(exact(&[&[0.0, 2.0], &[3.0, 0.0]]), 2);
        assert_eq!(exact(&[&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0], &[7.0, 8.0, 9.0]]), 2);
        assert_eq!(exact(&[&[0.1, 0.3], &[0.2, 0.6], &[0.3, 0.9]]), 1);
        // A hundred times the spacing of the numbers is not rounding.
        assert_eq!(exact(&[&[1.0, 1.0], &[1.0, 1.0 + 1e-13]]), 2);
    }

    #[test]
    fn an_entry_within_its_error_does_not_count() {
        let entry = |value, error| Approximate { value, error };
        let one = entry(1.0, 0.0);
        assert_eq!(rank(vec![vec![one, one], vec![one, entry(1.1, 0.2)]]), 1);
        assert_eq!(rank(vec![vec![one, one], vec![one, entry(1.1, 0.05)]]), 2);
    }
}
