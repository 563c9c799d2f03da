//! The equations of motion solved: the programs of the form that takes the least time.

use super::count::OPERATION_LIMIT;
use super::eliminate::{self, Solved};
use super::operation::Register;
use super::passes::Program;
use super::schedule::Schedule;
use crate::mechanics::{Equations, Form};
use crate::symbolic::{Graph, Id};

/// Emitted parts of the elimination.
pub(super) struct Solving {
    /// From a state to accelerations, multipliers and the pivot.
    pub(super) accelerations: Program,
    /// From a state to the numbers of the factor.
    pub(super) factor: Program,
    /// From these and any right-hand sides to accelerations, multipliers and the pivot.
    pub(super) solve: Program,
}

impl Solving {
    /// By the form that takes the least time; `None` where every one is long.
    pub(super) fn cheapest(graph: &Graph, equations: &Equations) -> Option<Self> {
        let programs = equations.forms.iter().filter_map(|form| Some((form, solve(graph, form, equations)?)));
        let programs = programs.filter(|(_, program)| program.count().total() <= OPERATION_LIMIT);
        let (form, accelerations) = programs.min_by_key(|(_, program)| program.time().total())?;
        let (factor, solve) = factor_and_solve(graph, form, equations)?;
        Some(Self { accelerations: accelerations.fused(), factor: factor.fused(), solve: solve.fused() })
    }
}

/// The equations of motion solved by one form: accelerations, multipliers and the pivot.
pub(super) fn solve(graph: &Graph, form: &Form, equations: &Equations) -> Option<Program> {
    let right_hand_sides = form.linear.iter().chain(form.alone.iter().flatten()).chain(&equations.bias);
    let mut schedule = Schedule::new(graph, &entries(form, equations, right_hand_sides));
    let solved = eliminate::eliminate(&mut schedule, form, equations)?;
    Some(Program::new(schedule, results(solved)))
}

fn factor_and_solve(graph: &Graph, form: &Form, equations: &Equations) -> Option<(Program, Program)> {
    let mut factoring = Schedule::new(graph, &entries(form, equations, [].iter()));
    let factor = eliminate::factor(&mut factoring, form, equations)?;
    let mut solving = Schedule::default();
    let solved = eliminate::solve_with(&mut solving, &factoring, &factor, equations);
    let numbers = factor.1.into_iter().collect();
    Some((Program::new(factoring, numbers), Program::new(solving, results(solved))))
}

/// The entries of the form and of F, the weights of constraints, and others.
fn entries<'a>(form: &'a Form, equations: &'a Equations, others: impl Iterator<Item = &'a Id>) -> Vec<Id> {
    let definitions = form.definitions.iter().flatten().map(|(_, entry)| entry);
    let matrices = form.matrix.iter().chain(&equations.jacobian).flatten();
    let weights = form.completing.iter().map(|(_, weight)| weight);
    let rows = form.rows.iter().flatten().flatten();
    matrices.chain(definitions).chain(rows).chain(weights).chain(others).copied().collect()
}

fn results(Solved { accelerations, multipliers, pivot }: Solved) -> Vec<Register> {
    [accelerations, multipliers, vec![pivot]].concat()
}
