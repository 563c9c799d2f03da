//! LDLᵀ factorization of sparse symmetric positive definite matrices.
//!
//! The pattern of the nonzero entries is analysed once, the values change. Rows are eliminated by least degree, which leaves a chain or a
//! tree without fill (George and Liu, *The evolution of the minimum degree ordering algorithm*, SIAM Review 31, 1989); a matrix of
//! few entries in each row then takes a time proportional to its rows. Values are factorized row by row, with the columns above
//! (Davis, *Direct Methods for Sparse Linear Systems*, 4.8).

use alloc::collections::BTreeSet;
use alloc::vec::Vec;
use core::ops::Range;

use super::ldl::poison;
use crate::number::Scalar;

/// Factorization of matrices of one pattern. Rows are numbered as in the matrix; *places* are those of the elimination.
pub(crate) struct SparseLdl<T> {
    /// Place of each row.
    places: Vec<usize>,
    /// Lower triangle of the matrix, for each row: the entries left of the diagonal, then the diagonal.
    matrix: Lists<T>,
    /// L without its diagonal, for each row.
    left: Lists<T>,
    /// The same for each column, as indices of the entries of `left`.
    below: Lists<usize>,
    /// 1/D
    inverse: Vec<T>,
    /// Zeros, but while a row is factorized or a right-hand side is solved for.
    row: Vec<T>,
}

/// A list of entries for each row or column, each with its place along it.
struct Lists<V> {
    /// Index of the first entry of each list and, at the end, the number of all entries.
    starts: Vec<usize>,
    places: Vec<usize>,
    values: Vec<V>,
}

impl<V: Copy> Lists<V> {
    fn of(lists: impl IntoIterator<Item = Vec<(usize, V)>>) -> Self {
        let mut all = Self { starts: alloc::vec![0], places: Vec::new(), values: Vec::new() };
        for list in lists {
            let (places, values): (Vec<usize>, Vec<V>) = list.into_iter().unzip();
            all.places.extend(places);
            all.values.extend(values);
            all.starts.push(all.places.len());
        }
        all
    }

    fn list(&self, i: usize) -> Range<usize> {
        self.starts[i]..self.starts[i + 1]
    }
}

impl<T: Scalar> SparseLdl<T> {
    /// Chooses the order of elimination for matrices of a symmetric pattern. `neighbours` has, for each row, the columns of its entries
    /// beside the diagonal.
    pub(crate) fn of(neighbours: Vec<BTreeSet<usize>>) -> Self {
        let count = neighbours.len();
        let (order, below) = eliminated(neighbours.clone());
        let mut places = alloc::vec![0; count];
        order.iter().enumerate().for_each(|(place, &row)| places[row] = place);
        let zero = T::constant(0.0);
        let own = |(place, row): (usize, &usize)| {
            let others = neighbours[*row].iter().map(|other| places[*other]).filter(|other| *other < place);
            let mut row: Vec<(usize, T)> = others.chain([place]).map(|other| (other, zero)).collect();
            row.sort_unstable_by_key(|(other, _)| *other);
            row
        };
        let matrix = Lists::of(order.iter().enumerate().map(own));
        let mut rows = alloc::vec![Vec::new(); count];
        for (column, others) in below.iter().enumerate() {
            others.iter().for_each(|row| rows[places[*row]].push((column, zero)));
        }
        let left = Lists::of(rows);
        let mut columns = alloc::vec![Vec::new(); count];
        for place in 0..count {
            left.list(place).for_each(|entry| columns[left.places[entry]].push((place, entry)));
        }
        let zeros = alloc::vec![zero; count];
        Self { places, matrix, left, below: Lists::of(columns), inverse: zeros.clone(), row: zeros }
    }

    /// Index of an entry of the matrix among the [`values`](Self::values), if it is in the pattern.
    pub(crate) fn entry(&self, row: usize, column: usize) -> Option<usize> {
        let [one, other] = [self.places[row], self.places[column]];
        let range = self.matrix.list(one.max(other));
        let found = self.matrix.places[range.clone()].binary_search(&one.min(other)).ok()?;
        Some(range.start + found)
    }

    /// Values of the matrix: its diagonal and, once for both triangles, the other entries of the pattern.
    pub(crate) fn values(&mut self) -> &mut [T] {
        &mut self.matrix.values
    }

    /// Factorizes the matrix of the current values. Returns the smallest ratio of a pivot to its diagonal entry, NaN or not positive if
    /// the matrix is not positive definite.
    pub(crate) fn factor(&mut self) -> T {
        (0..self.places.len()).fold(T::constant(1.0), |least, place| {
            let ratio = self.factor_row(place);
            poison(least.min(ratio), least * ratio)
        })
    }

    /// First row in the order of elimination whose ratio of the pivot to its diagonal entry is not trusted, in the matrix factorized
    /// last: it depends on rows before it. Ratios behind it tell nothing.
    pub(crate) fn dependent(&self, is_trusted: impl Fn(T) -> bool) -> Option<usize> {
        let mut order: Vec<(usize, usize)> = self.places.iter().copied().zip(0..).collect();
        order.sort_unstable();
        let ratio = |place: usize| {
            let diagonal = self.matrix.values[self.matrix.starts[place + 1] - 1];
            T::constant(1.0) / (diagonal * self.inverse[place])
        };
        order.into_iter().find(|(place, _)| !is_trusted(ratio(*place))).map(|(_, row)| row)
    }

    /// Factorizes a row below others, and returns the ratio of its pivot to its diagonal entry.
    fn factor_row(&mut self, place: usize) -> T {
        let (zero, own) = (T::constant(0.0), self.matrix.list(place));
        for entry in own.clone() {
            self.row[self.matrix.places[entry]] = self.matrix.values[entry];
        }
        let diagonal = core::mem::replace(&mut self.row[place], zero);
        let mut pivot = diagonal;
        for entry in self.left.list(place) {
            let column = self.left.places[entry];
            let value = self.row[column];
            for below in self.below.list(column) {
                let row = self.below.places[below];
                if row >= place {
                    break;
                }
                self.row[row] = self.row[row] - self.left.values[self.below.values[below]] * value;
            }
            let factor = value * self.inverse[column];
            pivot = pivot - factor * value;
            self.left.values[entry] = factor;
            self.row[column] = zero;
        }
        self.inverse[place] = T::constant(1.0) / pivot;
        pivot / diagonal
    }

    /// Solves for `x` in place, with the matrix factorized last.
    pub(crate) fn solve(&mut self, x: &mut [T]) {
        for (&place, x) in self.places.iter().zip(&*x) {
            self.row[place] = *x;
        }
        for place in 0..x.len() {
            let known = self.left.list(place);
            let known = known.map(|entry| self.left.values[entry] * self.row[self.left.places[entry]]);
            self.row[place] = known.fold(self.row[place], |x, known| x - known);
        }
        for place in (0..x.len()).rev() {
            let scaled = self.row[place] * self.inverse[place];
            let known = self.below.list(place);
            let known = known
                .map(|below| self.left.values[self.below.values[below]] * self.row[self.below.places[below]]);
            self.row[place] = known.fold(scaled, |x, known| x - known);
        }
        for (&place, x) in self.places.iter().zip(x) {
            *x = core::mem::replace(&mut self.row[place], T::constant(0.0));
        }
    }
}

/// Rows in the order of elimination by least degree, and for each the rows that its column of L has entries in.
fn eliminated(mut neighbours: Vec<BTreeSet<usize>>) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut waiting: BTreeSet<(usize, usize)> =
        neighbours.iter().enumerate().map(|(row, others)| (others.len(), row)).collect();
    let (mut order, mut below) = (Vec::new(), Vec::new());
    while let Some((_, row)) = waiting.pop_first() {
        let others: Vec<usize> = core::mem::take(&mut neighbours[row]).into_iter().collect();
        for &other in &others {
            waiting.remove(&(neighbours[other].len(), other));
            neighbours[other].remove(&row);
            neighbours[other].extend(others.iter().copied().filter(|&third| third != other));
            waiting.insert((neighbours[other].len(), other));
        }
        order.push(row);
        below.push(others);
    }
    (order, below)
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use lagrange_random::{Random, cases};
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::number::Dual;

    /// A pattern with each pair of rows at a probability.
    fn random_pattern(random: &mut Random, n: usize, density: f64) -> Vec<BTreeSet<usize>> {
        let mut neighbours = vec![BTreeSet::new(); n];
        for i in 0..n {
            for j in 0..i {
                if random.between(0.0, 1.0) < density {
                    neighbours[i].insert(j);
                    neighbours[j].insert(i);
                }
            }
        }
        neighbours
    }

    /// A symmetric matrix of a pattern, positive definite by its diagonal.
    fn definite(random: &mut Random, neighbours: &[BTreeSet<usize>]) -> DMatrix<f64> {
        let n = neighbours.len();
        let mut matrix = DMatrix::zeros(n, n);
        for i in 0..n {
            for &j in neighbours[i].iter().filter(|j| **j < i) {
                matrix[(i, j)] = random.between(-1.0, 1.0);
                matrix[(j, i)] = matrix[(i, j)];
            }
        }
        for i in 0..n {
            matrix[(i, i)] = matrix.row(i).abs().sum() + random.between(0.01, 1.0);
        }
        matrix
    }

    fn write<T: Scalar>(ldl: &mut SparseLdl<T>, entry: impl Fn(usize, usize) -> T) {
        let n = ldl.places.len();
        for (i, j) in (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            if let Some(place) = ldl.entry(i, j) {
                ldl.values()[place] = entry(i, j);
            }
        }
    }

    /// Solutions agree with LU of the dense matrix at every size and density, also with a factorization that is used again.
    #[test]
    fn solutions_are_those_of_dense_elimination() {
        let mut random = Random(17);
        for case in 0..cases([200, 2_000, 100_000]) {
            let (n, density) = (case % 13, (case / 13 % 5) as f64 / 4.0);
            let neighbours = random_pattern(&mut random, n, density);
            let mut ldl = SparseLdl::of(neighbours.clone());
            for _ in 0..2 {
                let matrix = definite(&mut random, &neighbours);
                write(&mut ldl, |i, j| matrix[(i, j)]);
                assert!(ldl.factor() > 0.0);
                let mut x = DVector::from_fn(n, |_, _| random.between(-1.0, 1.0));
                let expected = if n == 0 { x.clone() } else { matrix.lu().solve(&x).unwrap() };
                ldl.solve(x.as_mut_slice());
                assert!(n == 0 || (x - expected).amax() < 1e-11, "{n} rows, density {density}");
            }
        }
    }

    /// A chain, numbered at random, and a star have no fill; a ring has one entry for each row but three.
    #[test]
    fn chains_and_trees_have_no_fill() {
        let mut random = Random(3);
        let n = 50;
        let mut names: Vec<usize> = (0..n).collect();
        (1..n).for_each(|i| names.swap(i, (random.between(0.0, i as f64 + 1.0) as usize).min(i)));
        let fill = |pairs: Vec<[usize; 2]>| {
            let mut neighbours = vec![BTreeSet::new(); n];
            for [i, j] in pairs {
                neighbours[i].insert(j);
                neighbours[j].insert(i);
            }
            let ldl = SparseLdl::<f64>::of(neighbours);
            ldl.left.places.len() + n - ldl.matrix.places.len()
        };
        assert_eq!(fill((1..n).map(|i| [names[i - 1], names[i]]).collect()), 0);
        assert_eq!(fill((1..n).map(|i| [0, i]).collect()), 0);
        assert_eq!(fill((0..n).map(|i| [names[i], names[(i + 1) % n]]).collect()), n - 3);
    }

    /// A row that depends on others is told by its pivot, and so are a zero and NaN on the diagonal.
    #[test]
    fn pivots_tell_what_is_not_definite() {
        let pair = || vec![BTreeSet::from([1]), BTreeSet::from([0]), BTreeSet::new()];
        let pivot = |diagonal: [f64; 3]| {
            let mut ldl = SparseLdl::of(pair());
            write(&mut ldl, |i, j| if i == j { diagonal[i] } else { 2.0 });
            let pivot = ldl.factor();
            (pivot, ldl.dependent(|ratio| ratio > 0.6))
        };
        assert_eq!(pivot([4.0, 2.0, 1.0]), (0.5, Some(1)));
        assert_eq!(pivot([4.0, 1.0, 1.0]), (0.0, Some(1)));
        assert!(pivot([4.0, 0.5, 1.0]).0 < 0.0);
        for wrong in [0.0, f64::NAN] {
            assert!(pivot([4.0, 2.0, wrong]).0.is_nan());
        }
    }

    /// Derivatives of a solution, for a matrix that changes: A x′ = −A′x.
    #[test]
    fn solutions_have_derivatives() {
        let mut random = Random(4);
        let neighbours = random_pattern(&mut random, 7, 0.4);
        let [matrix, change] = [0, 1].map(|_| definite(&mut random, &neighbours));
        let right = DVector::from_fn(7, |_, _| random.between(-1.0, 1.0));
        let solve = |y: &DVector<f64>| matrix.clone().lu().solve(y).unwrap();
        let x = solve(&right);
        let slope = -solve(&(&change * &x));
        let mut ldl = SparseLdl::of(neighbours);
        write(&mut ldl, |i, j| Dual { value: matrix[(i, j)], slope: change[(i, j)] });
        let mut solved: Vec<_> = right.iter().map(|&x| Dual::constant(x)).collect();
        ldl.factor();
        ldl.solve(&mut solved);
        for i in 0..7 {
            assert!((solved[i].value - x[i]).abs() < 1e-12);
            assert!((solved[i].slope - slope[i]).abs() < 1e-10);
        }
    }
}
