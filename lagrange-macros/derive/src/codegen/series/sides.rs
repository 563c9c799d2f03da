//! Right-hand sides of the linear system for the Taylor coefficients of accelerations and multipliers.
//!
//! The right-hand sides for order k are the coefficients of order k of dp/dt − ∂L/∂q − Q − Fᵀλ and F q̈ + γ,
//! with zeros in place of the unknown coefficients.
//!
//! Constraints of second degree are expanded directly, two orders ahead. In terms of the mean velocities v̄ since t₀,
//! q = q₀ + (t − t₀) v̄. Taylor's formula then ends after three terms,
//! Φ = Φ₀ + (t − t₀) (F₀ v̄ + ∂Φ/∂t) + (t − t₀)²/2 γ(v̄), with a γ that depends on velocities alone. So d²Φ/dt² has the
//! coefficients F₀ q̈_k + (k + 1) (k + 2)/2 γ(v̄)_k, and v̄ has the coefficients v_k/(k + 1). This takes one sum for
//! each square in Φ; F q̈ + γ takes two.

use super::coefficients::{Recurrences, Stage};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::passes::Program;
use crate::codegen::schedule::Schedule;
use crate::mechanics::{ConstraintKind, Equations, LinearEquations};
use crate::symbolic::{Graph, Id};
use crate::variables::Variable;

impl Recurrences {
    /// Returns the right-hand sides for order k, first those in place of h, then those in place of γ. `None`
    /// if an operation has no Taylor series.
    pub(super) fn right_hand_sides(&mut self, graph: &Graph, equations: &Equations) -> Option<Vec<Register>> {
        let Equations {
            balance, kinds, linear: LinearEquations { bias, .. }, constraint_acceleration, ..
        } = equations;
        let holonomic = |a: usize| kinds[a] == ConstraintKind::Holonomic;
        let are_quadratic: Vec<bool> =
            (0..bias.len()).map(|a| holonomic(a) && is_quadratic(graph, bias[a])).collect();
        let of = |rows: &[Id], is_quadratic: bool| -> Vec<Id> {
            let chosen = rows.iter().zip(&are_quadratic).filter(|&(_, &is)| is == is_quadratic);
            chosen.map(|(&row, _)| row).collect()
        };
        let whole = [balance.clone(), of(constraint_acceleration, false)].concat();
        let mut whole = self.rows(graph, &whole)?.into_iter();
        let forcing: Vec<Register> = whole.by_ref().take(balance.len()).collect();
        let mut ahead = self.ahead(graph, &of(bias, true))?.into_iter();
        let forcing = forcing.into_iter().map(|sum| self.schedule.push(Operation::Negate(sum)));
        let mut sides: Vec<Register> = forcing.collect();
        sides.extend(are_quadratic.iter().filter_map(|&is| if is { ahead.next() } else { whole.next() }));
        Some(sides)
    }

    /// Returns the known part of the coefficient of order k of each row.
    fn rows(&mut self, graph: &Graph, rows: &[Id]) -> Option<Vec<Register>> {
        let Program { schedule, results, .. } = Program::of(graph, rows).without_zeros();
        let rows = self.add_up(&schedule, &results)?;
        Some(rows.into_iter().map(|row| self.newest(row, Stage::Known)).collect())
    }

    /// Returns (k + 1) (k + 2)/2 γ(v̄)_k for constraints of second degree, where v̄ is the mean velocity
    /// since t₀. With `of_means` set, `rows` returns k + 1 times γ(v̄)_k.
    fn ahead(&mut self, graph: &Graph, bias: &[Id]) -> Option<Vec<Register>> {
        self.of_means = true;
        let rows = self.rows(graph, bias)?;
        self.of_means = false;
        let [after_next, half] = [self.order_plus(2.0), self.schedule.constant(0.5)];
        let factor = self.schedule.push(Operation::Multiply(half, after_next));
        Some(rows.into_iter().map(|row| self.schedule.push(Operation::Multiply(factor, row))).collect())
    }

    pub(super) fn order_plus(&mut self, more: f64) -> Register {
        let [order, more] = [Operation::Input(Variable::Order.symbol()), Operation::Constant(more.to_bits())]
            .map(|x| self.schedule.push(x));
        self.schedule.push(Operation::Add(order, more))
    }
}

/// True if γ depends on velocities alone, as a polynomial of degree at most 2. Then Φ is a polynomial of degree at
/// most 2 in coordinates and time.
fn is_quadratic(graph: &Graph, bias: Id) -> bool {
    let schedule = Schedule::new(graph, &[bias]);
    let mut degrees: Vec<Option<u32>> = Vec::with_capacity(schedule.operations.len());
    for operation in &schedule.operations {
        let of = |x: Register| degrees[x.index()];
        let both = |x, y| Some([of(x)?, of(y)?]);
        let degree = match *operation {
            Operation::Input(symbol) => match Variable::of(symbol) {
                Variable::Parameter(_) | Variable::Switch(_) => Some(0),
                Variable::Velocity(_) => Some(1),
                _ => None,
            },
            Operation::Add(x, y) | Operation::Subtract(x, y) => both(x, y).map(|[x, y]| x.max(y)),
            Operation::Multiply(x, y) => both(x, y).map(|[x, y]| x + y),
            Operation::Negate(x) => of(x),
            Operation::Divide(x, y) => of(x).filter(|_| of(y) == Some(0)),
            _ => schedule.operands(*operation).all(|x| of(x) == Some(0)).then_some(0),
        };
        degrees.push(degree);
    }
    degrees[schedule.register(bias).index()].is_some_and(|degree| degree <= 2)
}
