//! Contacts whose friction does not go with their gap.

use super::constraints::{ConstraintKind, Constraints};
use super::evidence::vanishes;
use crate::diagnostics::Diagnostics;
use crate::resolve::{FrictionRows, Problem};
use crate::symbolic::{Approximate, Graph, Id, Sample, Symbol};
use crate::variables::{Variable, symbols};

/// Random states with a closed gap at which gradients are compared.
const STATES: usize = 6;
/// Random states that are tried; some cannot be moved onto the gap.
const DRAWS: u64 = 24;
/// Coordinates of a contact up to which they are compared in pairs or threes.
const COORDINATES: usize = 14;

/// Reports friction that is along the gap of its contact, or is measured on another scale.
pub(super) fn check(
    graph: &mut Graph,
    problem: &Problem,
    constraints: &Constraints,
    diagnostics: &mut Diagnostics,
) {
    for friction in &problem.frictions {
        let Some(contact) = friction.contact else { continue };
        let rubbing = Rubbing { problem, constraints, gap: problem.contacts[contact].row, friction };
        if let Some((row, message)) = rubbing.fault(graph) {
            diagnostics.error(problem.constraints[row].0.place, message);
        }
    }
}

/// Gradients of a gap and of the velocities of its friction, at a state.
type Gradients = Vec<Vec<Approximate>>;

/// A contact with its friction.
struct Rubbing<'a> {
    problem: &'a Problem,
    constraints: &'a Constraints,
    /// The constraint of the gap.
    gap: usize,
    friction: &'a FrictionRows,
}

impl Rubbing<'_> {
    /// The constraint at fault, and what is wrong with it.
    fn fault(&self, graph: &mut Graph) -> Option<(usize, String)> {
        let contact = &self.problem.constraints[self.gap].0.text;
        if let Some(row) = self.friction.rows().find(|&row| self.is_along_gap(graph, row)) {
            let of = if self.friction.sliding.len() == 1 { "" } else { "a component of " };
            let message = format!(
                "{of}this velocity is along the gap of `{contact}`, where the contact itself acts: friction acts along the surface, as along `x_dot` beside a gap `y >= 0`"
            );
            return Some((row, message));
        }
        if let Some(row) = self.friction.rows().find(|&row| self.is_oblique(graph, row)) {
            let message = format!(
                "a part of this velocity is across the gap of `{contact}`, where friction does not act: write the velocity along the surface, as `(x_dot + s*y_dot)/sqrt(1 + s^2)` beside a gap `(y - f)/sqrt(1 + s^2)` with the slope s of f"
            );
            return Some((row, message));
        }
        let names: Vec<String> = self.misfit(graph)?.iter().map(|&i| self.name(i)).collect();
        let message = format!(
            "the gap of `{contact}` and this velocity are not of one scale: friction would not be its coefficient times the force between the bodies, as their gradients along {} differ in length where the gap is closed; write the gap as a distance, such as `r - sqrt(x^2 + y^2)` for `r^2 - x^2 - y^2`, or `(y - f)/sqrt(1 + s^2)` for `y - f` with the slope s, and the velocity as that of one body past the other",
            names.join(", ")
        );
        Some((self.friction.row, message))
    }

    fn name(&self, coordinate: usize) -> String {
        format!("`{}`", self.problem.coordinates[coordinate].text)
    }

    /// Whether a velocity is a multiple of the rate of the gap everywhere.
    fn is_along_gap(&self, graph: &mut Graph, row: usize) -> bool {
        let [one, other] = [self.gap, row].map(|row| &self.constraints.jacobian[row]);
        // An entry may vanish without being simplified to zero.
        let mut acts = |entry: Id| entry != Id::ZERO && vanishes(graph, self.problem, entry).is_none();
        let Some(pivot) = one.iter().position(|&entry| acts(entry)) else { return false };
        if !other.iter().any(|&entry| acts(entry)) {
            return false;
        }
        one.iter().zip(other).all(|(&first, &second)| {
            let [across, along] = [graph.mul(one[pivot], second), graph.mul(other[pivot], first)];
            let minor = graph.sub(across, along);
            vanishes(graph, self.problem, minor).is_some()
        })
    }

    /// Whether a gap depends on two Cartesian coordinates, those of a body in its plane, and a velocity on these alone, but not along the
    /// surface.
    fn is_oblique(&self, graph: &mut Graph, row: usize) -> bool {
        let [gap, velocity] = [self.gap, row].map(|row| &self.constraints.jacobian[row][..]);
        let (of_gap, of_velocity) = (support(gap), support(velocity));
        if of_gap.len() != 2 || of_velocity.iter().any(|i| !of_gap.contains(i)) {
            return false;
        }
        let along = |of: &Gradients| Approximate::dot(of_gap.iter().map(|&i| (of[0][i], of[1][i])));
        let is_across = self.states(graph, &[gap, velocity]).iter().any(|of| along(of).excludes_zero());
        is_across && self.are_cartesian(graph, &of_gap)
    }

    /// Cartesian coordinates along which gap and velocities have perpendicular gradients at all states with a closed gap, but of different
    /// lengths: these are then the scales of gap and velocities. Two velocities go with a gap in space, or one of them with a gap that depends
    /// on two coordinates alone, as that of a pipe.
    fn misfit(&self, graph: &mut Graph) -> Option<Vec<usize>> {
        let jacobian = &self.constraints.jacobian;
        let gap = &jacobian[self.gap][..];
        let all: Vec<&[Id]> = self.friction.rows().map(|row| &jacobian[row][..]).collect();
        let mut found = self.misfit_with(graph, &[&[gap], &all[..]].concat());
        if all.len() == 2 && support(gap).len() == 2 {
            found = all
                .iter()
                .fold(found, |found, velocity| found.or_else(|| self.misfit_with(graph, &[gap, velocity])));
        }
        found
    }

    /// The same for these gradients, of the gap first.
    fn misfit_with(&self, graph: &mut Graph, gradients: &[&[Id]]) -> Option<Vec<usize>> {
        let (gap, velocities) = gradients.split_first()?;
        let acts = |i: &usize| gap[*i] != Id::ZERO && velocities.iter().any(|of| of[*i] != Id::ZERO);
        let shared: Vec<usize> = (0..self.problem.coordinates.len()).filter(acts).collect();
        if shared.len() < gradients.len() || shared.len() > COORDINATES {
            return None;
        }
        let states = self.states(graph, gradients);
        let subsets = subsets(&shared, gradients.len());
        subsets.into_iter().find(|subset| is_misfit(&states, subset) && self.are_cartesian(graph, subset))
    }

    /// Whether the mass matrix is a multiple of the identity on these coordinates.
    fn are_cartesian(&self, graph: &mut Graph, coordinates: &[usize]) -> bool {
        let velocities: Vec<Symbol> = coordinates.iter().map(|&i| Variable::Velocity(i).symbol()).collect();
        let momenta = graph.gradient(self.problem.lagrangian, &velocities);
        let mass: Vec<Vec<Id>> = momenta.into_iter().map(|p| graph.gradient(p, &velocities)).collect();
        (0..mass.len()).all(|i| {
            (0..mass.len()).all(|k| {
                let expected = if i == k { mass[0][0] } else { Id::ZERO };
                let off = graph.sub(mass[i][k], expected);
                vanishes(graph, self.problem, off).is_some()
            })
        })
    }

    /// Gradients of gap and velocities at random states where the gap is closed and constraints hold.
    fn states(&self, graph: &Graph, gradients: &[&[Id]]) -> Vec<Gradients> {
        let Constraints { kinds, residual, jacobian, .. } = self.constraints;
        let holds = |&a: &usize| {
            a == self.gap || kinds[a] == ConstraintKind::Holonomic && self.constraints.always_holds(a)
        };
        let (residual, slopes): (Vec<Id>, Vec<&[Id]>) =
            (0..kinds.len()).filter(holds).map(|a| (residual[a], &jacobian[a][..])).unzip();
        let coordinates = symbols(self.problem.coordinates.len(), Variable::Coordinate);
        let roots = [&residual[..], &slopes.concat(), &gradients.concat()].concat();
        let all: Vec<Symbol> = graph.symbols(&roots).chain(coordinates.iter().copied()).collect();
        let state = |draw| {
            let mut sample =
                Sample::new(all.iter().copied(), draw, |symbol, draw| match Variable::of(symbol) {
                    Variable::Switch(_) => Approximate::exact(1.0),
                    _ => self.problem.drawn(symbol, draw),
                });
            sample.project(graph, &residual, &slopes, &coordinates)?;
            Some(gradients.iter().map(|gradient| sample.values(graph, gradient)).collect())
        };
        (0..DRAWS).filter_map(state).take(STATES).collect()
    }
}

/// Whether gradients are perpendicular along these coordinates at all states, but of different lengths at one.
fn is_misfit(states: &[Gradients], subset: &[usize]) -> bool {
    let product =
        |of: &Gradients, a: usize, b: usize| Approximate::dot(subset.iter().map(|&i| (of[a][i], of[b][i])));
    let are_perpendicular =
        |of: &Gradients| (1..of.len()).all(|a| (0..a).all(|b| !product(of, a, b).excludes_zero()));
    let differ =
        |of: &Gradients| (1..of.len()).any(|a| product(of, a, a).minus(product(of, 0, 0)).excludes_zero());
    let is_known = |of: &&Gradients| (0..of.len()).all(|a| product(of, a, a).excludes_zero());
    let known: Vec<&Gradients> = states.iter().filter(is_known).collect();
    known.len() > STATES / 2
        && known.iter().all(|of| are_perpendicular(of))
        && known.iter().any(|of| differ(of))
}

/// Coordinates that a row depends on.
fn support(row: &[Id]) -> Vec<usize> {
    (0..row.len()).filter(|&i| row[i] != Id::ZERO).collect()
}

/// All sets of so many of these numbers.
fn subsets(of: &[usize], count: usize) -> Vec<Vec<usize>> {
    match (of, count) {
        (_, 0) => vec![Vec::new()],
        ([], _) => Vec::new(),
        ([first, rest @ ..], _) => {
            let with = subsets(rest, count - 1).into_iter().map(|others| [&[*first], &others[..]].concat());
            with.chain(subsets(rest, count)).collect()
        }
    }
}
