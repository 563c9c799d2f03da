//! Elements of arrays whose lengths are known at run time.

use super::{Affine, Demand, FieldElement, Index, Range, Slot};
use crate::diagnostics::Place;
use crate::resolve::lowering::{Lowering, Setting};
use crate::resolve::scope::Entity;
use crate::resolve::value::Value;
use crate::syntax::{Expression, FieldShape, Kind, Name, numbers};
use crate::variables::Variable;

/// Array with a length that is known at run time.
#[derive(Clone, Copy)]
enum Open {
    Array(usize, fn(usize) -> Variable),
    /// Index among the open fields.
    Field(usize),
}

impl Lowering<'_> {
    /// Lowers `r[i]`, `r_dot[i+1][0]` or `m[i]` of an array with a length that is known at run time. Returns an outer `None` for
    /// an array of constant length.
    pub(in crate::resolve) fn open_element(&mut self, expression: &Expression) -> Option<Option<Value>> {
        let (name, indices) = expression.element()?;
        let open = self.open(name)?;
        Some(self.element_of(open, name, &indices))
    }

    /// Lowers the name of an array alone.
    pub(in crate::resolve) fn open_alone(&mut self, name: &Name) -> Option<Option<Value>> {
        let open = self.open(name)?;
        if self.lengths_of(open).is_empty() {
            return Some(self.element_of(open, name, &[]));
        }
        let text = &name.text;
        Some(self.report(name.place, format!(
            "the length of `{text}` is known when the program runs: take an element, `{text}[i]`, in `sum(i in 0..n, …)` or a family"
        )))
    }

    fn open(&self, name: &Name) -> Option<Open> {
        if !self.many.is_open() || self.locals.iter().any(|(local, _)| *local == name.text) {
            return None;
        }
        match self.scope.get(&name.text)? {
            Entity::Coordinate(array) => Some(Open::Array(array, Variable::Coordinate)),
            Entity::Velocity(array) => Some(Open::Array(array, Variable::Velocity)),
            Entity::Acceleration(array) => Some(Open::Array(array, Variable::Acceleration)),
            Entity::Field(field) => {
                self.many.fields.iter().position(|open| open.field == field).map(Open::Field)
            }
            _ => None,
        }
    }

    fn lengths_of(&self, open: Open) -> Vec<Affine> {
        match open {
            Open::Array(array, _) => self.many.arrays[array].open.clone(),
            Open::Field(field) => vec![self.many.fields[field].length.clone()],
        }
    }

    fn element_of(&mut self, open: Open, name: &Name, indices: &[&Expression]) -> Option<Value> {
        if let Open::Array(_, variable) = open
            && matches!(variable(0), Variable::Acceleration(_))
        {
            let what = match self.setting {
                Setting::Observable => {
                    "where lengths are known when the program runs, observables are functions of time, coordinates and velocities"
                }
                Setting::Equations => "accelerations are what the equations are solved for",
            };
            return self.report(name.place, what);
        }
        let lengths = self.lengths_of(open);
        let (outer, inner) = indices.split_at(lengths.len().min(indices.len()));
        if outer.len() < lengths.len() {
            let place = indices.last().map_or(name.place, |index| name.place.to(index.place));
            return self.report(place, format!("`{}` takes {} indices", name.text, lengths.len()));
        }
        let outer: Vec<Option<Index>> = outer.iter().map(|index| self.position(index)).collect();
        let outer = outer.into_iter().collect::<Option<Vec<Index>>>()?;
        for ((index, length), written) in outer.iter().zip(&lengths).zip(indices) {
            self.demand(&name.text, index, Range::up_to(length), written.place)?;
        }
        let mut value = match open {
            Open::Array(array, variable) => self.slots(array, outer, variable),
            Open::Field(field) => self.field_element(field, outer, name)?,
        };
        for index in inner {
            let i = self.integer(index)?;
            let Some(length) = value.length() else { return self.no_elements(name.place, None) };
            let i = self.checked(i, length, index.place)?;
            value = value.item(i)?;
        }
        Some(value)
    }

    /// Variables of one element of a coordinate.
    pub(super) fn slots(
        &mut self,
        array: usize,
        indices: Vec<Index>,
        variable: fn(usize) -> Variable,
    ) -> Value {
        let lengths = self.many.arrays[array].lengths.clone();
        let entries: Vec<_> = (0..numbers(&lengths))
            .map(|number| {
                let k = self.slot(Slot { array, indices: indices.clone(), number });
                self.graph.symbol(variable(k).symbol())
            })
            .collect();
        Value::array(&lengths, &entries)
    }

    /// Index of a slot. A new one changes in time at the rate of its velocity.
    pub(super) fn slot(&mut self, slot: Slot) -> usize {
        let known = self.many.slots.len();
        let found = self.many.slot(slot);
        self.follow_slots(known);
        found
    }

    /// Adds the rates of the slots from this one on to the total time derivative.
    pub(super) fn follow_slots(&mut self, known: usize) {
        for k in known..self.many.slots.len() {
            let rates = [Variable::Coordinate(k), Variable::Velocity(k), Variable::Acceleration(k)];
            let [_, velocity, acceleration] = rates.map(|variable| self.graph.symbol(variable.symbol()));
            self.rate.also([(rates[0].symbol(), velocity), (rates[1].symbol(), acceleration)]);
        }
    }

    /// Value of an element of a field: a virtual field stands for it among the parameters.
    fn field_element(&mut self, field: usize, indices: Vec<Index>, name: &Name) -> Option<Value> {
        let [index] = <[Index; 1]>::try_from(indices).ok()?;
        if self.many.fields[field].is_table {
            return self.report(
                name.place,
                format!(
                    "`{}` holds indices: it may stand in an index, `r[{}[i]]`, but is no number",
                    name.text, name.text
                ),
            );
        }
        let element = FieldElement { field, index };
        let known = self.many.elements.iter().find(|(known, _)| *known == element);
        let place = match known {
            Some((_, place)) => *place,
            None => self.many.virtual_field(&mut self.parameters, element),
        };
        self.parameters.value(place, &[], name.place, &mut self.graph, self.diagnostics)
    }

    /// Lowers an index: a sum of running indices, lengths and whole numbers, or an entry of a table.
    pub(in crate::resolve) fn position(&mut self, index: &Expression) -> Option<Index> {
        if let Some((name, path)) = index.element()
            && let Some(Open::Field(field)) = self.open(name)
            && self.many.fields[field].is_table
        {
            return self.table_entry(field, name, &path);
        }
        self.affine(index).map(Index::Affine)
    }

    fn table_entry(&mut self, field: usize, name: &Name, path: &[&Expression]) -> Option<Index> {
        let Ok(FieldShape { layout, .. }) = self.many.fields[field].element.clone() else { return None };
        let lengths = [vec![self.many.fields[field].length.clone()], known(&layout.lengths)].concat();
        if path.len() != lengths.len() {
            return self
                .report(name.place, format!("an index of `{}` takes {} brackets", name.text, lengths.len()));
        }
        let indices: Vec<Option<Affine>> = path.iter().map(|index| self.affine(index)).collect();
        let indices = indices.into_iter().collect::<Option<Vec<Affine>>>()?;
        for ((index, length), written) in indices.iter().zip(&lengths).zip(path) {
            self.demand(&name.text, &Index::Affine(index.clone()), Range::up_to(length), written.place)?;
        }
        Some(Index::Entry(field, indices))
    }

    /// Lowers a whole number that is known at run time.
    pub(in crate::resolve) fn affine(&mut self, expression: &Expression) -> Option<Affine> {
        let id = self.scalar(expression)?;
        let found = Affine::read(&self.graph, id);
        found.or_else(|| {
            let kind = if matches!(expression.kind, Kind::Index(..)) {
                "an entry of a table of `usize`, or "
            } else {
                ""
            };
            self.report(
                expression.place,
                format!("an index or a bound is {kind}a sum of running indices, lengths and whole numbers"),
            )
        })
    }

    /// Requires an index to be valid in all iterations of the loops whose indices it contains, even if inner loops are empty.
    /// Reports an index that is invalid for all lengths. Others are checked at the start of a motion.
    pub(in crate::resolve) fn demand(
        &mut self,
        name: &str,
        index: &Index,
        within: Range,
        place: Place,
    ) -> Option<()> {
        if let Index::Affine(affine) = index {
            let [least, most] = self.many.bounds(affine);
            let text = |affine: &Affine| affine.text(|unknown| self.many.name(unknown));
            let above = least.plus(&within.from, -1).as_number();
            let below = within.to.plus(&most, -1).as_number();
            if above.is_some_and(|above| above < 0) {
                let (least, first) = (text(&least), text(&within.from));
                let message = format!("this reaches element {least} of `{name}`: elements begin at {first}");
                return self.report(place, message);
            }
            if below.is_some_and(|below| below <= 0) {
                let (most, last) = (text(&most), text(&within.to.plus_number(-1)));
                return self.report(
                    place,
                    format!("this reaches element {most} of `{name}`, and the last is {last}"),
                );
            }
            if above.is_some() && below.is_some() {
                return Some(());
            }
        }
        let depth = index.levels().into_iter().max().map_or(0, |level| level + 1);
        let ranges = self.many.ranges[..depth].to_vec();
        self.many.demands.insert(Demand { name: name.to_owned(), ranges, index: index.clone(), within });
        Some(())
    }
}

fn known(lengths: &[usize]) -> Vec<Affine> {
    lengths.iter().map(|&length| Affine::number(length as i64)).collect()
}
