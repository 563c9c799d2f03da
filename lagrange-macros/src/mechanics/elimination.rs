//! Small dense linear systems, solved with bounds on the rounding errors.

use crate::symbolic::Approximate;

/// A solution of A x = b.
pub(super) struct Solution {
    pub(super) values: Vec<Approximate>,
    /// Whether the equations leave this unknown open; its value is zero then.
    pub(super) free: Vec<bool>,
}

/// Gauss and Jordan's elimination with complete pivoting, on rows of A with their entry of b behind. Entries
/// whose bounds include zero count as zero. `None` where the equations contradict one another.
pub(super) fn solve(mut rows: Vec<Vec<Approximate>>, unknowns: usize) -> Option<Solution> {
    let mut pivots: Vec<usize> = Vec::new();
    while let Some((row, column)) = largest(&rows, &pivots, unknowns) {
        let step = pivots.len();
        rows.swap(step, row);
        pivots.push(column);
        let pivot = std::mem::take(&mut rows[step]);
        for row in rows.iter_mut().filter(|row| row.get(column).is_some_and(|x| x.excludes_zero())) {
            subtract(row, &pivot, column);
        }
        rows[step] = pivot;
    }
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

/// Row and column of the largest entry that is surely not zero.
fn largest(rows: &[Vec<Approximate>], pivots: &[usize], unknowns: usize) -> Option<(usize, usize)> {
    let columns = || (0..unknowns).filter(|column| !pivots.contains(column));
    let entries = (pivots.len()..rows.len()).flat_map(|row| columns().map(move |column| (row, column)));
    let size = |&(row, column): &(usize, usize)| rows[row][column].value.abs();
    entries
        .filter(|&(row, column)| rows[row][column].excludes_zero())
        .max_by(|x, y| size(x).total_cmp(&size(y)))
}

/// Takes off as much of `pivot` as makes the entry in `column` zero.
fn subtract(row: &mut [Approximate], pivot: &[Approximate], column: usize) {
    let factor = row[column].over(pivot[column]);
    for (entry, &above) in row.iter_mut().zip(pivot) {
        if above.value != 0.0 || above.error != 0.0 {
            *entry = entry.minus(factor.times(above));
        }
    }
    row[column] = Approximate::exact(0.0);
}

#[cfg(test)]
mod tests {
    use super::solve;
    use crate::symbolic::Approximate;

    fn rows(numbers: &[&[f64]]) -> Vec<Vec<Approximate>> {
        numbers.iter().map(|row| row.iter().map(|&x| Approximate::exact(x)).collect()).collect()
    }

    #[test]
    fn the_bounds_of_a_solution_contain_it() {
        // Hilbert's matrix, whose condition is 5e5, times (1, −1, 2, 3, −4).
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
}
