//! Hamilton's equations of one element, to be printed: velocities by momenta, where the momenta of an element are linear in its
//! velocities alone.

use rustc_hash::FxHashMap;

use super::inertia::Inertia;
use super::rows::{self, ElementRows};
use super::{Pattern, Scatter};
use crate::mechanics::hamilton::inverse;
use crate::resolve::Problem;
use crate::resolve::many::{Index, NewIndices, Slot};
use crate::symbolic::{Graph, Id, Symbol};
use crate::variables::Variable;

/// Momenta, H and Hamilton's equations of elements.
pub(crate) struct ManyHamilton {
    /// H by loops.
    pub(crate) energies: Vec<Pattern>,
    /// q̇ of the elements of each array.
    pub(crate) velocities: Vec<Vec<ElementRows>>,
    /// ṗ of the elements of each array.
    pub(crate) rates: Vec<Vec<ElementRows>>,
}

impl ManyHamilton {
    /// `momenta` are the rows of p, and `rates` what adds to ∂L/∂q + Q.
    pub(super) fn of(
        graph: &mut Graph,
        problem: &mut Problem,
        (inertia, momenta): (&[Inertia], &[Option<Vec<ElementRows>>]),
        (energies, rates): (&[Pattern], &[Scatter]),
    ) -> Option<Self> {
        let by_momenta = velocities(graph, problem, inertia, momenta)?;
        let replaced = |graph: &mut Graph, problem: &mut Problem, value: Id| {
            in_momenta(graph, problem, &by_momenta, value)
        };
        let mut of_energy = Vec::new();
        for pattern in energies {
            of_energy.push(Pattern { body: replaced(graph, problem, pattern.body)?, ..pattern.clone() });
        }
        let mut of_rates = Vec::new();
        for Scatter { ranges, values } in rates {
            let values: Option<Vec<(usize, Id)>> =
                values.iter().map(|&(slot, value)| Some((slot, replaced(graph, problem, value)?))).collect();
            of_rates.push(Scatter { ranges: ranges.clone(), values: values? });
        }
        let rates = rows::rows(graph, problem, &of_rates, &[]).into_iter().collect::<Option<Vec<_>>>()?;
        let velocities = momenta.iter().flatten().map(|rows| {
            let element = |rows: &ElementRows| {
                let values = rows
                    .rows
                    .iter()
                    .map(|&(slot, ..)| (slot, Id::ZERO, by_momenta[&problem.many.slots[slot].key()]));
                ElementRows { region: rows.region.clone(), rows: values.collect(), sums: Vec::new() }
            };
            rows.iter().map(element).collect()
        });
        Some(Self { energies: of_energy, velocities: velocities.collect(), rates })
    }
}

/// Velocity of each array and number, in the momenta of an element with running indices of depths 0, 1, ….
fn velocities(
    graph: &mut Graph,
    problem: &mut Problem,
    inertia: &[Inertia],
    momenta: &[Option<Vec<ElementRows>>],
) -> Option<FxHashMap<(usize, usize), Id>> {
    let mut found = FxHashMap::default();
    for block in inertia {
        block.guarded.is_empty().then_some(())?;
        let mut sides = Vec::new();
        for &(array, number) in &block.rows {
            let [rows] = &momenta[array].as_ref()?[..] else { return None };
            rows.sums.is_empty().then_some(())?;
            let (slot, _, momentum) = rows.rows[number];
            let is_velocity = |symbol| matches!(Variable::of(symbol), Variable::Velocity(_));
            let at_rest = graph.substituted(momentum, |symbol| is_velocity(symbol).then_some(Id::ZERO));
            let momentum = graph.symbol(Variable::Momentum(slot).symbol());
            sides.push(graph.sub(momentum, at_rest));
        }
        let mass = &block.equations.forms[0].matrix;
        let inverse = inverse(graph, problem, mass).ok()?;
        for (&key, row) in block.rows.iter().zip(inverse) {
            let parts: Vec<Id> =
                row.iter().zip(&sides).map(|(&entry, &side)| graph.mul(entry, side)).collect();
            found.insert(key, graph.total(parts));
        }
    }
    let are_linear = !crate::variables::has_velocity(graph, &found.values().copied().collect::<Vec<_>>());
    (are_linear && problem.many.arrays.iter().all(|array| array.open.len() <= 1)).then_some(found)
}

/// An expression with its velocities in terms of momenta.
fn in_momenta(
    graph: &mut Graph,
    problem: &mut Problem,
    by_momenta: &FxHashMap<(usize, usize), Id>,
    value: Id,
) -> Option<Id> {
    let symbols: Vec<Symbol> = graph.symbols(&[value]).collect();
    let mut new = FxHashMap::default();
    for symbol in symbols {
        let Variable::Velocity(k) = Variable::of(symbol) else { continue };
        let slot = problem.many.slots[k].clone();
        let mut indices = NewIndices::default();
        for (axis, index) in slot.indices.iter().enumerate() {
            let Index::Affine(index) = index else { return None };
            indices.insert(axis, index.clone());
        }
        let velocity = problem.shifted(graph, by_momenta[&slot.key()], &indices);
        new.insert(symbol, velocity);
    }
    Some(graph.substituted(value, |symbol| new.get(&symbol).copied()))
}

impl Slot {
    /// Array, and number in the element.
    fn key(&self) -> (usize, usize) {
        (self.array, self.number)
    }
}
