//! Definitions by recursion along a length that is known at run time, such as positions of links: `x[i] = x[i-1] + l*sin(q[i])`.
//!
//! Multiplied out, the last element would contain all coordinates. A recursion is kept instead: its elements are further coordinates,
//! which a constraint between neighbours determines.

use super::{Affine, Array, Index, OpenConstraint, Range, Slot, Unknown};
use crate::diagnostics::Place;
use crate::resolve::lowering::{Definition, Lowering};
use crate::resolve::value::Value;
use crate::symbolic::Id;
use crate::syntax::TargetIndex;
use crate::variables::{Variable, has_velocity};

/// A family whose elements are defined from earlier ones.
pub(crate) struct OpenRecursion {
    /// Array of the elements, behind those of the coordinates.
    pub(crate) array: usize,
    /// Index of the element from which the element i is defined.
    pub(crate) parent: Index,
    /// Numbers of the element 0.
    pub(crate) first: Vec<Id>,
    /// Numbers of the element i, which has depth 0.
    pub(crate) next: Vec<Id>,
    /// Indices of the family: from 1 to the length.
    pub(crate) range: Range,
    pub(crate) place: Place,
}

impl Lowering<'_> {
    /// Lowers a family that names itself in its body.
    pub(super) fn recursion(&mut self, index: usize, first: usize) -> Option<()> {
        let define = &self.defines[index];
        let (name, place) = (&define.target.name, define.target.name.place);
        let value = self.value_of_first(first, index)?;
        let [TargetIndex::Family { index: running, from, to }] = &define.target.indices[..] else {
            return self.report(place, format!("a recursion along a length that is known when the program runs has one index: `{}[i in 1..n]`", name.text));
        };
        let (low, length) = (self.affine(from)?, self.affine(to)?);
        if low != Affine::number(1) {
            return self.report(
                from.place,
                format!("`{}[0]` is defined before: the family goes on from 1", name.text),
            );
        }
        let lengths = value.shape().lengths;
        let array = self.many.arrays.len();
        self.many.arrays.push(Array { name: name.text.clone(), open: vec![length.clone()], lengths, place });
        self.definitions[first] = Definition::Recursion(array);
        let range = Range { from: low, to: length };
        self.declare_local(running)?;
        let (next, parent) =
            self.inside(range.clone(), running, |lowering| lowering.next_element(index, array, &value))?;
        let first = value.flat();
        self.refuse_velocities(&[&first[..], &next].concat(), define.body.place)?;
        self.many.recursions.push(OpenRecursion { array, parent, first, next, range, place });
        Some(())
    }

    /// Numbers of the element of the current loop, of the shape of the element 0, and the index of the element before it.
    fn next_element(&mut self, index: usize, array: usize, first: &Value) -> Option<(Vec<Id>, Index)> {
        let define = &self.defines[index];
        let value = self.lower(&define.body)?;
        if value.shape().lengths != first.shape().lengths {
            let (name, shape, expected) = (&define.target.name.text, value.shape(), first.shape());
            return self.report(define.body.place, format!("`{name}[0]` is {expected}, but this is {shape}"));
        }
        let next: Vec<Id> = value.flat().into_iter().map(|id| self.within_loops(id)).collect();
        let parent = self.parent(array, &next, define.body.place)?;
        Some((next, parent))
    }

    /// Value of the element 0, the only one that a recursion begins with.
    fn value_of_first(&mut self, first: usize, index: usize) -> Option<Value> {
        let value = match &self.definitions[first] {
            Definition::Family(family) if family.iter().map(|(indices, _)| indices).eq([&[0][..]]) => {
                family.part(&[0])
            }
            _ => None,
        };
        let name = &self.defines[index].target.name;
        value.or_else(|| {
            self.report(name.place, format!(
                "a recursion along a length that is known when the program runs begins with one element, `#[define({0}[0] = …)]`, and goes on with `#[define({0}[i in 1..n] = …)]`", name.text
            ))
        })
    }

    /// Index of the element from which that of the current loop is defined. It must come before it.
    fn parent(&mut self, array: usize, next: &[Id], place: Place) -> Option<Index> {
        let name = self.many.arrays[array].name.clone();
        let all = self.many.with_bodies(&self.graph, next);
        let mut parents: Vec<Index> = Vec::new();
        for symbol in self.graph.symbols(&all) {
            if let Variable::Coordinate(k) | Variable::Velocity(k) = Variable::of(symbol)
                && self.many.slots[k].array == array
                && !parents.contains(&self.many.slots[k].indices[0])
            {
                parents.push(self.many.slots[k].indices[0].clone());
            }
        }
        let [parent] = &parents[..] else {
            let message = match parents.is_empty() {
                true => format!("`{name}` cancels here: then it is no recursion"),
                false => format!(
                    "each element of `{name}` may be defined from one earlier element: here are {}",
                    parents.len()
                ),
            };
            return self.report(place, message);
        };
        let own = Affine::of(Unknown::Level(0));
        match parent {
            Index::Affine(index) if own.plus(index, -1).as_number().is_some_and(|steps| steps > 0) => {}
            Index::Affine(_) => {
                return self.report(place, format!("each element of `{name}` is defined from an earlier one: `{name}[i-1]`, or `{name}[parent[i]]` with a table"));
            }
            Index::Entry(..) => {
                let within = Range { from: Affine::number(0), to: own };
                self.demand(&name, parent, within, place)?;
            }
        }
        Some(parent.clone())
    }

    fn refuse_velocities(&mut self, values: &[Id], place: Place) -> Option<()> {
        let all = self.many.with_bodies(&self.graph, values);
        if has_velocity(&self.graph, &all) {
            return self.report(place, "where lengths are known when the program runs, a recursion is one of positions, without velocities: `der(x[i])` is the velocity of `x[i]`");
        }
        Some(())
    }

    /// Element of a recursion.
    pub(in crate::resolve) fn recursion_element(
        &mut self,
        array: usize,
        index: Index,
        place: Place,
    ) -> Option<Value> {
        let Array { name, open, .. } = &self.many.arrays[array];
        let (name, within) = (name.clone(), Range::up_to(&open[0]));
        self.demand(&name, &index, within, place)?;
        Some(self.slots(array, vec![index], Variable::Coordinate))
    }

    /// Constraints that state the recursions, each with multipliers of its own. All arrays of coordinates are known.
    pub(in crate::resolve) fn constraints_of_recursions(&mut self) -> Vec<[OpenConstraint; 2]> {
        (0..self.many.recursions.len()).map(|recursion| self.constraints_of(recursion)).collect()
    }

    fn constraints_of(&mut self, recursion: usize) -> [OpenConstraint; 2] {
        let OpenRecursion { array, first, next, range, place, .. } = &self.many.recursions[recursion];
        let (array, range, place) = (*array, range.clone(), *place);
        let [first, next] = [first.clone(), next.clone()];
        let Array { name, lengths, .. } = &self.many.arrays[array];
        let (name, lengths) = (name.clone(), lengths.clone());
        let multipliers = self.many.arrays.len() + self.many.multipliers.len();
        self.many.multipliers.push(Array { name, open: Vec::new(), lengths, place });
        let mut rows = |index: Affine, values: Vec<Id>| {
            let row = |(number, value): (usize, Id)| {
                let [own, multiplier] = [array, multipliers].map(|array| {
                    self.slot(Slot { array, indices: vec![Index::Affine(index.clone())], number })
                });
                let own = self.graph.symbol(Variable::Coordinate(own).symbol());
                (multiplier, self.graph.sub(own, value))
            };
            values.into_iter().enumerate().map(row).collect()
        };
        let rows = [rows(Affine::number(0), first), rows(Affine::of(Unknown::Level(0)), next)];
        let mut ranges = [vec![], vec![range]].into_iter();
        rows.map(|rows| OpenConstraint {
            ranges: ranges.next().unwrap_or_default(),
            place,
            brackets: Vec::new(),
            rows,
        })
    }
}

impl super::Many {
    /// Arrays of the coordinates, without those of recursions.
    pub(crate) fn coordinates(&self) -> &[Array] {
        &self.arrays[..self.arrays.len() - self.recursions.len()]
    }

    /// True if the numbers of this array are defined by a recursion.
    pub(crate) fn is_recursion(&self, array: usize) -> bool {
        (self.coordinates().len()..self.arrays.len()).contains(&array)
    }
}
