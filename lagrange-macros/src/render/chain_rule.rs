//! Generalized forces as products with partial derivatives of definitions and constraints, where they are shorter.

use super::formula::Formula;
use super::length::length;
use super::lines::LINE;
use super::motion::vector;
use super::page::Page;
use super::roots::{is_taken, taken};
use crate::mechanics::{ChainRule, ConstraintKind, Resultants};
use crate::symbolic::Id;
use crate::variables::Variable;

/// Longest force, in symbols, that is written in coordinates whatever its length by names: half a line.
const SHORT: usize = LINE / 2;

impl Page<'_> {
    /// Force on a coordinate by L, without bodies and their weights, and by forces of its own.
    pub(super) fn given_force(&self, resultants: &Resultants, i: usize) -> Result<Formula, u64> {
        let by_definitions = || {
            let ChainRule { direct, slopes } = resultants.by_definitions.as_ref()?;
            let mut terms = vec![self.expression(direct[i]).ok()?];
            let depends = |id: Id| {
                self.graph.symbols(&[id]).any(|symbol| Variable::of(symbol) == Variable::Coordinate(i))
            };
            let mut rest = &slopes[..];
            while let [(id, slope), ..] = rest {
                let count = self.components_from(rest);
                let (components, others) = rest.split_at(count);
                rest = others;
                if components.iter().any(|(id, _)| depends(*id)) {
                    let slope = match components {
                        [_, _, _] => self.vector_of_components(&[0, 1, 2].map(|k| components[k].1)),
                        _ => self.expression(*slope),
                    };
                    let name = self.problem.names.get(id)?;
                    let name = if count == 3 { vector(name)? } else { name };
                    terms.push(self.times_partial(slope.ok()?, count, name, (i, 0)));
                }
            }
            Some(terms)
        };
        self.or_shorter(self.expression(resultants.rest[i]), by_definitions)
    }

    /// 3 if a vector of three definitions begins here, else 1.
    fn components_from(&self, slopes: &[(Id, Id)]) -> usize {
        let text = |k: usize| slopes.get(k).and_then(|(id, _)| self.problem.names.get(id));
        let whole = text(0).and_then(|text| vector(text));
        let is_vector = whole.is_some_and(|whole| {
            let is_known =
                self.vectors.iter().any(|(name, n)| *n == 3 && *name == Formula::labelled(whole, 0));
            is_known && (0..3).all(|k| text(k).is_some_and(|text| *text == format!("{whole}[{k}]")))
        });
        if is_vector { 3 } else { 1 }
    }

    /// Constraint force on a coordinate: Σ λ ∂Φ/∂q, or Σ λ ∂Φ/∂q̇ if velocities are constrained.
    pub(super) fn constraint_force(&self, i: usize) -> Result<Formula, u64> {
        let equations = &self.derived.equations;
        let Some(&force) = equations.printed_force.get(i) else { return Ok(Formula::sum(Vec::new())) };
        let by_constraints = || {
            let taken = taken(self.problem);
            let labels: Vec<&str> = self.problem.constraints.iter().map(|(label, _)| &*label.text).collect();
            let mut terms = Vec::new();
            for group in labels.chunk_by(|one, other| vector(one).is_some() && vector(one) == vector(other)) {
                let first = labels.iter().position(|label| label == &group[0])?;
                let acts = (first..first + group.len()).any(|a| equations.jacobian[a][i] != Id::ZERO);
                let is_whole = group.len() == 3;
                let names = if is_whole { vec![vector(group[0])?] } else { group.to_vec() };
                let dots = usize::from(equations.kinds[first] != ConstraintKind::Holonomic);
                let term = |name: &str| {
                    self.times_partial(
                        Formula::Multiplier(name.to_owned()),
                        if is_whole { 3 } else { 1 },
                        name,
                        (i, dots),
                    )
                };
                (!names.iter().any(|name| is_taken(&taken, name))).then_some(())?;
                terms.extend(names.into_iter().filter(|_| acts).map(term));
            }
            Some(terms)
        };
        self.or_shorter(self.expression(force), by_constraints)
    }

    /// slope·∂(name)/∂q, or by the velocity.
    fn times_partial(&self, slope: Formula, count: usize, name: &str, (i, dots): (usize, usize)) -> Formula {
        let by = vec![Formula::labelled(&self.problem.coordinates[i].text, dots)];
        let function = Box::new(Formula::labelled(name, 0));
        let partial = Formula::Partial { function, by, arguments: Vec::new() };
        let (is_negative, slope) = slope.sign_and_magnitude();
        let term = match count {
            3 => Formula::Call("dot".to_owned(), vec![slope, partial]),
            _ => Formula::Product(vec![slope, partial], Vec::new()),
        };
        term.signed(is_negative)
    }

    /// The written force if it is short, else that by names if it is shorter.
    fn or_shorter(
        &self,
        written: Result<Formula, u64>,
        by_names: impl Fn() -> Option<Vec<Formula>>,
    ) -> Result<Formula, u64> {
        if written.as_ref().is_ok_and(|written| length(written) <= SHORT) {
            return written;
        }
        let zero = Formula::sum(Vec::new());
        let by_names =
            by_names().map(|terms| Formula::sum(terms.into_iter().filter(|term| *term != zero).collect()));
        match (written, by_names) {
            (Ok(written), Some(by_names)) if length(&written) <= length(&by_names) => Ok(written),
            (written, by_names) => by_names.map_or(written, Ok),
        }
    }
}
