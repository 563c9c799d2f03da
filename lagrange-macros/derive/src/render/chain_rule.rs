//! Generalized forces as products with partial derivatives of definitions and constraints, where they are shorter.

use super::formula::Formula;
use super::length::{READABLE, length};
use super::lines::LINE;
use super::page::Page;
use super::resultants::component;
use super::roots::{is_taken, taken};
use crate::mechanics::{ChainArgument, ChainRule, ConstraintKind, Resultants};
use crate::resolve::vector;
use crate::symbolic::Id;
use crate::variables::Variable;

/// Longest force, in symbols, that is written in coordinates whatever its length by names: half a line.
const SHORT: usize = LINE / 2;

impl Page<'_> {
    /// Chooses the first chain rule whose forces each fit on a line, or the last, and names its arguments and their rates.
    pub(super) fn choose_chain(&mut self) {
        let Some(resultants) = self.derived.resultants.as_ref().filter(|_| self.bodies.is_some()) else {
            return;
        };
        let is_short = |page: &Self, i: usize| {
            let forces = page.by_arguments(page.chain_of(resultants), i, |argument| argument.force);
            forces.is_some_and(|forces| forces.iter().map(length).sum::<usize>() <= LINE)
        };
        for (k, chain) in resultants.chains.iter().enumerate() {
            self.chain = k;
            self.name_arguments(resultants, chain);
            if (0..self.problem.coordinates.len()).all(|i| is_short(self, i)) {
                return;
            }
        }
    }

    fn name_arguments(&mut self, resultants: &Resultants, ChainRule { arguments, rates, .. }: &ChainRule) {
        let names = self.bodies.as_ref().map(|bodies| &bodies.names.links);
        let links = resultants.links.iter().zip(names.into_iter().flatten());
        let mut named: Vec<(Id, Formula)> = Vec::new();
        for (link, own) in links {
            let components = self.problem.frames[link.frame].angular_velocity.into_iter().enumerate();
            let is_argument =
                |node: &Id| arguments.iter().any(|known| known.is_rate() && known.node == *node);
            let components = components.filter(|(_, node)| is_argument(node));
            named.extend(components.map(|(k, node)| (node, component(Formula::labelled(&own.rate, 0), k))));
            self.vectors.push((Formula::labelled(&own.rate, 0), 3));
        }
        for (rate, of) in rates {
            let known = named.iter().find(|(node, _)| node == of).map(|(_, name)| name.clone());
            let name = known.or_else(|| self.name_of(*of));
            named.extend(name.and_then(Formula::dotted).map(|name| (*rate, name)));
        }
        self.keep_names(named.iter().map(|(node, _)| *node));
        self.entries.extend(named);
    }

    fn chain_of<'r>(&self, resultants: &'r Resultants) -> &'r ChainRule {
        &resultants.chains[self.chain]
    }

    /// Force on a coordinate by L, without bodies and their weights, and by forces of its own.
    pub(super) fn given_force(&self, resultants: &Resultants, i: usize) -> Result<Formula, u64> {
        let both = [resultants.rest[i], self.chain_of(resultants).direct[i]];
        let potential = self.force_by_potential(resultants, i);
        self.by_coordinate_of(resultants, i, both, |argument| argument.force, potential)
    }

    /// What L without bodies adds to a momentum.
    pub(super) fn given_momentum(&self, resultants: &Resultants, i: usize) -> Result<Formula, u64> {
        let both = [resultants.beside.momenta[i], self.chain_of(resultants).momenta[i]];
        let potential = self.slope_of_potential(resultants, Variable::Velocity(i)).map(Formula::negated);
        self.by_coordinate_of(resultants, i, both, |argument| argument.momentum, potential)
    }

    /// A force or momentum as a `whole`, or its `direct` part and what it is by the arguments; in potentials of velocities by the
    /// potential, if neither fits on a line.
    fn by_coordinate_of(
        &self,
        resultants: &Resultants,
        i: usize,
        [whole, direct]: [Id; 2],
        factor: fn(&ChainArgument) -> Id,
        by_potential: Option<Formula>,
    ) -> Result<Formula, u64> {
        let by_arguments = || {
            let terms = self.by_arguments(self.chain_of(resultants), i, factor)?;
            Some([vec![self.expression(direct).ok()?], terms].concat())
        };
        let is_moving = self.has(&[resultants.others], |variable| matches!(variable, Variable::Velocity(_)));
        if !is_moving {
            let known = self.or_shorter(self.expression(whole), SHORT, by_arguments);
            return known.or_else(|size| by_potential.ok_or(size));
        }
        // To expand what is long would leave no work for other formulas.
        let is_long = self.symbols[whole.index()] > READABLE;
        let written = if is_long { Err(self.symbols[whole.index()]) } else { self.expression(whole) };
        let fits = |known: &Result<Formula, u64>| known.as_ref().is_ok_and(|known| length(known) <= LINE);
        let known = self.or_shorter(written, 0, by_arguments);
        let known = if fits(&known) { known } else { self.expression(whole) };
        if fits(&known) { known } else { by_potential.map_or(known, Ok) }
    }

    /// Component of the torque on a quaternion; `None` if L contains its coordinates by themselves.
    pub(super) fn torque_by_arguments(
        &self,
        resultants: &Resultants,
        first: usize,
        by: &Formula,
    ) -> Option<Formula> {
        let ChainRule { direct, arguments, .. } = self.chain_of(resultants);
        (first..first + 4).all(|i| direct[i] == Id::ZERO).then_some(())?;
        let factors: Vec<(Id, Id)> =
            arguments.iter().map(|argument| (argument.rate, argument.force)).collect();
        let velocities: Vec<Variable> = (first..first + 4).map(Variable::Velocity).collect();
        Some(Formula::sum(self.times_partials(&factors, &velocities, by)?))
    }

    /// Factors times the derivatives of arguments by a coordinate, and of angular velocities by its rate.
    fn by_arguments(
        &self,
        chain: &ChainRule,
        i: usize,
        factor: fn(&ChainArgument) -> Id,
    ) -> Option<Vec<Formula>> {
        let (rates, points): (Vec<&ChainArgument>, Vec<&ChainArgument>) =
            chain.arguments.iter().partition(|argument| argument.is_rate());
        let mut terms = Vec::new();
        for (arguments, variable, dots) in
            [(points, Variable::Coordinate(i), 0), (rates, Variable::Velocity(i), 1)]
        {
            let by = Formula::labelled(&self.problem.coordinates[i].text, dots);
            let factors = arguments.iter().map(|argument| (argument.node, factor(argument)));
            terms.extend(self.times_partials(&factors.collect::<Vec<_>>(), &[variable], &by)?);
        }
        Some(terms)
    }

    /// −∂ℓ/∂t of L without bodies and weights.
    pub(super) fn rate_by_arguments(&self, resultants: &Resultants) -> Option<Vec<Formula>> {
        let ChainRule { arguments, by_time, .. } = self.chain_of(resultants);
        let slopes = arguments.iter().map(|argument| (argument.node, argument.slope));
        let momenta = arguments.iter().map(|argument| (argument.rate, argument.momentum));
        let factors: Vec<(Id, Id)> = slopes.chain(momenta).collect();
        let slopes = self.times_partials(&factors, &[Variable::Time], &Formula::labelled("t", 0))?;
        let direct = (*by_time != Id::ZERO).then(|| self.expression(*by_time)).transpose().ok()?;
        Some(direct.into_iter().chain(slopes.into_iter().map(Formula::negated)).collect())
    }

    /// Factors times the partial derivatives of the nodes that depend on these variables: of the components of a vector, one
    /// dot product.
    fn times_partials(
        &self,
        factors: &[(Id, Id)],
        variables: &[Variable],
        by: &Formula,
    ) -> Option<Vec<Formula>> {
        let depends =
            |id: Id| self.graph.symbols(&[id]).any(|symbol| variables.contains(&Variable::of(symbol)));
        let of = |name: Formula| factors.iter().find(|(node, _)| self.name_of(*node).as_ref() == Some(&name));
        let (mut terms, mut done) = (Vec::new(), Vec::new());
        for &(node, factor) in factors.iter().filter(|(node, factor)| *factor != Id::ZERO && depends(*node)) {
            let name = self.name_of(node)?;
            let whole = self.vector_with(&name);
            let factor = whole.as_ref().map_or_else(
                || self.expression(factor),
                |whole| {
                    let own = [0, 1, 2].map(|k| of(component(whole.clone(), k)));
                    self.vector_of_components(&own.map(|own| own.map_or(Id::ZERO, |(_, factor)| *factor)))
                },
            );
            let count = if whole.is_some() { 3 } else { 1 };
            let function = whole.unwrap_or(name);
            if !done.contains(&function) {
                terms.push(times_partial(factor.ok()?, count, function.clone(), by.clone()));
                done.push(function);
            }
        }
        Some(terms)
    }

    /// Name of a definition, or of an argument or a rate that this page names.
    fn name_of(&self, node: Id) -> Option<Formula> {
        let own = self.problem.names.get(&node).map(|name| Formula::labelled(name, 0));
        own.or_else(|| self.entries.get(&node).cloned())
    }

    /// The vector of three that a name is a component of.
    fn vector_with(&self, name: &Formula) -> Option<Formula> {
        let Formula::Name { base, dots, indices } = name else { return None };
        let whole =
            |dots| Formula::Name { base: base.clone(), dots, indices: indices[..indices.len() - 1].to_vec() };
        let is_known = !indices.is_empty() && self.vectors.contains(&(whole(0), 3));
        is_known.then(|| whole(*dots))
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
                let acts = (first..first + group.len()).any(|a| equations.linear.jacobian[a][i] != Id::ZERO);
                let is_whole = group.len() == 3;
                let names = if is_whole { vec![vector(group[0])?] } else { group.to_vec() };
                let dots = usize::from(equations.kinds[first] != ConstraintKind::Holonomic);
                let term = |name: &str| {
                    let by = Formula::labelled(&self.problem.coordinates[i].text, dots);
                    times_partial(
                        Formula::Multiplier(name.to_owned()),
                        if is_whole { 3 } else { 1 },
                        Formula::labelled(name, 0),
                        by,
                    )
                };
                (!names.iter().any(|name| is_taken(&taken, name))).then_some(())?;
                terms.extend(names.into_iter().filter(|_| acts).map(term));
            }
            Some(terms)
        };
        self.or_shorter(self.expression(force), SHORT, by_constraints)
    }

    /// The written force if it has no more than `short` symbols, else that by names if it is shorter.
    fn or_shorter(
        &self,
        written: Result<Formula, u64>,
        short: usize,
        by_names: impl Fn() -> Option<Vec<Formula>>,
    ) -> Result<Formula, u64> {
        if written.as_ref().is_ok_and(|written| length(written) <= short) {
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

/// The term slope·∂(name)/∂(by) of a chain rule, where the named `function` has one component or three.
fn times_partial(slope: Formula, count: usize, function: Formula, by: Formula) -> Formula {
    let function = Box::new(function);
    let partial = Formula::Partial { function, by: vec![by], arguments: Vec::new() };
    let (is_negative, slope) = slope.sign_and_magnitude();
    let term = match count {
        3 => Formula::Call("dot".to_owned(), vec![slope, partial]),
        _ => Formula::Product(vec![slope, partial], Vec::new()),
    };
    term.signed(is_negative)
}
