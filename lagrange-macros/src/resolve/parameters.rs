//! The parameters: which numbers in which fields the expressions use.

use indexmap::IndexSet;
use quote::ToTokens;

use super::value::Value;
use crate::diagnostics::{Diagnostics, Place};
use crate::symbolic::{Graph, to_f64};
use crate::syntax::{Declaration, Expression, Field, FieldShape, Kind, Layout};
use crate::variables::Variable;

/// A number in a field: the field's index and the path to the number inside of it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) struct Entry {
    pub(crate) field: usize,
    pub(crate) element: Element,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Element {
    All,
    Item(usize),
    /// Row, then column, of an array of rows.
    RowItem(usize, usize),
    /// Row and column of a nalgebra matrix.
    Cell(usize, usize),
}

/// The fields as the expressions see them.
pub(crate) struct Parameters {
    pub(crate) fields: Vec<Field>,
    /// The numbers in use; the parameter variable k is entry k.
    pub(crate) entries: IndexSet<Entry>,
    /// For each field, where random values for tests are drawn from.
    pub(crate) ranges: Vec<(f64, f64)>,
    /// The fields already reported as unusable, each once.
    reported: Vec<usize>,
}

impl Parameters {
    pub(super) fn new(declaration: &Declaration, diagnostics: &mut Diagnostics) -> Self {
        let fields = declaration.fields.clone();
        let ranges = vec![(0.5, 1.5); fields.len()];
        let mut parameters = Self { fields, entries: IndexSet::new(), ranges, reported: Vec::new() };
        for parameter in &declaration.parameters {
            let name = &parameter.name;
            let Some(index) = parameters.fields.iter().position(|field| field.name.text == name.text) else {
                diagnostics.error(name.place, format!("there is no field `{}`", name.text));
                continue;
            };
            if let Some(length) = parameter.length {
                diagnostics.note(parameters.set_length(index, length, name.place));
            }
            if let Some((low, high)) = &parameter.range {
                diagnostics.note(bounds(low, high).map(|range| parameters.ranges[index] = range));
            }
        }
        parameters
    }

    fn set_length(&mut self, index: usize, length: usize, place: Place) -> syn::Result<()> {
        let field = &mut self.fields[index];
        match &field.shape {
            Ok(FieldShape { layout: Layout::Vector(known), .. }) if *known == length => Ok(()),
            Ok(FieldShape { layout: Layout::Scalar, .. }) | Err(_) => {
                let is_reference = field.shape.as_ref().is_ok_and(|shape| shape.is_reference);
                field.shape = Ok(FieldShape { layout: Layout::Vector(length), scalar: None, is_reference });
                Ok(())
            }
            Ok(_) => Err(place.error(format!("the type of `{}` says another shape", field.name.text))),
        }
    }

    /// The value of a field, its numbers entered among those in use.
    pub(super) fn value(
        &mut self,
        index: usize,
        place: Place,
        graph: &mut Graph,
        diagnostics: &mut Diagnostics,
    ) -> Option<Value> {
        let layout = match &self.fields[index].shape {
            Ok(shape) => shape.layout,
            Err(reason) => {
                if !self.reported.contains(&index) {
                    let mut error = self.fields[index].place.error(reason);
                    error.combine(place.error(format!("`{}` is used here", self.fields[index].name.text)));
                    diagnostics.push(error);
                    self.reported.push(index);
                }
                return None;
            }
        };
        let mut entry = |element| {
            let (k, _) = self.entries.insert_full(Entry { field: index, element });
            Value::Scalar(graph.symbol(Variable::Parameter(k).symbol()))
        };
        let mut table = |rows: usize, columns: usize, element: fn(usize, usize) -> Element| {
            let mut row = |i| Value::Vector((0..columns).map(|j| entry(element(i, j))).collect());
            Value::Vector((0..rows).map(&mut row).collect())
        };
        Some(match layout {
            Layout::Rows(rows, columns) => table(rows, columns, Element::RowItem),
            Layout::Matrix(rows, columns) => table(rows, columns, Element::Cell),
            Layout::Scalar => entry(Element::All),
            Layout::Vector(length) => Value::Vector((0..length).map(|i| entry(Element::Item(i))).collect()),
        })
    }

    /// The number type: what the fields in use are made of, else `f64`.
    pub(crate) fn scalar(&self, declaration: &Declaration, diagnostics: &mut Diagnostics) -> syn::Type {
        let mut found: Option<(syn::Type, usize)> =
            declaration.options.scalar.clone().map(|scalar| (scalar, usize::MAX));
        let mut used: Vec<usize> = self.entries.iter().map(|entry| entry.field).collect();
        used.sort_unstable();
        used.dedup();
        for index in used {
            let field = &self.fields[index];
            let Ok(FieldShape { scalar: Some(scalar), .. }) = &field.shape else { continue };
            match &found {
                None => {
                    if let Err(message) = is_scalar(scalar, declaration) {
                        diagnostics.error(field.place, message);
                    }
                    found = Some((scalar.clone(), index));
                }
                Some((known, _)) if text(known) == text(scalar) => {}
                Some((known, _)) => {
                    let (known, scalar) = (text(known), text(scalar));
                    let message = match is_scalar_name(&scalar, declaration) {
                        true => format!(
                            "one system computes in one number type: this is `{scalar}`, but others are `{known}`"
                        ),
                        false => not_a_scalar(&scalar),
                    };
                    diagnostics.error(field.place, message);
                }
            }
        }
        found.map_or_else(|| syn::parse_quote!(f64), |(scalar, _)| scalar)
    }
}

fn text(ty: &syn::Type) -> String {
    ty.to_token_stream().to_string().replace(' ', "")
}

fn is_scalar(ty: &syn::Type, declaration: &Declaration) -> Result<(), String> {
    let name = text(ty);
    if is_scalar_name(&name, declaration) { Ok(()) } else { Err(not_a_scalar(&name)) }
}

fn is_scalar_name(name: &str, declaration: &Declaration) -> bool {
    let last = name.rsplit("::").next().unwrap_or(name);
    ["f64", "f32"].contains(&last)
        || declaration.generics.type_params().any(|parameter| parameter.ident == last)
}

fn not_a_scalar(name: &str) -> String {
    format!(
        "a field of type `{name}` cannot stand in an expression: write `f64`, `f32` or a type parameter, or name the number type with `#[lagrange(scalar = {name})]`"
    )
}

/// `low..high` of a `parameter` attribute, in numbers.
fn bounds(low: &Expression, high: &Expression) -> syn::Result<(f64, f64)> {
    let (from, to) = (literal(low)?, literal(high)?);
    if from < to { Ok((from, to)) } else { Err(low.place.to(high.place).error("this range is empty")) }
}

fn literal(expression: &Expression) -> syn::Result<f64> {
    match &expression.kind {
        Kind::Number(value) => Ok(to_f64(*value)),
        Kind::Negative(inner) => literal(inner).map(|value| -value),
        _ => Err(expression.place.error("a range for sampling has numbers as its ends")),
    }
}
