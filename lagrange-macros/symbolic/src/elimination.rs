//! Gauss–Jordan elimination on numbers with error bounds.

use super::evaluate::Approximate;

/// A solution of A x = b.
#[derive(Debug)]
pub struct Solution {
    pub values: Vec<Approximate>,
    /// True for each unknown that the equations leave undetermined; its value is then zero.
    pub free: Vec<bool>,
}

/// Solves A x = b, with rows of A followed by the entry of b; `None` if the equations contradict each other.
pub fn solve(mut rows: Vec<Vec<Approximate>>, unknowns: usize) -> Option<Solution> {
    let pivots = eliminate(&mut rows, unknowns);
    if rows[pivots.len()..].iter().any(|row| row[unknowns].excludes_zero()) {
        return None;
    }
    let mut solution =
        Solution { values: vec![Approximate::exact(0.0); unknowns], free: vec![true; unknowns] };
    for (row, column) in rows.iter().zip(pivots) {
        solution.values[column] = row[unknowns].over(row[column]);
        solution.free[column] = false;
    }
    Some(solution)
}

/// Lower bound of the rank of the exact matrix: entries within their error bounds count as zero.
pub fn rank(mut rows: Vec<Vec<Approximate>>) -> usize {
    let columns = rows.first().map_or(0, Vec::len);
    eliminate(&mut rows, columns).len()
}

/// Eliminates with complete pivoting among the first `columns`. Every pivot is surely nonzero. Returns the column of
/// each pivot; pivot k is in row k.
fn eliminate(rows: &mut [Vec<Approximate>], columns: usize) -> Vec<usize> {
    let mut pivots: Vec<usize> = Vec::new();
    while let Some((row, column)) = largest(rows, &pivots, columns) {
        let step = pivots.len();
        rows.swap(step, row);
        pivots.push(column);
        let pivot = std::mem::take(&mut rows[step]);
        rows.iter_mut().filter(|row| !row.is_empty()).for_each(|row| subtract(row, &pivot, column));
        rows[step] = pivot;
    }
    pivots
}

/// Row and column of the largest entry that is surely nonzero.
fn largest(rows: &[Vec<Approximate>], pivots: &[usize], columns: usize) -> Option<(usize, usize)> {
    let columns = || (0..columns).filter(|column| !pivots.contains(column));
    let entries = (pivots.len()..rows.len()).flat_map(|row| columns().map(move |column| (row, column)));
    let size = |&(row, column): &(usize, usize)| rows[row][column].value.abs();
    entries
        .filter(|&(row, column)| rows[row][column].excludes_zero())
        .max_by(|x, y| size(x).total_cmp(&size(y)))
}

/// Subtracts the multiple of `pivot` that makes the entry in `column` zero.
fn subtract(row: &mut [Approximate], pivot: &[Approximate], column: usize) {
    if row[column].is_zero() {
        return;
    }
    let factor = row[column].over(pivot[column]);
    for (entry, &above) in row.iter_mut().zip(pivot).filter(|(_, above)| !above.is_zero()) {
        *entry = entry.minus(factor.times(above));
    }
    row[column] = Approximate::exact(0.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(numbers: &[&[f64]]) -> Vec<Vec<Approximate>> {
        numbers.iter().map(|row| row.iter().map(|&x| Approximate::exact(x)).collect()).collect()
    }

    #[test]
    fn the_bounds_of_a_solution_contain_it() {
        // Hilbert matrix, with condition number 5e5, times (1, −1, 2, 3, −4).
        let exact = [1.0, -1.0, 2.0, 3.0, -4.0];
        let hilbert = |i: usize| -> Vec<f64> { (0..5).map(|j| 1.0 / (i + j + 1) as f64).collect() };
        let system: Vec<Vec<f64>> = (0..5)
            .map(|i| {
                let row = hilbert(i);
                let right = row.iter().zip(exact).map(|(a, x)| a * x).sum();
                [row, vec![right]].concat()
            })
            .collect();
        let system: Vec<&[f64]> = system.iter().map(Vec::as_slice).collect();
        let mut system = rows(&system);
        system.iter_mut().flatten().for_each(|entry| entry.error = 4.0 * f64::EPSILON);
        let solution = solve(system, 5).expect("a solution");
        for (x, exact) in solution.values.iter().zip(exact) {
            assert!((x.value - exact).abs() <= x.error && x.error < 1e-6, "{x:?} for {exact}");
        }
    }

    #[test]
    fn dependent_equations_leave_an_unknown_open() {
        let solution = solve(rows(&[&[0.1, 0.2, 0.3], &[0.2, 0.4, 0.6]]), 2).expect("a solution");
        assert_eq!(solution.free, [true, false]);
        assert!((solution.values[1].value - 1.5).abs() < 1e-15);
        assert!(solve(rows(&[&[0.1, 0.2, 0.3], &[0.2, 0.4, 0.5]]), 2).is_none());
    }

    fn exact(rows: &[&[f64]]) -> usize {
        let entry = |&value: &f64| Approximate { value, error: 0.0 };
        rank(rows.iter().map(|row| row.iter().map(entry).collect()).collect())
    }

    #[test]
    fn ranks_of_exact_matrices() {
        assert_eq!(exact(&[]), 0);
        assert_eq!(exact(&[&[0.0, 0.0]]), 0);
        assert_eq!(exact(&[&[0.0, 2.0], &[3.0, 0.0]]), 2);
        assert_eq!(exact(&[&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0], &[7.0, 8.0, 9.0]]), 2);
        assert_eq!(exact(&[&[0.1, 0.3], &[0.2, 0.6], &[0.3, 0.9]]), 1);
        // 1e-13 is well above rounding: hundreds of units in the last place.
        assert_eq!(exact(&[&[1.0, 1.0], &[1.0, 1.0 + 1e-13]]), 2);
    }

    #[test]
    fn an_entry_within_its_error_does_not_count() {
        let entry = |value, error| Approximate { value, error };
        let one = entry(1.0, 0.0);
        assert_eq!(rank(vec![vec![one, one], vec![one, entry(1.1, 0.2)]]), 1);
        assert_eq!(rank(vec![vec![one, one], vec![one, entry(1.1, 0.05)]]), 2);
    }

    /// An unknown that is 0 ± 0.1 times another one, of value 1, has an error bound of 0.1 at least. This must hold
    /// both if the uncertain entry is in the pivot row and if it is in the eliminated row.
    #[test]
    fn what_may_be_zero_is_not_taken_for_zero() {
        let blurred = Approximate { value: 0.0, error: 0.1 };
        let [one, two] = [1.0, 2.0].map(Approximate::exact);
        for rows in [[[one, blurred, two], [blurred, two, two]], [[two, blurred, two], [one, one, two]]] {
            let solution = solve(rows.map(Vec::from).into(), 2).expect("a solution");
            assert!(solution.values.iter().all(|x| x.error > 0.04), "{:?}", solution.values);
        }
    }
}
