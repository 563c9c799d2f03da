//! Parameters: the entries of fields that expressions use.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use indexmap::{IndexMap, IndexSet};
use quote::ToTokens;

use super::unknown::{nearest, or_meant};
use super::value::Value;
use crate::diagnostics::{Diagnostics, Place};
use crate::symbolic::{Graph, Id, Symbol};
use crate::syntax::{
    Declaration, Expression, Fact, Field, FieldShape, Kind, Layout, Lengths, Name, Operator, Parameter,
    Property, element_type, numbers,
};
use crate::variables::Variable;

/// Type of the field that says whether a contact is open or closed.
pub(super) const CONTACT: &str = "Contact";

/// Type of the field that says whether dry friction sticks or slides.
pub(super) const FRICTION: &str = "Friction";

/// Maximum number of parameters. Each one has a name and a place in the generated code.
const NUMBER_LIMIT: usize = 10_000;

/// An entry of a field: index of the field, and index of the entry in row-major order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(crate) struct Entry {
    pub(crate) field: usize,
    pub(crate) number: usize,
}

/// A number that the state of a constraint, kept in an entry of a field, stands for.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Switch {
    pub(crate) entry: Entry,
    pub(crate) reading: SwitchReading,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum SwitchReading {
    /// 1 while the constraint holds, else 0.
    Holds,
    /// 1 while friction keeps this component of the velocity at zero, else 0.
    Sticks(usize),
    /// 1 while friction slides, else 0.
    Slides,
    /// Component of the direction in which friction slides, or of the part of its sliding force that is stated, else 0.
    Slip(usize),
    /// This component times a speed so small that it is lost beside any other.
    Start(usize),
}

/// Fields as expressions see them, members of structs included.
pub(crate) struct Parameters {
    pub(crate) fields: Vec<Field>,
    /// Entries of fields that expressions use; `Variable::Parameter(k)` is entry k.
    pub(crate) entries: IndexSet<Entry>,
    /// Entries of fields that switch constraints; `Variable::Switch(k)` is switch k.
    pub(crate) switches: IndexSet<Switch>,
    /// Interval of each field from which random test values are drawn.
    pub(crate) ranges: Vec<(f64, f64)>,
    /// Matrix property of each field, as given by a `parameter` attribute.
    pub(super) properties: Vec<Option<Property>>,
    /// Fields with a reported error.
    reported: Vec<usize>,
    /// Fields of contacts and friction: where each is used first, and the largest indices in use.
    states: IndexMap<usize, (Place, Vec<usize>)>,
}

impl Parameters {
    /// Indices of the entries, sorted by the order of the fields instead of first use.
    pub(crate) fn by_field(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.entries.len()).collect();
        order.sort_by_cached_key(|&k| self.rank(self.entries[k]));
        order
    }

    pub(super) fn new(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Self {
        let fields = declaration.fields.clone();
        let ranges = vec![(0.5, 1.5); fields.len()];
        let properties = vec![None; fields.len()];
        let (entries, switches) = (IndexSet::new(), IndexSet::new());
        let (reported, states) = (Vec::new(), IndexMap::new());
        let mut parameters = Self { fields, entries, switches, ranges, properties, reported, states };
        parameters.add_known_structures();
        let is_struct = |(_, parameter): &(usize, &Parameter)| matches!(parameter.fact, Fact::Struct(_));
        let said = || declaration.parameters.iter().enumerate();
        // The members of a struct must be known before a range applies to all of them.
        let (structs, others) = (said().filter(is_struct), said().filter(|said| !is_struct(said)));
        for (position, parameter) in structs.chain(others) {
            let name = &parameter.name;
            let Some(index) = declaration.fields.iter().position(|field| field.name.text == name.text) else {
                let fields = || declaration.fields.iter().map(|field| field.name.text.as_str());
                let advice = or_meant(&name.text, nearest(&name.text, fields()), "field", fields());
                diagnostics.error(name.place, format!("there is no field `{}`{advice}", name.text));
                continue;
            };
            let earlier = &declaration.parameters[..position];
            let result = reject_repeated(parameter, earlier).and_then(|()| parameters.set(index, parameter));
            diagnostics.note(result);
        }
        parameters
    }

    fn set(&mut self, index: usize, Parameter { name, fact }: &Parameter) -> syn::Result<()> {
        match fact {
            Fact::Struct(structure) => self.set_structure(index, structure, name.place),
            Fact::Shape(lengths) if !lengths.open.is_empty() => self.check_open(index, name.place),
            Fact::Shape(Lengths { known, .. }) => {
                self.reject_struct(index, name.place)?;
                self.set_shape(index, known, name.place)
            }
            Fact::Property(property) => {
                self.reject_struct(index, name.place)?;
                self.set_property(index, *property, name.place)
            }
            Fact::Range(low, high) => {
                let range = bounds(low, high)?;
                let members: Vec<usize> = self.members_of(index).collect();
                members.into_iter().chain([index]).for_each(|k| self.ranges[k] = range);
                Ok(())
            }
        }
    }

    /// Checks that a field whose length has a name is a `Vec` or a slice.
    fn check_open(&self, index: usize, place: Place) -> syn::Result<()> {
        let Field { name, ty, .. } = &self.fields[index];
        match element_type(ty) {
            Some(_) => Ok(()),
            None => Err(place.error(format!(
                "a length that is known when the program runs belongs to a `Vec` or a slice, and the type of `{}` is `{}`",
                name.text,
                text(ty)
            ))),
        }
    }

    /// Adds a field that stands for an element of another one; returns its index.
    pub(super) fn add_virtual(&mut self, field: Field, of: usize) -> usize {
        self.fields.push(field);
        self.ranges.push(self.ranges[of]);
        self.properties.push(None);
        self.fields.len() - 1
    }

    fn set_shape(&mut self, index: usize, lengths: &[usize], place: Place) -> syn::Result<()> {
        let field = &mut self.fields[index];
        match &field.shape {
            Ok(FieldShape { layout, .. }) if *layout == Layout::array(lengths) => Ok(()),
            // A type with another name may be an alias of an array.
            Ok(FieldShape { layout, scalar: Some(scalar), .. })
                if layout.is_scalar() && is_float(&text(scalar)) =>
            {
                let message = format!("`{}` is a scalar: its type is `{}`", field.name.text, text(scalar));
                Err(place.error(message))
            }
            Ok(FieldShape { layout, .. }) if !layout.is_scalar() => {
                Err(place.error(format!("the type of `{}` says another shape", field.name.text)))
            }
            shape => {
                let is_reference = shape.as_ref().is_ok_and(|shape| shape.is_reference);
                field.shape = Ok(FieldShape { layout: Layout::array(lengths), scalar: None, is_reference });
                Ok(())
            }
        }
    }

    /// Value of a field, or of its element at `path`. Only the requested entries become parameters.
    pub(super) fn value(
        &mut self,
        index: usize,
        path: &[usize],
        place: Place,
        graph: &mut Graph,
        diagnostics: &mut Diagnostics,
    ) -> Option<Value> {
        let lengths = self.layout(index, place, diagnostics)?.lengths;
        let (outer, inner) = lengths.split_at(path.len());
        if numbers(inner) > NUMBER_LIMIT {
            return self.too_many(index, place, diagnostics);
        }
        let before = path.iter().zip(outer).fold(0, |number, (i, length)| number * length + i);
        let value = self.array(index, before * numbers(inner), inner, graph);
        if self.entries.len() > NUMBER_LIMIT {
            return self.too_many(index, place, diagnostics);
        }
        Some(value)
    }

    /// Nested arrays of these lengths, from the entries of a field that begin at `first`.
    fn array(&mut self, field: usize, first: usize, lengths: &[usize], graph: &mut Graph) -> Value {
        let Some((&length, inner)) = lengths.split_first() else {
            let entry = self.representative(Entry { field, number: first });
            let (k, _) = self.entries.insert_full(entry);
            return Value::Scalar(graph.symbol(Variable::Parameter(k).symbol()));
        };
        let item = |i: usize| self.array(field, first + i * numbers(inner), inner, graph);
        Value::Vector((0..length).map(item).collect())
    }

    fn too_many<T>(&mut self, index: usize, place: Place, diagnostics: &mut Diagnostics) -> Option<T> {
        let name = self.fields[index].text();
        let error = place.error(format!(
            "with `{name}` the expressions use more than {NUMBER_LIMIT} numbers of fields: leave them to a function, `#[function(U(x))]`, in whose field they are"
        ));
        self.report_once(index, error, diagnostics)
    }

    /// Reports an error of a field, unless one of the same field has been reported.
    fn report_once<T>(
        &mut self,
        index: usize,
        error: syn::Error,
        diagnostics: &mut Diagnostics,
    ) -> Option<T> {
        if !self.reported.contains(&index) {
            self.reported.push(index);
            diagnostics.push(error);
        }
        None
    }

    /// Layout of the entries of a field in use. A field without a layout is reported once.
    pub(super) fn layout(
        &mut self,
        index: usize,
        place: Place,
        diagnostics: &mut Diagnostics,
    ) -> Option<Layout> {
        let Field { name, place: field, shape, .. } = &self.fields[index];
        match shape {
            Ok(shape) => Some(shape.layout.clone()),
            Err(reason) => {
                let note = format!("`{}` is used here", name.text);
                self.report_once(index, field.error_beside(reason, place, note), diagnostics)
            }
        }
    }

    /// Index of the switch of a constraint, or of this element of a family of constraints up to the last one. Its field has the
    /// type `ty`, or is an array of it with an entry for each element.
    pub(super) fn switch(
        &mut self,
        (name, ty): (&Name, &str),
        [element, last]: [&[usize]; 2],
        diagnostics: &mut Diagnostics,
    ) -> Option<Entry> {
        let written = last.iter().rfold(ty.to_owned(), |ty, i| format!("[{ty}; {}]", i + 1));
        let Some(field) = self.fields.iter().position(|field| field.name.text == name.text) else {
            let message = match ty {
                CONTACT => format!(
                    "a contact is open or closed, which a field of its name says: add `{}: {written}`",
                    name.text
                ),
                FRICTION => format!(
                    "friction sticks or slides, which a field of its name says: add `{}: {written}`",
                    name.text
                ),
                _ => {
                    let fields = || self.fields.iter().map(|field| field.name.text.as_str());
                    let advice = or_meant(&name.text, nearest(&name.text, fields()), "field", fields());
                    format!("there is no field `{}`{advice}", name.text)
                }
            };
            diagnostics.error(name.place, message);
            return None;
        };
        let lengths = self.lengths_of_switch(field, ty);
        let is_shared = ty == "bool" && lengths.as_ref().is_some_and(Vec::is_empty);
        let holds = |lengths: &Vec<usize>| {
            lengths.len() == element.len() && element.iter().zip(lengths).all(|(i, length)| i < length)
        };
        let Some(lengths) = lengths.filter(|lengths| is_shared || holds(lengths)) else {
            let message = format!("`{}` switches this, so its type has to be `{written}`", name.text);
            let error = self.fields[field].place.error_beside(message, name.place, "it switches this");
            return self.report_once(field, error, diagnostics);
        };
        let number = element.iter().zip(&lengths).fold(0, |number, (i, length)| number * length + i);
        if ty != "bool" {
            let (_, largest) = self.states.entry(field).or_insert((name.place, element.to_vec()));
            largest.iter_mut().zip(element).for_each(|(largest, &i)| *largest = i.max(*largest));
        }
        Some(Entry { field, number })
    }

    /// Reports fields of contacts and friction that are longer than their families.
    pub(super) fn check_states(&mut self, diagnostics: &mut Diagnostics) {
        for (field, (place, largest)) in core::mem::take(&mut self.states) {
            let Field { name, place: of_field, shape, .. } = &self.fields[field];
            let Ok(FieldShape { layout, scalar: Some(scalar), .. }) = shape else { continue };
            // A triangular family of several indices leaves some entries out.
            if let ([last], [length]) = (&largest[..], &layout.lengths[..])
                && last + 1 < *length
            {
                let ty = format!("[{}; {}]", text(scalar), last + 1);
                let message =
                    format!("`{}` is longer than the family, so its type has to be `{ty}`", name.text);
                diagnostics.push(of_field.error_beside(message, place, "the family is here"));
            }
        }
    }

    /// Variable for a reading of a switch.
    pub(super) fn reading(&mut self, entry: Entry, reading: SwitchReading) -> Variable {
        Variable::Switch(self.switches.insert_full(Switch { entry, reading }).0)
    }

    /// Value of a switch while all constraints hold, so that friction sticks.
    pub(crate) fn switched_on(&self, symbol: Symbol) -> Option<Id> {
        let Variable::Switch(k) = Variable::of(symbol) else { return None };
        Some(match self.switches[k].reading {
            SwitchReading::Holds | SwitchReading::Sticks(_) => Id::ONE,
            SwitchReading::Slides | SwitchReading::Slip(_) | SwitchReading::Start(_) => Id::ZERO,
        })
    }

    /// Lengths of a field of switches of this type; `None` for a field of another type.
    fn lengths_of_switch(&self, field: usize, ty: &str) -> Option<Vec<usize>> {
        let FieldShape { layout, scalar, .. } = self.fields[field].shape.as_ref().ok()?;
        let name = text(scalar.as_ref()?);
        (name.rsplit("::").next() == Some(ty)).then(|| layout.lengths.clone())
    }

    /// Name of switch `k`: that of its field.
    pub(crate) fn name_of_switch(&self, k: usize) -> String {
        let Switch { entry, .. } = self.switches[k];
        self.element(entry.field, &self.indices(entry))
    }

    /// Name of entry `k`, as written in an expression.
    pub(crate) fn name(&self, k: usize) -> String {
        self.name_of(self.entries[k])
    }

    /// Name of an entry, as written in an expression.
    pub(crate) fn name_of(&self, entry: Entry) -> String {
        self.element(entry.field, &self.indices(entry))
    }

    /// Name of an element of a field, as written in an expression.
    pub(super) fn element(&self, field: usize, indices: &[usize]) -> String {
        self.spelled(field, self.fields[field].members.len(), indices)
    }

    /// Indices of an entry in its field.
    pub(crate) fn indices(&self, Entry { field, number }: Entry) -> Vec<usize> {
        self.fields[field].shape.as_ref().map_or_else(|_| Vec::new(), |shape| shape.layout.indices(number))
    }

    /// Number of leading indices that select one item of an array, such as a matrix, a quaternion or a struct.
    pub(crate) fn arrays(&self, field: usize) -> usize {
        let Field { members, shape, .. } = &self.fields[field];
        let of_shape = || shape.as_ref().map_or(0, |shape| shape.layout.arrays());
        members.last().map_or_else(of_shape, |member| member.after)
    }

    /// Scalar type: the one asked for, else that of the fields in use, else `f64`.
    pub(super) fn scalar(&self, declaration: &Declaration, diagnostics: &mut Diagnostics) -> syn::Type {
        let mut found: Option<(syn::Type, usize)> =
            declaration.options.scalar.clone().map(|scalar| (scalar, usize::MAX));
        if let Some((scalar, _)) = &found
            && is_no_number(&text(scalar))
        {
            let message = format!("`{}` is no number type: write `f64` or `f32`", text(scalar));
            diagnostics.error(Place::of(scalar), message);
            return scalar.clone();
        }
        let mut used: Vec<usize> = self.entries.iter().map(|entry| entry.field).collect();
        used.sort_unstable();
        used.dedup();
        let of_field = |index: usize| match &self.fields[index].shape {
            Ok(FieldShape { scalar: Some(scalar), .. }) => Some(scalar),
            _ => None,
        };
        // A number type that most fields have comes first: the others are at fault.
        let names: Vec<String> =
            used.iter().map(|&index| of_field(index).map_or(String::new(), text)).collect();
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        names.iter().for_each(|name| *counts.entry(name).or_default() += 1);
        let mut used: Vec<(usize, &String)> = used.into_iter().zip(&names).collect();
        used.sort_by_key(|(_, name)| (!is_scalar_name(name, declaration), Reverse(counts[name.as_str()])));
        for (index, _) in used {
            let field = &self.fields[index];
            let Some(scalar) = of_field(index) else { continue };
            match &found {
                None => {
                    let name = text(scalar);
                    if !is_scalar_name(&name, declaration) {
                        diagnostics.error(field.place, not_a_scalar(field, &name));
                    }
                    found = Some((scalar.clone(), index));
                }
                Some((known, _)) if text(known) == text(scalar) => {}
                Some((known, first)) => {
                    let (known, scalar) = (text(known), text(scalar));
                    let first =
                        self.fields.get(*first).map_or("#[lagrange(scalar = …)]", |field| &field.name.text);
                    let message = match is_scalar_name(&scalar, declaration) {
                        true => format!(
                            "one system computes in one number type: this is `{scalar}`, but `{first}` says `{known}`"
                        ),
                        false => not_a_scalar(field, &scalar),
                    };
                    diagnostics.error(field.place, message);
                }
            }
        }
        let of_structs =
            || self.entries.iter().find_map(|entry| self.scalar_argument(entry.field, declaration));
        found.map(|(scalar, _)| scalar).or_else(of_structs).unwrap_or_else(|| syn::parse_quote!(f64))
    }

    /// Best guess of the scalar type after errors: the one asked for or used, else a type parameter, else `f64`.
    pub(super) fn likely_scalar(&self, declaration: &Declaration) -> syn::Type {
        let used = self.scalar(declaration, &mut Diagnostics::default());
        let is_given = declaration.options.scalar.is_some() && !is_no_number(&text(&used));
        if is_given || (!self.entries.is_empty() && is_scalar_name(&text(&used), declaration)) {
            return used;
        }
        let of_field = |k: usize| match &self.fields[k].shape {
            Ok(FieldShape { scalar: Some(scalar), .. }) => Some(scalar.clone()),
            _ => self.scalar_argument(k, declaration),
        };
        let is_parameter = |scalar: &syn::Type| {
            declaration.generics.type_params().any(|parameter| parameter.ident == text(scalar))
        };
        let mut scalars = (0..self.fields.len()).filter_map(of_field);
        scalars.find(is_parameter).unwrap_or_else(|| syn::parse_quote!(f64))
    }
}

pub(super) fn text(ty: &syn::Type) -> String {
    ty.to_token_stream().to_string().replace(' ', "")
}

pub(super) fn is_float(name: &str) -> bool {
    ["f64", "f32"].contains(&name.rsplit("::").next().unwrap_or(name))
}

/// Returns whether a well-known type surely is no scalar type.
fn is_no_number(name: &str) -> bool {
    let types = ["String", "str", "bool", "char"];
    let integers = ["i8", "i16", "i32", "i64", "i128", "isize", "u8", "u16", "u32", "u64", "u128", "usize"];
    types.contains(&name) || integers.contains(&name)
}

/// Rejects a second range, shape or property of one field.
fn reject_repeated(parameter: &Parameter, earlier: &[Parameter]) -> syn::Result<()> {
    let name = &parameter.name;
    let what = |fact: &Fact| match fact {
        Fact::Shape(_) | Fact::Struct(_) => "shape",
        Fact::Range(..) => "range",
        Fact::Property(_) => "property",
    };
    let same =
        |known: &&Parameter| known.name.text == name.text && what(&known.fact) == what(&parameter.fact);
    let Some(known) = earlier.iter().find(same) else { return Ok(()) };
    let message = format!("the {} of `{}` is given twice", what(&parameter.fact), name.text);
    Err(name.place.error_beside(message, known.name.place, "the first one is here"))
}

pub(super) fn is_scalar_name(name: &str, declaration: &Declaration) -> bool {
    let last = name.rsplit("::").next().unwrap_or(name);
    is_float(name) || declaration.generics.type_params().any(|parameter| parameter.ident == last)
}

fn not_a_scalar(field: &Field, name: &str) -> String {
    if is_no_number(name) {
        return format!("a field of type `{name}` cannot stand in an expression: make it `f64`");
    }
    format!(
        "`{field}` is taken for a number, but `{name}` is no number type that is known here: write `f64`, `f32` or a type parameter, or name the number type with `#[lagrange(scalar = {name})]`; if it stands for an array, write the array, or say its shape with `#[parameter({field}: [3])]`, or the members of a struct with `#[parameter({field}: {{m}})]`",
        field = field.text()
    )
}

/// Evaluates the range `low..high` of a `parameter` attribute.
fn bounds(low: &Expression, high: &Expression) -> syn::Result<(f64, f64)> {
    let (from, to) = (literal(low)?, literal(high)?);
    if from < to { Ok((from, to)) } else { Err(low.place.to(high.place).error("this range is empty")) }
}

fn literal(expression: &Expression) -> syn::Result<f64> {
    match &expression.kind {
        Kind::Number(value) => Ok(value.to_f64()),
        Kind::Negative(inner) => literal(inner).map(|value| -value),
        Kind::Product(factors) => factors.iter().try_fold(1.0, |product, (operator, factor)| {
            let factor = literal(factor)?;
            Ok(if *operator == Operator::Over { product / factor } else { product * factor })
        }),
        _ => Err(expression.place.error("a range for sampling has numbers as its ends")),
    }
}
