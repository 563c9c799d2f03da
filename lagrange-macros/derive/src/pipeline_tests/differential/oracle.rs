//! Accelerations and multipliers from derivatives of the Lagrangian as written and Gaussian elimination, to twice
//! the precision of f64. Each has the error bound that a solution in f64 can be expected to meet.

use super::double::Double;
use super::draft::{Draft, Term};
use super::here::Here;
use super::jet::{Jet, Running};

/// Accelerations, then multipliers.
pub(super) struct Solution {
    pub(super) values: Vec<Double>,
    /// Error bound of each value in f64, with every rounding error at its largest.
    pub(super) bounds: Vec<f64>,
}

/// Solves K x = r, [M −Fᵀ; F 0] (q̈, λ) = (h, −γ), with M = ∂²L/∂q̇∂q̇, h = ∂L/∂q + Q − ∂D/∂q̇ − (∂/∂t + q̇·∂/∂q)
/// ∂L/∂q̇. `None` if K is singular.
pub(super) fn solve(draft: &Draft, here: &Here) -> Option<Solution> {
    let (n, constraints) = (draft.count, &draft.constraints);
    let slopes = constraints.iter().map(|(term, of_velocities)| slopes(draft, here, term, *of_velocities));
    let slopes: Vec<Vec<Running>> = slopes.collect();
    let masses = |i: usize| (0..=i).map(move |j| lagrangian(draft, &here.by_velocity(i).by_velocity(j)));
    let masses: Vec<Vec<Running>> = (0..n).map(|i| masses(i).collect()).collect();
    let row = |i: usize| (0..n).map(|j| masses[i.max(j)][i.min(j)]).collect();
    let mut rows: Vec<Vec<Running>> = (0..n).map(row).collect();
    for (i, row) in rows.iter_mut().enumerate() {
        row.extend(slopes.iter().map(|slopes| negative(slopes[i])));
    }
    let mut right: Vec<Running> = (0..n).map(|i| forcing(draft, here, i)).collect();
    for (mut row, (term, of_velocities)) in slopes.into_iter().zip(constraints) {
        row.resize(n + constraints.len(), Jet::number(0.0).coefficient(0));
        rows.push(row);
        right.push(negative(bias(draft, here, term, *of_velocities)));
    }
    solution(&rows, &right)
}

/// A row of the constraint Jacobian F.
fn slopes(draft: &Draft, here: &Here, term: &Term, of_velocities: bool) -> Vec<Running> {
    let moved = |i| if of_velocities { here.by_velocity(i) } else { here.by_coordinate(i) };
    (0..draft.count).map(|i| term.value(draft, &moved(i)).coefficient(1)).collect()
}

fn negative(x: Running) -> Running {
    Running { value: -x.value, ..x }
}

/// Derivative of L by all ε in use.
fn lagrangian(draft: &Draft, here: &Here) -> Running {
    let terms = draft.lagrangian.iter().map(|term| term.value(draft, here));
    terms.fold(Jet::number(0.0), |sum, term| sum + term).coefficient(here.order)
}

fn forcing(draft: &Draft, here: &Here, i: usize) -> Running {
    let now = |x: Running| Jet::running(x);
    let (pull, drift) = (here.by_coordinate(i), here.later().by_velocity(i));
    let mut sum = now(lagrangian(draft, &pull)) - now(lagrangian(draft, &drift));
    for (_, force) in draft.forces.iter().filter(|(k, _)| *k == i) {
        sum = sum + force.value(draft, here);
    }
    if let Some(dissipation) = &draft.dissipation {
        sum = sum - now(dissipation.value(draft, &here.by_velocity(i)).coefficient(1));
    }
    sum.coefficient(0)
}

/// Second time derivative of a constraint, or first of a velocity constraint, without the terms of the
/// accelerations.
fn bias(draft: &Draft, here: &Here, term: &Term, of_velocities: bool) -> Running {
    let later = if of_velocities { here.later() } else { here.later().later() };
    term.value(draft, &later).coefficient(later.order)
}

/// Error bound |x − x̃| ≤ |K⁻¹| (δr + δK |x̃| + 3 N |L̂| |Û| |x̃|) u for a solution x̃ by elimination (Higham,
/// *Accuracy and Stability of Numerical Algorithms*, 7.2 and theorem 9.4). δ is the error of an entry; |L̂| |Û|
/// belongs to an elimination from the top down. A first bound, with |x| for
/// |x̃|, is added to |x| in place of |x̃|: a multiplier that is zero is not zero after rounding.
fn solution(matrix: &[Vec<Running>], right: &[Running]) -> Option<Solution> {
    let size = right.len();
    let unit = |i: usize, k: usize| Double::from(f64::from(u8::from(i == k)));
    let rows = (0..size).map(|i| {
        let entries = matrix[i].iter().map(|x| x.value);
        entries.chain([right[i].value]).chain((0..size).map(move |k| unit(i, k))).collect()
    });
    let solved = eliminated(rows.collect())?;
    let values: Vec<Double> = solved.iter().map(|row| row[size]).collect();
    let growth = growth(matrix)?;
    let bounds = |sizes: &[f64]| -> Vec<f64> {
        let error = |i: usize| {
            let of = |j: usize| (matrix[i][j].errors + 3.0 * size as f64 * growth[i][j]) * sizes[j];
            right[i].errors + (0..size).map(of).sum::<f64>()
        };
        let bound = |row: &Vec<Double>| {
            let parts = row[size + 1..].iter().enumerate();
            f64::EPSILON / 2.0 * parts.map(|(i, inverse)| inverse.to_f64().abs() * error(i)).sum::<f64>()
        };
        solved.iter().map(bound).collect()
    };
    let sizes: Vec<f64> = values.iter().map(|x| x.to_f64().abs()).collect();
    let rounded: Vec<f64> = sizes.iter().zip(bounds(&sizes)).map(|(size, bound)| size + bound).collect();
    Some(Solution { bounds: bounds(&rounded), values })
}

/// Reduces [A B] to [I X], X = A⁻¹ B, by Gauss–Jordan elimination with partial pivoting. `None` if A is singular.
fn eliminated(mut rows: Vec<Vec<Double>>) -> Option<Vec<Vec<Double>>> {
    for c in 0..rows.len() {
        let size = |row: &Vec<Double>| row[c].to_f64().abs();
        let pivot = (c..rows.len()).max_by(|&i, &j| size(&rows[i]).total_cmp(&size(&rows[j])))?;
        (size(&rows[pivot]) > 0.0).then_some(())?;
        rows.swap(c, pivot);
        let scale = rows[c][c];
        rows[c].iter_mut().for_each(|x| *x = *x / scale);
        let top = rows[c].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|&(i, _)| i != c) {
            let factor = row[c];
            row.iter_mut().zip(&top).for_each(|(x, &y)| *x = *x - factor * y);
        }
    }
    Some(rows)
}

/// |L| |U| of an LU factorization without pivoting. `None` if a pivot is zero.
fn growth(matrix: &[Vec<Running>]) -> Option<Vec<Vec<f64>>> {
    let mut rows: Vec<Vec<f64>> =
        matrix.iter().map(|row| row.iter().map(|x| x.value.to_f64()).collect()).collect();
    let size = rows.len();
    let mut growth = vec![vec![0.0_f64; size]; size];
    for c in 0..size {
        let top = rows[c].clone();
        (top[c] != 0.0).then_some(())?;
        for i in c..size {
            let factor = rows[i][c] / top[c];
            for j in c..size {
                growth[i][j] += (factor * top[j]).abs();
                if i > c {
                    rows[i][j] -= factor * top[j];
                }
            }
        }
    }
    Some(growth)
}

#[test]
fn the_bound_of_a_linear_system_is_that_of_its_condition() {
    // Rows (1, 1), (1, 1 + d): the inverse is of order 1/d. An error of one round-off in the right side grows by
    // that factor in the solution.
    let jet = |x: f64| Running { errors: 1.0, ..Jet::number(x).coefficient(0) };
    for d in [2.0_f64.powi(-7), 2.0_f64.powi(-14), 2.0_f64.powi(-20)] {
        let matrix = [vec![jet(1.0), jet(1.0)], vec![jet(1.0), jet(1.0 + d)]];
        let Solution { values, bounds } = solution(&matrix, &[jet(2.0), jet(2.0 + d)]).expect("a solution");
        assert!(values.iter().all(|x| x.distance(1.0) < 1e-20), "{values:?}");
        assert!(bounds.iter().all(|bound| (1.0..100.0).contains(&(bound * d / f64::EPSILON))), "{bounds:?}");
    }
}
