//! Generalized forces of a potential that no other form states in few symbols.
//!
//! With L = T − V, where T and the weights are those of the bodies, V adds d/dt ∂V/∂q̇ − ∂V/∂q to the generalized forces
//! (Goldstein, Poole and Safko, *Classical Mechanics*, 1.58).

use super::formula::Formula;
use super::letters::PageQuantity;
use super::lines::Line;
use super::page::Page;
use super::remark::{Fragment, Remark};
use super::resultants::product;
use crate::mechanics::Resultants;
use crate::symbolic::Id;
use crate::variables::Variable;

impl Page<'_> {
    /// The line V = T + weights − L, with the name that it defines.
    pub(super) fn potential_line(&self) -> Option<(Formula, Line)> {
        let (resultants, bodies) = self.named_bodies()?;
        let mut terms = Vec::new();
        for &named in &bodies {
            let kinetic = [self.moving(resultants, named)?, self.turning_of(resultants, named)];
            terms.extend(kinetic.into_iter().filter_map(|[whole, imposed]| whole.or(imposed)));
        }
        let weights = self.weights(&bodies, resultants.lift, |position, _| Some(position))?;
        let remark = if weights.is_empty() { "potential" } else { "potential without weights" };
        terms.extend(weights.into_iter().map(Formula::negated));
        terms.push(self.letters.name(PageQuantity::Lagrangian).negated());
        let potential = self.potential()?;
        let remark = Remark::of(vec![Fragment::words(remark)]);
        Some((potential.clone(), Line { remark, ..Line::known(potential, Ok(Formula::sum(terms))) }))
    }

    fn potential(&self) -> Option<Formula> {
        let has_potential = self.bodies.as_ref()?.names.has_potential();
        has_potential.then(|| self.letters.name(PageQuantity::PotentialBesideBodies))
    }

    /// ∂V/∂(variable); `None` if it is zero.
    pub(super) fn slope_of_potential(&self, resultants: &Resultants, variable: Variable) -> Option<Formula> {
        let function = Box::new(self.potential()?);
        let depends = self.graph.symbols(&[resultants.others]).any(|symbol| Variable::of(symbol) == variable);
        depends.then(|| Formula::Partial {
            function,
            by: vec![self.variable(variable)],
            arguments: Vec::new(),
        })
    }

    /// Q + d/dt ∂V/∂q̇ − ∂V/∂q of a coordinate.
    pub(super) fn force_by_potential(&self, resultants: &Resultants, i: usize) -> Option<Formula> {
        self.potential()?;
        let slope = |variable| self.slope_of_potential(resultants, variable);
        let momentum =
            slope(Variable::Velocity(i)).map(|momentum| Formula::Call("der".to_owned(), vec![momentum]));
        let force = slope(Variable::Coordinate(i)).map(Formula::negated);
        let given = resultants.chains[0].given[i];
        let given = (given != Id::ZERO).then(|| self.expression(given)).transpose().ok()?;
        Some(Formula::sum([given, momentum, force].into_iter().flatten().collect()))
    }

    /// V − q̇·∂V/∂q̇
    pub(super) fn energy_of_potential(&self, resultants: &Resultants) -> Option<Vec<Formula>> {
        let velocities = (0..self.problem.coordinates.len()).map(Variable::Velocity);
        let parts = velocities.filter_map(|variable| {
            let slope = self.slope_of_potential(resultants, variable)?;
            Some(product(vec![slope, self.variable(variable)]).negated())
        });
        Some([self.potential()?].into_iter().chain(parts).collect())
    }
}
