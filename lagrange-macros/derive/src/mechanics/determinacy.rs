//! Checks by structural rank that the equations determine every acceleration.
//!
//! The system is solvable only if the stacked matrix [M; F] has full column rank. Its pattern of zeros rules that out
//! if no matching gives every coordinate an equation of its own (structural rank: Duff, Erisman and Reid, *Direct
//! Methods for Sparse Matrices*, chapter 6).

use super::constraints::Constraints;
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::symbolic::Id;

/// Reports every coordinate whose acceleration no equation can determine.
pub(super) fn check(
    problem: &Problem,
    mass: &[Vec<Id>],
    constraints: &Constraints,
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    let held = constraints.jacobian.iter().enumerate().filter(|&(a, _)| constraints.always_holds(a));
    let rows: Vec<&Vec<Id>> = mass.iter().chain(held.map(|(_, row)| row)).collect();
    let mut owner = vec![None; rows.len()];
    let mut sound = true;
    for column in 0..problem.coordinates.len() {
        if !assign(column, &rows, &mut owner, &mut vec![false; rows.len()]) {
            let label = &problem.coordinates[column];
            diagnostics.error(label.place, undetermined(&label.text, column, &rows));
            sound = false;
        }
    }
    sound.then_some(())
}

fn undetermined(name: &str, column: usize, rows: &[&Vec<Id>]) -> String {
    let why = match rows.iter().all(|row| row[column] == Id::ZERO) {
        true => "the Lagrangian is not quadratic in its velocity, and no constraint involves it",
        false => {
            "the equations that involve it are needed for other coordinates (the Lagrangian lacks a kinetic energy for some of them)"
        }
    };
    format!("nothing determines the acceleration of `{name}`: {why}")
}

/// Matches `column` with a row, and reassigns other columns where needed (Kuhn's augmenting paths, with an explicit
/// stack).
fn assign(column: usize, rows: &[&Vec<Id>], owner: &mut [Option<usize>], visited: &mut [bool]) -> bool {
    // Each stack entry: a column without a row, and the next row to try for it.
    let mut path = vec![(column, 0)];
    while let Some((column, row)) = path.last_mut() {
        let candidate = (*row..rows.len()).find(|&r| rows[r][*column] != Id::ZERO && !visited[r]);
        let Some(r) = candidate else {
            path.pop();
            continue;
        };
        *row = r;
        visited[r] = true;
        match owner[r] {
            Some(other) => path.push((other, 0)),
            None => {
                for (column, row) in path {
                    owner[row] = Some(column);
                }
                return true;
            }
        }
    }
    false
}
