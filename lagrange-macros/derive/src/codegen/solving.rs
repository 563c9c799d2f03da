//! Programs that solve the equations of motion, by the fastest form.

use super::count::OPERATION_LIMIT;
use super::eliminate::{self, Solved};
use super::operation::Register;
use super::passes::Program;
use super::schedule::Schedule;
use crate::mechanics::{Equations, Form, LinearEquations};
use crate::symbolic::{Graph, Id};

/// Emitted parts of the elimination. Those that are `None` are done by loops of the runtime.
pub(super) struct Solving {
    /// Maps a state to accelerations, multipliers and the pivot, while no constraint holds that can be switched off.
    pub(super) accelerations: Option<Program>,
    /// Maps a state to the numbers of the factorization, and these with right-hand sides to accelerations, multipliers and the
    /// pivot. If some constraints can be switched off, it is that of the mass matrix, and h follows its numbers.
    pub(super) factoring: Option<[Program; 2]>,
}

impl Solving {
    pub(super) fn of(graph: &Graph, equations: &Equations) -> Self {
        let factoring = |(form, linear): (&Form, &LinearEquations), more: &[Id]| {
            Some(factor_and_solve(graph, form, linear, more)?.map(Program::fused))
        };
        let (accelerations, factoring) = match &equations.switched {
            None => {
                let found = cheapest(graph, &equations.linear);
                let factoring =
                    found.as_ref().and_then(|&(form, _)| factoring((form, &equations.linear), &[]));
                (found.filter(|_| factoring.is_some()), factoring)
            }
            Some(switched) => {
                let form = cheapest(graph, &switched.inertia).map(|(form, _)| (form, &switched.inertia));
                (cheapest(graph, &switched.free), form.and_then(|form| factoring(form, &equations.forcing)))
            }
        };
        Self { accelerations: accelerations.map(|(_, program)| program.fused()), factoring }
    }
}

/// The form with the shortest estimated time, with its program. `None` if all are too long.
fn cheapest<'e>(graph: &Graph, equations: &'e LinearEquations) -> Option<(&'e Form, Program)> {
    let programs = equations.forms.iter().filter_map(|form| Some((form, solve(graph, form, equations)?)));
    let programs = programs.filter(|(_, program)| program.count().total() <= OPERATION_LIMIT);
    programs.min_by_key(|(_, program)| program.time().total())
}

/// Solves the equations of motion by one form. Results: accelerations, multipliers and the pivot.
pub(super) fn solve(graph: &Graph, form: &Form, equations: &LinearEquations) -> Option<Program> {
    let right_hand_sides = form.linear.iter().chain(form.alone.iter().flatten()).chain(&equations.bias);
    let given = equations.given.iter().flatten();
    let mut schedule = Schedule::new(graph, &entries(form, equations, right_hand_sides.chain(given)));
    let mut solved = eliminate::eliminate(&mut schedule, form, equations)?;
    if !equations.given.is_empty() {
        let mut found = solved.multipliers.into_iter();
        let all = equations
            .given
            .iter()
            .map(|given| given.map_or_else(|| found.next(), |id| Some(schedule.register(id))));
        solved.multipliers = all.collect::<Option<_>>()?;
    }
    Some(Program::new(schedule, results(solved)))
}

/// Programs that factorize the equations of motion by one form, and compute `more`, and that solve with the factorization.
fn factor_and_solve(
    graph: &Graph,
    form: &Form,
    equations: &LinearEquations,
    more: &[Id],
) -> Option<[Program; 2]> {
    let mut factoring = Schedule::new(graph, &entries(form, equations, more.iter()));
    let factor = eliminate::factor(&mut factoring, form, equations)?;
    let mut solving = Schedule::default();
    let solved = eliminate::solve_with(&mut solving, &factoring, &factor, equations);
    let more: Vec<Register> = more.iter().map(|&id| factoring.register(id)).collect();
    let numbers = factor.1.into_iter().chain(more).collect();
    Some([Program::new(factoring, numbers), Program::new(solving, results(solved))])
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
    let rows = form.rows.iter().flatten().flatten();
    matrices.chain(definitions).chain(rows).chain(weights).chain(others).copied().collect()
}

fn results(Solved { accelerations, multipliers, pivot }: Solved) -> Vec<Register> {
    [accelerations, multipliers, vec![pivot]].concat()
}
