//! Forces, definitions and attributes that a system of any number of bodies may have.

use super::{Affine, Array, Index, OpenConstraint, OpenForce, Range, Slot};
use crate::diagnostics::Place;
use crate::resolve::expression::is_literal_zero;
use crate::resolve::lowering::{Definition, Lowering};
use crate::resolve::scope::Entity;
use crate::resolve::value::{Shape, Value};
use crate::symbolic::Id;
use crate::syntax::{Constraint, Declaration, Force, Law, Name, Target, TargetIndex, numbers};

impl Lowering<'_> {
    /// Forces on elements of coordinates.
    pub(in crate::resolve) fn open_forces(&mut self, declaration: &Declaration) {
        for force in &declaration.forces {
            let name = &force.target.name;
            let Some(Entity::Coordinate(array)) = self.scope.get(&name.text) else {
                self.diagnostics.error(name.place, self.no_coordinate(&name.text));
                continue;
            };
            let found = self.inside_all(&force.target.indices, &mut |lowering, indices| {
                lowering.open_force(array, indices, force)
            });
            self.many.forces.extend(found);
        }
    }

    fn open_force(&mut self, array: usize, indices: &[Affine], force: &Force) -> Option<OpenForce> {
        let (open, lengths) = (self.many.arrays[array].open.clone(), self.many.arrays[array].lengths.clone());
        let (name, place) = (&force.target.name, force.target.name.place);
        if indices.len() < open.len() || indices.len() > open.len() + lengths.len() {
            let text = &name.text;
            return self.report(
                place,
                format!("a force acts on elements of `{text}`: write `#[force({text}[i in 0..n]: …)]`"),
            );
        }
        let (outer, inner) = indices.split_at(open.len());
        for (index, length) in outer.iter().zip(&open) {
            self.demand(&name.text, &Index::Affine(index.clone()), Range::up_to(length), place)?;
        }
        let inner: Option<Vec<usize>> =
            inner.iter().map(|index| index.as_number().and_then(|i| usize::try_from(i).ok())).collect();
        let Some(inner) = inner.filter(|inner| inner.iter().zip(&lengths).all(|(i, length)| i < length))
        else {
            return self.report(place, format!("the components of `{}` are numbered from 0", name.text));
        };
        let value = self.lower(&force.value)?;
        let (before, rest) = lengths.split_at(inner.len());
        let first =
            inner.iter().zip(before).fold(0, |number, (i, length)| number * length + i) * numbers(rest);
        self.check_shape(&value, rest, force)?;
        let at: Vec<Index> = outer.iter().cloned().map(Index::Affine).collect();
        let values = match is_literal_zero(&force.value) {
            true => Vec::new(),
            false => value.flat().into_iter().map(|id| self.within_loops(id)).collect(),
        };
        let slot = |(number, value): (usize, Id)| {
            (self.slot(Slot { array, indices: at.clone(), number: first + number }), value)
        };
        let values = values.into_iter().enumerate().map(slot).collect();
        Some(OpenForce { ranges: self.many.ranges.clone(), values })
    }

    /// Constraints of elements. Each family has the multipliers of its elements.
    pub(in crate::resolve) fn open_constraints(&mut self, declaration: &Declaration) {
        for constraint in &declaration.constraints {
            let target = &constraint.target;
            let found = self.inside_all(&target.indices, &mut |lowering, indices| {
                lowering.open_constraint(constraint, indices)
            });
            self.many.constraints.extend(found);
        }
    }

    fn open_constraint(&mut self, constraint: &Constraint, indices: &[Affine]) -> Option<OpenConstraint> {
        let place = constraint.left.place.to(constraint.right.place);
        let residual = self.residual(constraint)?;
        residual.flat().into_iter().for_each(|row| self.reject_kink("a constraint", row, place));
        let bracket = |index: &Affine| match index.levels().next() {
            Some(level) => self.many.ranges[level].clone(),
            None => Range { from: index.clone(), to: index.plus_number(1) },
        };
        let brackets: Vec<Range> = indices.iter().map(bracket).collect();
        let array = self.multiplier_array(constraint, residual.shape().lengths, &brackets)?;
        let indices: Vec<Index> = indices.iter().cloned().map(Index::Affine).collect();
        let rows = residual.flat().into_iter().enumerate().map(|(number, row)| {
            let row = self.within_loops(row);
            (self.slot(Slot { array, indices: indices.clone(), number }), row)
        });
        Some(OpenConstraint { rows: rows.collect(), ranges: self.many.ranges.clone(), place, brackets })
    }

    /// Array of the multipliers of the constraints of a name, which none of these elements has yet.
    fn multiplier_array(
        &mut self,
        constraint: &Constraint,
        lengths: Vec<usize>,
        brackets: &[Range],
    ) -> Option<usize> {
        let (name, coordinates) = (&constraint.target.name, self.many.arrays.len());
        let Some(array) = self.many.multipliers.iter().position(|known| known.name == name.text) else {
            let open = Vec::new();
            self.many.multipliers.push(Array { name: name.text.clone(), open, lengths, place: name.place });
            return Some(coordinates + self.many.multipliers.len() - 1);
        };
        let is_own = |known: &&OpenConstraint| {
            known.rows.first().is_some_and(|(slot, _)| self.many.slots[*slot].array == coordinates + array)
        };
        let is_apart = |known: &OpenConstraint| {
            known.brackets.len() == brackets.len()
                && known.brackets.iter().zip(brackets).any(|(known, new)| known.is_apart_at_last(new))
        };
        let is_new = self.many.constraints.iter().filter(is_own).all(is_apart);
        if is_new && self.many.multipliers[array].lengths == lengths {
            return Some(coordinates + array);
        }
        self.report(name.place, format!(
            "two constraints are called `{0}`: elements of one name have other indices, as `{0}[0]` and `{0}[i in 1..n]`, and one shape", name.text
        ))
    }

    fn check_shape(&mut self, value: &Value, lengths: &[usize], force: &Force) -> Option<()> {
        if is_literal_zero(&force.value) || value.lengths() == *lengths || value.shape().lengths == *lengths {
            return Some(());
        }
        let wanted = Shape::plain(lengths.to_vec());
        let message =
            format!("the force on `{}` is {wanted}, but this is {}", force.target.name.text, value.shape());
        self.report(force.value.place, message)
    }

    /// Lowers a definition of a family once for its whole range, so that errors in it are reported where they stand.
    pub(in crate::resolve) fn open_definition(&mut self, index: usize, first: usize) {
        let define = &self.defines[index];
        let own = &define.target.name.text;
        let mut names_itself = false;
        define.body.names(&mut |name| names_itself |= name.text == *own);
        let found = match names_itself && !self.many.is_attempt {
            true => self.recursion(index, first),
            false => self.open_family(index, first),
        };
        if found.is_none() {
            self.definitions[first] = Definition::Wrong;
        }
    }

    fn open_family(&mut self, index: usize, first: usize) -> Option<()> {
        let define = &self.defines[index];
        if index != first || !matches!(self.definitions[first], Definition::Pending) {
            let message = "a family whose range is known when the program runs is one definition, unless it is a recursion: write the first and the last terms where they are used";
            return self.report(define.target.name.place, message);
        }
        self.inside_all(&define.target.indices, &mut |lowering, _| lowering.lower(&define.body))?;
        self.definitions[first] = Definition::Open;
        Some(())
    }

    /// Element of a family whose range is known at run time: its body, with these indices.
    pub(in crate::resolve) fn open_family_element(
        &mut self,
        first: usize,
        name: &Name,
        path: &[Affine],
        place: Place,
    ) -> Option<Value> {
        let define = &self.defines[first];
        let mut bound = Vec::new();
        for (index, at) in define.target.indices.iter().zip(path) {
            match index {
                TargetIndex::Family { index, from, to } => {
                    let outer = std::mem::replace(&mut self.locals, bound.clone());
                    let (low, high) = (self.affine(from), self.affine(to));
                    self.locals = outer;
                    let within = Range { from: low?, to: high? };
                    self.demand(&name.text, &Index::Affine(at.clone()), within, place)?;
                    let value = Value::Scalar(at.node(&mut self.graph));
                    bound.push((index.text.clone(), value));
                }
                TargetIndex::Element(element) => {
                    return self.report(
                        element.place,
                        "a family whose range is known when the program runs has running indices alone",
                    );
                }
            }
        }
        let outer = std::mem::replace(&mut self.locals, bound);
        self.calls.push(place);
        let value = self.lower(&define.body);
        self.calls.pop();
        self.locals = outer;
        Some(value?.map(&mut |id| self.graph.defined(id)))
    }

    /// Reports attributes that need a constant number of coordinates.
    pub(in crate::resolve) fn refuse_with_open_lengths(&mut self, declaration: &Declaration) {
        let why = "where the number of coordinates is known when the program runs";
        for frame in &declaration.frames {
            self.diagnostics.error(
                frame.target.name.place,
                format!("{why}, there are no frames yet: write positions as vectors"),
            );
        }
        for function in &declaration.functions {
            self.diagnostics.error(
                function.name.place,
                format!("{why}, there are no supplied functions yet: write the expression"),
            );
        }
        for power in &declaration.powers {
            self.diagnostics.error(
                power.force.place,
                format!("{why}, forces act on coordinates: write `#[force(r[i in 0..n]: …)]`"),
            );
        }
        for constraint in &declaration.constraints {
            let what = match constraint.law {
                Law::Equation if constraint.when.is_none() => continue,
                Law::Equation => "are no constraints with `when`",
                Law::Contact { .. } => "are no contacts",
                Law::Coulomb { .. } | Law::Dry { .. } => "is no friction",
            };
            let advice = "take stiff springs, or a number of coordinates that is an integer literal";
            self.diagnostics
                .error(constraint.target.name.place, format!("{why}, there {what} yet: {advice}"));
        }
        for conserved in declaration.observables.iter().filter(|observable| observable.is_conserved) {
            self.diagnostics.error(
                conserved.target.name.place,
                format!(
                    "{why}, no quantity is proved to be conserved yet: write `#[observable({} = …)]`",
                    conserved.target.name.text
                ),
            );
        }
    }

    /// True if a family is defined over a range that is known at run time.
    pub(in crate::resolve) fn is_open_definition(&self, first: usize) -> bool {
        matches!(self.definitions[first], Definition::Open | Definition::Recursion(_))
    }

    /// Reports an observable that is a family over a range known at run time.
    pub(in crate::resolve) fn refuse_open_observable(
        &mut self,
        Target { name, indices }: &Target,
    ) -> Option<()> {
        if !self.is_open_family(indices) {
            return Some(());
        }
        self.report(name.place, format!(
            "an observable is a number, a vector or a matrix: what there is of each element is computed from the state, and `{}` may be a sum over them", name.text
        ))
    }
}
