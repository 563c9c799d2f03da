//! Rows of F that may be linearly dependent, by their values at random points.
//!
//! A rank is largest at a general point. Rows that are independent at one point, on the constraints or off them, are
//! therefore not combinations of each other, even with functions as coefficients.

use std::collections::BTreeMap;

use crate::mechanics::constraints::Constraints;
use crate::resolve::Problem;
use crate::symbolic::{Approximate, Graph, Id, Sample, Symbol};

/// Number of random points at which the rank is computed, and largest number of draws in the search for points with
/// finite values.
const POINTS: usize = 3;
const DRAWS: u64 = 64;

/// Indices of a minimal set of dependent rows: earlier rows, then the row that depends on them.
pub(super) type Circuit = Vec<usize>;

type Row = BTreeMap<usize, Approximate>;

/// Finds rows of F, taken in this order, that depend on earlier ones. Returns the result of the point, of a few, with
/// the fewest dependent rows.
pub(super) fn find(
    graph: &Graph,
    problem: &Problem,
    constraints: &Constraints,
    order: &[usize],
) -> Vec<Circuit> {
    let entries: Vec<Id> = order.iter().flat_map(|&row| constraints.jacobian[row].iter().copied()).collect();
    let symbols: Vec<Symbol> = graph.symbols(&entries).collect();
    let mut fewest: Option<Vec<Circuit>> = None;
    let mut points = 0;
    for draw in 0..DRAWS {
        let mut sample =
            Sample::new(symbols.iter().copied(), draw, |symbol, draw| problem.drawn(symbol, draw));
        let values = sample.values(graph, &entries);
        if values.iter().any(|value| !value.value.is_finite() || !value.error.is_finite()) {
            continue;
        }
        let circuits = at_point(values.chunks(problem.coordinates.len()), order);
        if fewest.as_ref().is_none_or(|known| circuits.len() < known.len()) {
            fewest = Some(circuits);
        }
        points += 1;
        if points == POINTS || fewest.as_ref().is_some_and(Vec::is_empty) {
            break;
        }
    }
    fewest.unwrap_or_default()
}

/// Eliminates row by row. A unit column per row, after the coordinates, records the combination of original rows.
fn at_point<'a>(rows: impl Iterator<Item = &'a [Approximate]>, order: &[usize]) -> Vec<Circuit> {
    let mut pivots: Vec<(usize, Row)> = Vec::new();
    let mut circuits = Vec::new();
    for (number, values) in rows.enumerate() {
        let width = values.len();
        let entries = values.iter().copied().enumerate().filter(|(_, value)| !value.is_zero());
        let mut row: Row = entries.chain([(width + number, Approximate::exact(1.0))]).collect();
        for (column, pivot) in &pivots {
            if let Some(entry) = row.remove(column) {
                subtract(&mut row, entry.over(pivot[column]), pivot, *column);
            }
        }
        let surely = row.iter().filter(|(_, value)| value.excludes_zero());
        let largest = surely.clone().filter(|&(&column, _)| column < width);
        match largest.max_by(|x, y| x.1.value.abs().total_cmp(&y.1.value.abs())).map(|(&column, _)| column) {
            Some(column) => pivots.push((column, row)),
            None => {
                let parts = surely.filter(|&(&column, _)| column >= width);
                circuits.push(parts.map(|(column, _)| order[column - width]).collect());
            }
        }
    }
    circuits
}

fn subtract(row: &mut Row, factor: Approximate, pivot: &Row, eliminated: usize) {
    for (&column, &value) in pivot.iter().filter(|(column, _)| **column != eliminated) {
        let entry = row.entry(column).or_insert(Approximate::exact(0.0));
        *entry = entry.minus(factor.times(value));
    }
}
