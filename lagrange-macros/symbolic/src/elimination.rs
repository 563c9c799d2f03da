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
