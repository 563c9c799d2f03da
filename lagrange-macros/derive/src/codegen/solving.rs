//! Programs that solve the equations of motion, by the fastest form.

use super::count::OPERATION_LIMIT;
use super::eliminate::{self, Solved};
use super::operation::Register;
use super::passes::Program;
use super::schedule::Schedule;
use crate::mechanics::{Form, LinearEquations};
use crate::symbolic::{Graph, Id};

/// Emitted parts of the elimination.
pub(super) struct Solving {
    /// Maps a state to accelerations, multipliers and the pivot.
    pub(super) accelerations: Program,
    /// Maps a state to the numbers of the factorization.
    pub(super) factor: Program,
    /// Maps a factorization and right-hand sides to accelerations, multipliers and the pivot.
    pub(super) solve: Program,
}

/// The program of the form with the shortest estimated time. `None` if all forms are too long.
pub(super) fn cheapest<'e>(graph: &Graph, equations: &'e LinearEquations) -> Option<(&'e Form, Program)> {
    let programs = equations.forms.iter().filter_map(|form| Some((form, solve(graph, form, equations)?)));
    let programs = programs.filter(|(_, program)| program.count().total() <= OPERATION_LIMIT);
    programs.min_by_key(|(_, program)| program.time().total())
}

impl Solving {
    /// Chooses the form with the shortest estimated time. `None` if all forms are too long.
    pub(super) fn cheapest(graph: &Graph, equations: &LinearEquations) -> Option<Self> {
        let (form, accelerations) = cheapest(graph, equations)?;
        let (factor, solve) = factor_and_solve(graph, form, equations)?;
        Some(Self { accelerations: accelerations.fused(), factor: factor.fused(), solve: solve.fused() })
    }
}

/// Solves the equations of motion by one form. Results: accelerations, multipliers and the pivot.
pub(super) fn solve(graph: &Graph, form: &Form, equations: &LinearEquations) -> Option<Program> {
    let right_hand_sides = form.linear.iter().chain(form.alone.iter().flatten()).chain(&equations.bias);
    let mut schedule = Schedule::new(graph, &entries(form, equations, right_hand_sides));
    let solved = eliminate::eliminate(&mut schedule, form, equations)?;
    Some(Program::new(schedule, results(solved)))
}

fn factor_and_solve(graph: &Graph, form: &Form, equations: &LinearEquations) -> Option<(Program, Program)> {
    let mut factoring = Schedule::new(graph, &entries(form, equations, [].iter()));
    let factor = eliminate::factor(&mut factoring, form, equations)?;
    let mut solving = Schedule::default();
    let solved = eliminate::solve_with(&mut solving, &factoring, &factor, equations);
    let numbers = factor.1.into_iter().collect();
    Some((Program::new(factoring, numbers), Program::new(solving, results(solved))))
}

/// Entries of the form and of F, weights of the constraints, and `others`.
fn entries<'a>(
    form: &'a Form,
    equations: &'a LinearEquations,
    others: impl Iterator<Item = &'a Id>,
) -> Vec<Id> {
    let definitions = form.definitions.iter().flatten().map(|(_, entry)| entry);
    let matrices = form.matrix.iter().chain(&equations.jacobian).flatten();
    let weights = form.completing.iter().map(|(_, weight)| weight);
    let rows = form.rows.iter().chain(&form.columns).flatten().flatten();
    let compliance = equations.compliance.iter().chain(equations.coupling.iter().map(|(_, _, entry)| entry));
    matrices.chain(compliance).chain(definitions).chain(rows).chain(weights).chain(others).copied().collect()
}

fn results(Solved { accelerations, multipliers, pivot }: Solved) -> Vec<Register> {
    [accelerations, multipliers, vec![pivot]].concat()
}
