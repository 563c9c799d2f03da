//! The potential V of a page by bodies, whose partial derivatives are taken by differences.

use super::checks::check_line;
use super::links::{Curve, FIRST, STEP, named};
use super::{Page, Value, value};
use crate::render::formula::Formula;
use crate::render::letters::PageQuantity;
use crate::symbolic::{Approximate, Id, Sample};
use crate::variables::Variable;

/// −V as a node.
fn negative(system: &Page) -> Id {
    system.derived.resultants.as_ref().expect("bodies").others
}

pub(super) fn is_it(system: &Page, function: &str) -> bool {
    name(system).is_some_and(|name| system.written(&name) == function)
}

/// Name of the potential, if a page has it.
pub(super) fn name(system: &Page) -> Option<Formula> {
    let name = system.letters.name(PageQuantity::PotentialBesideBodies);
    let start = format!("{} = ", system.written(&name));
    let has_line = system.lines("Lagrangian\n").iter().any(|line| line.starts_with(&start));
    (named(system)?.0.has_potential() && has_line).then_some(name)
}

/// f′(0), by differences.
fn derivative(f: impl Fn(f64) -> f64) -> f64 {
    (0..4).map(|k| FIRST[k] * (f(STEP * (k + 1) as f64) - f(-STEP * (k + 1) as f64)) / STEP).sum()
}

/// ∂V/∂(variable)
pub(super) fn slope(system: &Page, sample: &Sample, variable: Variable) -> f64 {
    derivative(|more| {
        let mut sample = sample.clone();
        sample.set([(variable.symbol(), Approximate::exact(value(&sample, variable) + more))]);
        -sample.values(&system.graph, &[negative(system)])[0].value
    })
}

/// d/dt (∂V/∂q̇)
pub(super) fn rate_of_momentum(system: &Page, sample: &Sample, function: &str, by: &str) -> Option<Value> {
    let n = system.problem.coordinates.len();
    let written = |i: usize| system.written(&Formula::labelled(&system.problem.coordinates[i].text, 1));
    let i = (0..n).find(|&i| written(i) == by).filter(|_| is_it(system, function))?;
    let curve = Curve::of(system, sample, None);
    let momentum = |time: f64| slope(system, &curve.moved(sample, time), Variable::Velocity(i));
    Some(vec![derivative(momentum)])
}

/// Checks the line of V.
pub(super) fn check(system: &Page) {
    let Some(name) = name(system) else { return };
    let start = system.written(&name) + " = ";
    let lines = system.lines("Lagrangian\n");
    let line = lines.iter().find(|line| line.starts_with(&start)).expect("a line");
    check_line(system, line, |sample| vec![-sample.values(&system.graph, &[negative(system)])[0].value]);
}
