//! Accelerations of chains and trees whose places are defined by recursion, in time proportional to the number of elements.
//!
//! An element has its coordinates q and the numbers c that a recursion carries on, c = f(c₋, q), from those c₋ of its parent. Their
//! accelerations are c̈ = G c̈₋ + J q̈ + γ with G = ∂f/∂c₋ and J = ∂f/∂q. Seen from the parent, the elements behind it pull at c with
//! p − P c̈. From the last element to the first, with the mass matrix M and the forces h of the element,
//!
//! ```text
//! A = P + M_cc,  w = p + h_c − A γ,  D = JᵀAJ + JᵀM_cq + M_qc J + M_qq,  U = (JᵀA + M_qc) G,  g = Jᵀw + h_q − M_qc γ
//! q̈ = D⁻¹ (g − U c̈₋),  P₋ = GᵀAG − UᵀD⁻¹U,  p₋ = Gᵀw − UᵀD⁻¹g
//! ```
//!
//! Then q̈ and c̈ follow from the first to the last. For links this is the articulated-body algorithm (Featherstone, *Rigid Body Dynamics
//! Algorithms*, 7.3). D is the only divisor, so that elements without mass may stand between others.

use super::elimination::{Elimination, Matrix};
use super::{Guarded, Inertia};
use crate::diagnostics::Diagnostics;
use crate::resolve::Problem;
use crate::resolve::many::{Affine, Index, OpenRecursion, Slot, Unknown};
use crate::symbolic::{Graph, Id, Symbol};
use crate::variables::Variable;

/// The recursions of a system. All run along one length, from the same parent.
pub(crate) struct Recursion {
    pub(crate) length: Affine,
    pub(crate) parent: Index,
    /// Array and number of each coordinate of an element.
    pub(crate) coordinates: Vec<(usize, usize)>,
    /// Array and number of each number of an element that a recursion defines.
    pub(crate) carried: Vec<(usize, usize)>,
    /// Entries of M that only some elements have.
    pub(crate) guarded: Vec<Guarded>,
    pub(crate) first: Step,
    pub(crate) next: Step,
    /// k of the `Variable::Term(k)`s that stand for what the elements behind this one add up to: P and GᵀAG by upper triangles, p.
    pub(crate) behind: Vec<usize>,
    /// k of those that stand for the forces on the coordinates, and on what is carried.
    pub(crate) forces: [Vec<usize>; 2],
    /// k of those that stand for the reciprocals of the pivots of D.
    pub(crate) reciprocals: Vec<usize>,
    /// k of those that stand for D⁻¹U by rows, and for D⁻¹g.
    pub(crate) solved: [Vec<usize>; 2],
    /// k of those that stand for c̈₋.
    pub(crate) before: Vec<usize>,
}

/// The recursions at the first element, or at one behind it.
pub(crate) struct Step {
    /// c
    pub(crate) values: Vec<Id>,
    /// ċ
    pub(crate) rates: Vec<Id>,
    /// G = ∂f/∂c₋ and J = ∂f/∂q
    pub(crate) slopes: [Matrix; 2],
    /// Entries of G, J and γ that are not numbers, each with the k of the `Variable::Term(k)` that stands for it.
    pub(crate) kept: Vec<(usize, Id)>,
    /// What it adds to the sums of its parent, in the order of `behind`.
    pub(crate) to_parent: Vec<Id>,
    /// D⁻¹U by rows, and D⁻¹g.
    pub(crate) solved: [Vec<Id>; 2],
    /// For each coordinate its pivot of D, in terms of the reciprocals of those before, and the entry that it is what is left of.
    pub(crate) pivots: Vec<[Id; 2]>,
    /// q̈ and c̈
    pub(crate) accelerations: [Vec<Id>; 2],
}

/// Numbers that a recursion carries, and coordinates that it depends on.
struct Stated {
    length: Affine,
    parent: Index,
    carried: Vec<(usize, usize)>,
    /// At the first element, and at one behind it.
    values: [Vec<Id>; 2],
}

/// Arrays of the recursions and of the coordinates that they depend on. Reports recursions that no elimination along one length covers.
pub(super) fn arrays(graph: &Graph, problem: &Problem, diagnostics: &mut Diagnostics) -> Option<Vec<usize>> {
    let all: Vec<usize> = (problem.many.coordinates().len()..problem.many.arrays.len()).collect();
    let mut arrays = all.clone();
    for recursion in 0..all.len() {
        let OpenRecursion { array, parent, first, next, place, .. } = &problem.many.recursions[recursion];
        let [main, ..] = &problem.many.recursions[..] else { continue };
        let length = &problem.many.arrays[*array].open;
        if *parent != main.parent || *length != problem.many.arrays[main.array].open {
            let message = "two recursions are along one length, each element from the same earlier one: this one is along another";
            diagnostics.error(*place, message);
            return None;
        }
        let ends = [(first, Affine::number(0)), (next, Affine::of(Unknown::Level(0)))];
        for (values, own) in ends {
            for k in slots_in(graph, problem, values) {
                let slot = &problem.many.slots[k];
                let is_own = slot.indices == [Index::Affine(own.clone())]
                    && problem.many.arrays[slot.array].open == *length;
                if !is_own && !problem.many.is_recursion(slot.array) {
                    let label = &problem.many.labels(&problem.parameters)[k].text;
                    let message = format!(
                        "an element of a recursion is defined from an earlier one and from coordinates of its own index, of arrays of its length: this one depends on `{label}`"
                    );
                    diagnostics.error(*place, message);
                    return None;
                }
                arrays.push(slot.array);
            }
        }
    }
    arrays.sort_unstable();
    arrays.dedup();
    Some(arrays)
}

impl Recursion {
    /// Eliminates the recursions; `None` without any, or where a coordinate has no mass, which is reported. `block` is M of the
    /// elements.
    pub(super) fn of(
        graph: &mut Graph,
        problem: &mut Problem,
        block: Inertia,
        diagnostics: &mut Diagnostics,
    ) -> Option<Self> {
        let stated = stated(graph, problem)?;
        let coordinates: Vec<(usize, usize)> =
            block.rows.iter().copied().filter(|row| !stated.carried.contains(row)).collect();
        let place = |row: &(usize, usize)| block.rows.iter().position(|known| known == row);
        let order: Vec<usize> = coordinates.iter().chain(&stated.carried).filter_map(place).collect();
        let matrix = &block.equations.forms[0].matrix;
        let mass: Matrix = order.iter().map(|&i| order.iter().map(|&j| matrix[i][j]).collect()).collect();
        let (q, c) = (coordinates.len(), stated.carried.len());
        let known = block.guarded.iter().flat_map(|guarded| &guarded.values).map(|(term, _)| term + 1).max();
        let mut terms = Terms { next: known.unwrap_or(0) };
        let behind = terms.take(c * (c + 1) + c);
        let reciprocals = terms.take(q);
        let forces = [terms.take(q), terms.take(c)];
        let solved = [terms.take(q * c), terms.take(q)];
        let before = terms.take(c);
        let kept = terms.take(c * c + c * q + c);
        let elimination = Elimination {
            mass,
            behind: &behind,
            reciprocals: &reciprocals,
            forces: &forces,
            solved: &solved,
            before: &before,
            kept: &kept,
        };
        let [first, next] = [0, 1].map(|behind| {
            let own = if behind == 0 { Affine::number(0) } else { Affine::of(Unknown::Level(0)) };
            let slots = |problem: &mut Problem, rows: &[(usize, usize)], index: &Index| -> Vec<usize> {
                let slot =
                    |&(array, number): &(usize, usize)| Slot { array, indices: vec![index.clone()], number };
                rows.iter().map(|row| problem.many.slot(slot(row))).collect()
            };
            let at_own = slots(problem, &coordinates, &Index::Affine(own));
            let at_parent = slots(problem, &stated.carried, &stated.parent);
            let parents = if behind == 0 { Vec::new() } else { at_parent };
            elimination.step(graph, problem, &stated.values[behind], [&parents, &at_own])
        });
        let massless = (0..q).find(|&k| {
            elimination.mass[k].iter().all(|&entry| entry == Id::ZERO)
                && [&first, &next].iter().any(|step| step.slopes[1].iter().all(|row| row[k] == Id::ZERO))
        });
        if let Some(k) = massless {
            let array = &problem.many.arrays[coordinates[k].0];
            diagnostics.error(array.place, format!("nothing determines the acceleration of some elements of `{}`: its velocity does not occur in the Lagrangian, nor in each step of the recursion", array.name));
            return None;
        }
        let Stated { length, parent, carried, .. } = stated;
        Some(Self {
            length,
            parent,
            coordinates,
            carried,
            guarded: block.guarded,
            first,
            next,
            behind,
            reciprocals,
            forces,
            solved,
            before,
        })
    }

    /// Number of `Variable::Term`s in its expressions.
    pub(crate) fn terms(&self) -> usize {
        let kept = self.next.kept.iter().chain(&self.first.kept).map(|(term, _)| *term);
        kept.chain(self.before.iter().copied()).max().map_or(0, |last| last + 1)
    }
}

fn slots_in(graph: &Graph, problem: &Problem, values: &[Id]) -> Vec<usize> {
    let all = problem.many.with_bodies(graph, values);
    let mut slots: Vec<usize> = all.into_iter().flat_map(|id| super::slots(graph, id)).collect();
    slots.sort_unstable();
    slots.dedup();
    slots
}

/// The recursions, each element in terms of the coordinates and of the parent alone.
fn stated(graph: &mut Graph, problem: &mut Problem) -> Option<Stated> {
    let main = problem.many.recursions.first()?;
    let (parent, length) = (main.parent.clone(), problem.many.arrays[main.array].open.first()?.clone());
    let mut carried = Vec::new();
    let mut values = [Vec::new(), Vec::new()];
    let mut own: Vec<(Symbol, Id)> = Vec::new();
    for recursion in 0..problem.many.recursions.len() {
        let OpenRecursion { array, first, next, .. } = &problem.many.recursions[recursion];
        let array = *array;
        let written = [first.clone(), next.clone()];
        let indices = [Affine::number(0), Affine::of(Unknown::Level(0))];
        let count = written[0].len();
        for ((written, index), values) in written.into_iter().zip(indices).zip(&mut values) {
            let known = own.clone();
            for (number, value) in written.into_iter().enumerate() {
                let of = |symbol| known.iter().find(|(known, _)| *known == symbol).map(|(_, value)| *value);
                let value = graph.substituted(value, of);
                let slot =
                    problem.many.slot(Slot { array, indices: vec![Index::Affine(index.clone())], number });
                own.push((Variable::Coordinate(slot).symbol(), value));
                values.push(value);
            }
        }
        carried.extend((0..count).map(|number| (array, number)));
    }
    Some(Stated { length, parent, carried, values })
}

/// Numbers of `Variable::Term`s that are not in use.
struct Terms {
    next: usize,
}

impl Terms {
    fn take(&mut self, count: usize) -> Vec<usize> {
        self.next += count;
        (self.next - count..self.next).collect()
    }
}
