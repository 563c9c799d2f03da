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
            let chain = resultants.by_definitions.as_ref()?;
            let by = Formula::labelled(&self.problem.coordinates[i].text, 0);
            let direct = self.expression(chain.direct[i]).ok()?;
            Some([vec![direct], self.by_definitions(chain, Variable::Coordinate(i), &by)?].concat())
        };
        self.or_shorter(self.expression(resultants.rest[i]), by_definitions)
    }

    /// ∂U/∂t of U without weights.
    pub(super) fn rate_by_definitions(&self, resultants: &Resultants) -> Option<Vec<Formula>> {
        let chain = resultants.by_definitions.as_ref()?;
        let slopes = self.by_definitions(chain, Variable::Time, &Formula::labelled("t", 0))?;
        let direct = (chain.by_time != Id::ZERO).then(|| self.expression(chain.by_time).ok());
        let direct = direct.into_iter().collect::<Option<Vec<_>>>()?;
        Some(direct.into_iter().chain(slopes.into_iter().map(Formula::negated)).collect())
    }

    /// −∂U/∂d·∂d/∂(variable) of the definitions d.
    fn by_definitions(&self, chain: &ChainRule, variable: Variable, by: &Formula) -> Option<Vec<Formula>> {
        let depends = |id: Id| self.graph.symbols(&[id]).any(|symbol| Variable::of(symbol) == variable);
        let mut terms = Vec::new();
        let mut rest = &chain.slopes[..];
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
                terms.push(times_partial(slope.ok()?, count, name, by.clone()));
            }
        }
        Some(terms)
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
                    let by = Formula::labelled(&self.problem.coordinates[i].text, dots);
                    times_partial(
                        Formula::Multiplier(name.to_owned()),
                        if is_whole { 3 } else { 1 },
                        name,
                        by,
                    )
                };
                (!names.iter().any(|name| is_taken(&taken, name))).then_some(())?;
                terms.extend(names.into_iter().filter(|_| acts).map(term));
            }
            Some(terms)
        };
        self.or_shorter(self.expression(force), by_constraints)
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

/// The term slope·∂(name)/∂(by) of a chain rule, where the definition `name` has one component or three.
fn times_partial(slope: Formula, count: usize, name: &str, by: Formula) -> Formula {
    let function = Box::new(Formula::labelled(name, 0));
    let partial = Formula::Partial { function, by: vec![by], arguments: Vec::new() };
    let (is_negative, slope) = slope.sign_and_magnitude();
    let term = match count {
        3 => Formula::Call("dot".to_owned(), vec![slope, partial]),
        _ => Formula::Product(vec![slope, partial], Vec::new()),
    };
    term.signed(is_negative)
}
