//! Proofs that a row of F is a combination of others, with coefficients that are finite wherever the rows are.
//!
//! Coefficients may have poles, as for the rods of a braced frame. The dependent row may then be needed at a pole, and
//! the constraint is not reported as redundant. Such cases are left to the numerical solution at run time.

use num_traits::{One, Zero};

use crate::symbolic::{ExactPolynomial, Polynomials, Rational, plus, times};

/// Largest number of rows in a combination whose coefficients are functions. Combinations with numbers as coefficients
/// have no limit.
const FUNCTIONS: usize = 4;

/// Row `index` equals Σ coefficient · row over the other rows, in all columns but the last.
pub(super) struct RowCombination {
    pub(super) index: usize,
    /// Coefficients of the rows, zero for row `index`. Functions as coefficients have a common factor that is nowhere
    /// zero.
    pub(super) coefficients: Vec<ExactPolynomial>,
    pub(super) numbers: Option<Vec<Rational>>,
    /// True if the combination holds in the last column, too.
    pub(super) is_complete: bool,
}

/// Finds a combination of rows that equals another row, the last one if possible; `None` if none is found.
pub(super) fn find(ring: &Polynomials, columns: &[Vec<ExactPolynomial>]) -> Option<RowCombination> {
    let count = columns.first()?.len();
    let one = ExactPolynomial::number(Rational::one());
    // The last entry is the common denominator: it has no zero where the rows have values.
    let mut entries = ring.cleared(&[&columns.concat()[..], std::slice::from_ref(&one)].concat())?;
    let unit = entries.pop()?;
    let columns: Vec<Vec<ExactPolynomial>> = entries.chunks(count).map(<[_]>::to_vec).collect();
    let (last, others) = columns.split_last()?;
    let numbers = numbers(others, count - 1).map(|numbers| [numbers, vec![Rational::zero()]].concat());
    let (index, unit, coefficients) = match &numbers {
        Some(numbers) => (count - 1, one, numbers.iter().copied().map(ExactPolynomial::number).collect()),
        None => {
            (count <= FUNCTIONS + 1).then_some(())?;
            let unit = ring.times(&unit, &unit)?;
            let (index, coefficients) = functions(ring, others, count - 1, &unit)?;
            (index, unit, coefficients)
        }
    };
    let is_met = |column: &[ExactPolynomial]| {
        let parts = coefficients.iter().zip(column);
        let rest = parts.into_iter().try_fold(ring.times(&unit, &column[index])?, |rest, (c, entry)| {
            rest.plus(&ring.times(c, entry)?, -Rational::one())
        });
        rest.map(|rest| rest.is_zero())
    };
    let is_combination = others.iter().all(|column| is_met(column) == Some(true));
    let is_complete = is_met(last)?;
    is_combination.then_some(RowCombination { index, coefficients, numbers, is_complete })
}

/// Numbers c with Σ c_k row_k = row `last`, by elimination on the coefficients of every monomial.
fn numbers(columns: &[Vec<ExactPolynomial>], last: usize) -> Option<Vec<Rational>> {
    let mut solved: Vec<Vec<Rational>> = Vec::new();
    let mut pivots: Vec<usize> = Vec::new();
    for column in columns {
        let mut monomials = std::collections::BTreeMap::new();
        for (k, entry) in column.iter().enumerate() {
            for (monomial, c) in entry.terms() {
                monomials.entry(monomial).or_insert_with(|| vec![Rational::zero(); last + 1])[k] = c;
            }
        }
        for mut equation in monomials.into_values() {
            for (known, &pivot) in solved.iter().zip(&pivots) {
                reduce(&mut equation, known, pivot)?;
            }
            let Some(pivot) = equation.iter().position(|c| !c.is_zero()) else { continue };
            // The equation 0 = c, with c ≠ 0, has no solution.
            (pivot < last).then_some(())?;
            let reciprocal = equation[pivot].recip();
            for c in &mut equation {
                *c = times(*c, reciprocal)?;
            }
            for known in &mut solved {
                reduce(known, &equation, pivot)?;
            }
            solved.push(equation);
            pivots.push(pivot);
        }
    }
    let value =
        |k| pivots.iter().position(|&pivot| pivot == k).map_or(Rational::zero(), |row| solved[row][last]);
    Some((0..last).map(value).collect())
}

fn reduce(equation: &mut [Rational], known: &[Rational], pivot: usize) -> Option<()> {
    let factor = -equation[pivot];
    if !factor.is_zero() {
        for (c, &other) in equation.iter_mut().zip(known) {
            *c = plus(*c, times(factor, other)?)?;
        }
    }
    Some(())
}

/// Cramer's rule: the minors ν of the rows in some columns satisfy Σ ν_k row_k = 0. A row whose ν divides all others
/// is a combination of them.
fn functions(
    ring: &Polynomials,
    columns: &[Vec<ExactPolynomial>],
    last: usize,
    unit: &ExactPolynomial,
) -> Option<(usize, Vec<ExactPolynomial>)> {
    // Columns with few terms first: short entries have short minors.
    let mut candidates: Vec<usize> = (0..columns.len()).collect();
    candidates
        .sort_by_key(|&column| columns[column].iter().map(|entry| entry.terms().count()).sum::<usize>());
    let mut chosen: Vec<usize> = Vec::new();
    for count in 1..=last {
        let rows: Vec<usize> = (0..count).collect();
        let adds = |&column: &usize| {
            let with = [&chosen[..], &[column]].concat();
            minor(ring, columns, &rows, &with).is_some_and(|minor| !minor.is_zero())
        };
        let next = *candidates.iter().find(|column| !chosen.contains(column) && adds(column))?;
        chosen.push(next);
    }
    let parts: Option<Vec<ExactPolynomial>> = (0..=last)
        .map(|left_out| {
            let rows: Vec<usize> = (0..=last).filter(|&row| row != left_out).collect();
            let minor = minor(ring, columns, &rows, &chosen)?;
            let sign = if left_out % 2 == 0 { Rational::one() } else { -Rational::one() };
            ExactPolynomial::default().plus(&minor, sign)
        })
        .collect();
    let parts = parts?;
    (0..=last).rev().find_map(|index| {
        let coefficient = |k: usize| {
            if k == index {
                return Some(ExactPolynomial::default());
            }
            let quotient = ring.quotient(&ring.times(&parts[k], unit)?, &parts[index])?;
            ExactPolynomial::default().plus(&quotient, -Rational::one())
        };
        let coefficients: Option<Vec<ExactPolynomial>> = (0..=last).map(coefficient).collect();
        Some((index, coefficients?))
    })
}

/// Minor of `rows` in the columns `chosen`, by expansion along the last row.
fn minor(
    ring: &Polynomials,
    columns: &[Vec<ExactPolynomial>],
    rows: &[usize],
    chosen: &[usize],
) -> Option<ExactPolynomial> {
    let Some((&row, above)) = rows.split_last() else {
        return Some(ExactPolynomial::number(Rational::one()));
    };
    let mut sum = ExactPolynomial::default();
    for (place, &column) in chosen.iter().enumerate() {
        let rest: Vec<usize> = chosen.iter().copied().filter(|&other| other != column).collect();
        let sign = if (place + above.len()) % 2 == 0 { Rational::one() } else { -Rational::one() };
        let product = match columns[column][row].is_zero() {
            true => continue,
            false => ring.times(&columns[column][row], &minor(ring, columns, above, &rest)?)?,
        };
        sum = sum.plus(&product, sign)?;
    }
    Some(sum)
}
