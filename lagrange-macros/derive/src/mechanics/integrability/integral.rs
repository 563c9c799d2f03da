//! Integral of an integrable constraint: the function whose time derivative the constraint sets to zero.

use num_traits::One;

use super::kinds::Integrability;
use super::space::{OneForm, Space};
use crate::resolve::Problem;
use crate::symbolic::{Graph, Id, Rational, Symbol, Verdict};

/// Finds I(q, t) with dI = ω, or dI = μ ω for a simple integrating factor μ, in the graph of the problem; `None` if
/// termwise integration finds none.
pub(super) fn of(
    graph: &mut Graph,
    problem: &Problem,
    space: &mut Space,
    form: &OneForm,
    kind: Integrability,
) -> Option<Id> {
    let candidates = match kind {
        Integrability::Exact => vec![form.clone()],
        Integrability::IntegratingFactor => divided(&mut space.graph, form),
        _ => Vec::new(),
    };
    let integral = candidates.iter().find_map(|form| {
        let integral = potential(&mut space.graph, &space.symbols, form)?;
        is_potential(space, form, integral, problem).then_some(integral)
    })?;
    let copy = graph.copied(&space.graph, &[integral])[0];
    graph.take_fault().is_none().then_some(copy)
}

/// The form divided by each factor of its coefficients, by its square, and by all factors.
fn divided(graph: &mut Graph, form: &OneForm) -> Vec<OneForm> {
    let mut factors: Vec<Id> = form.iter().flat_map(|&entry| graph.factors(entry)).collect();
    factors.sort_unstable();
    factors.dedup();
    let one = Rational::one();
    let mut divisors = factors.clone();
    divisors.extend(factors.iter().map(|&factor| graph.square(factor)));
    divisors.push(graph.product(factors.iter().map(|&factor| (factor, one))));
    divisors
        .into_iter()
        .map(|divisor| form.iter().map(|&entry| graph.div(entry, divisor)).collect())
        .collect()
}

/// Integrates the form along one variable after the other. The gradient of each integral is subtracted from
/// the form before the next.
fn potential(graph: &mut Graph, symbols: &[Symbol], form: &OneForm) -> Option<Id> {
    let mut rest = form.clone();
    let mut integral = Id::ZERO;
    for (k, &symbol) in symbols.iter().enumerate() {
        if rest[k] == Id::ZERO {
            continue;
        }
        let part = graph.antiderivative(rest[k], symbol)?;
        let slopes = graph.gradient(part, symbols);
        for (rest, slope) in rest.iter_mut().zip(slopes) {
            *rest = graph.sub(*rest, slope);
        }
        integral = graph.add(integral, part);
    }
    Some(integral)
}

/// True if the gradient of `integral` is the form.
fn is_potential(space: &mut Space, form: &OneForm, integral: Id, problem: &Problem) -> bool {
    let Space { graph, symbols, .. } = space;
    let gradient = graph.gradient(integral, symbols);
    gradient.into_iter().zip(form).all(|(slope, &entry)| {
        let difference = graph.sub(slope, entry);
        let verdict = graph.is_zero(difference, |symbol, draw| problem.drawn(symbol, draw));
        matches!(verdict, Verdict::Zero | Verdict::Held(_)) && graph.take_fault().is_none()
    })
}
