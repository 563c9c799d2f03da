//! Lengths that are known at run time: integer fields, constants, and what `#[parameter(m: [n])]` calls the length
//! of a field.

use quote::ToTokens;

use super::{Affine, Array, Many, OpenField, Unknown};
use crate::diagnostics::Diagnostics;
use crate::resolve::parameters::Parameters;
use crate::symbolic::{Graph, Id};
use crate::syntax::{
    Coordinate, Declaration, Expression, Fact, FieldShape, Kind, Layout, Lengths, Name, Operator, Sign,
    arrays, element_type, shape,
};
use crate::variables::Variable;

/// Largest dimension of an array that is printed as one vector: Cartesian space. Longer arrays of scalars are families of elements.
const VECTOR: usize = 3;

/// A length of arrays.
pub(crate) struct Length {
    pub(crate) name: String,
    pub(crate) source: LengthSource,
}

/// Source of a length at run time.
pub(crate) enum LengthSource {
    /// An integer field, by its index.
    Field(usize),
    /// Number of the elements of a field, by the index of the field.
    Of(usize),
    /// A constant of the crate, or a parameter of the type.
    Constant(syn::Ident),
}

impl Many {
    /// Reads the lengths that a declaration names. Stays empty if all lengths of its coordinates are numbers.
    pub(in crate::resolve) fn of(
        declaration: &Declaration,
        parameters: &Parameters,
        diagnostics: &mut Diagnostics,
    ) -> Self {
        let mut many = Self { taken: names(declaration), ..Self::default() };
        if !declaration.has_open_lengths() {
            return many;
        }
        let open: Vec<(usize, &Name, &Lengths)> = open_fields(declaration);
        let of_coordinates = declaration.coordinates.iter().flat_map(|coordinate| &coordinate.open);
        let written = of_coordinates.chain(open.iter().flat_map(|(_, _, lengths)| &lengths.open));
        let mut length = |name: &Name, source: Option<LengthSource>| {
            if many.lengths.iter().any(|known| known.name == name.text) {
                return;
            }
            match source {
                Some(source) => many.lengths.push(Length { name: name.text.clone(), source }),
                None => unknown(declaration, name, diagnostics),
            }
        };
        for written in written {
            written.names(&mut |name| length(name, source(declaration, parameters, &open, name)));
        }
        // Bounds and expressions may name other integer fields.
        for (index, field) in declaration.fields.iter().enumerate() {
            if is_length(parameters, index) {
                length(&field.name, Some(LengthSource::Field(index)));
            }
        }
        many.arrays = declaration
            .coordinates
            .iter()
            .map(|coordinate| Array {
                name: coordinate.name.text.clone(),
                open: coordinate.open.iter().map(|length| many.read(length, diagnostics)).collect(),
                lengths: coordinate.lengths.clone(),
                place: coordinate.name.place,
            })
            .collect();
        for (field, name, lengths) in open {
            let ty = &declaration.fields[field].ty;
            let Some(element) = element_type(ty) else { continue };
            let [length] = &lengths.open[..] else {
                diagnostics.error(name.place, "a field has one length that is known when the program runs, `[n]` or `[n, 3]`: put what has two in one row, `a[i*columns + j]`");
                continue;
            };
            let length = many.read(length, diagnostics);
            let is_table = is_table(element);
            many.fields.push(OpenField { field, length, element: shape(element), is_table });
        }
        many
    }

    /// Reads arrays of constant length as if the lengths were known at run time, to try equations that hold for all elements.
    /// Stays empty if no array has several elements.
    pub(in crate::resolve) fn attempt(declaration: &Declaration) -> Self {
        let mut many = Self { is_attempt: true, taken: names(declaration), ..Self::default() };
        let lengths = declaration.coordinates.iter().map(|coordinate| apart(&coordinate.lengths));
        let open: Vec<usize> = lengths.filter_map(|(open, _)| open).collect();
        if open.is_empty() {
            return many;
        }
        let array = |coordinate: &Coordinate| {
            let (open, lengths) = apart(&coordinate.lengths);
            let open = open.map(|length| Affine::number(length as i64)).into_iter().collect();
            Array { name: coordinate.name.text.clone(), open, lengths, place: coordinate.name.place }
        };
        many.arrays = declaration.coordinates.iter().map(array).collect();
        let mut whole = Vec::new();
        declaration
            .expressions()
            .for_each(|part| part.whole_names(&mut |name| whole.push(name.text.clone())));
        let fields = declaration.fields.iter().enumerate();
        for (index, field) in fields.filter(|(_, field)| !whole.contains(&field.name.text)) {
            let (Ok(shape), (lengths, _)) = (&field.shape, arrays(&field.ty)) else { continue };
            let Some(length) = lengths.first().filter(|length| open.contains(length)) else { continue };
            let rest = shape.layout.lengths[1..].to_vec();
            let layout = Layout { lengths: rest, inside: shape.layout.inside };
            let element = Ok(FieldShape { layout, ..shape.clone() });
            let length = Affine::number(*length as i64);
            many.fields.push(OpenField { field: index, length, element, is_table: false });
        }
        many
    }

    fn read(&self, length: &Expression, diagnostics: &mut Diagnostics) -> Affine {
        let read = self.affine(length);
        if read.is_none() && diagnostics.is_empty() {
            diagnostics.error(length.place, "a length is a name, `n`, or a sum with whole numbers, `n + 1`");
        }
        read.unwrap_or_default()
    }

    /// A length as written, from names of lengths and whole numbers.
    fn affine(&self, length: &Expression) -> Option<Affine> {
        match &length.kind {
            Kind::Number(value) => Some(Affine::number(i64::try_from(value.to_integer()?).ok()?)),
            Kind::Name(name) => {
                let found = self.lengths.iter().position(|known| known.name == name.text)?;
                Some(Affine::of(Unknown::Length(found)))
            }
            Kind::Sum(terms) => terms.iter().try_fold(Affine::default(), |sum, (sign, term)| {
                Some(sum.plus(&self.affine(term)?, if *sign == Sign::Minus { -1 } else { 1 }))
            }),
            Kind::Product(factors) => match &factors[..] {
                [(Operator::Times, one), (Operator::Times, other)] => {
                    let (one, other) = (self.affine(one)?, self.affine(other)?);
                    let of = |factor: &Affine, whole: &Affine| {
                        Some(Affine::default().plus(whole, factor.as_number()?))
                    };
                    of(&one, &other).or_else(|| of(&other, &one))
                }
                _ => None,
            },
            _ => None,
        }
    }

    /// The length that a field holds, as a node of the graph.
    pub(in crate::resolve) fn length_in(&self, field: usize, graph: &mut Graph) -> Option<Id> {
        let is_it = |length: &Length| matches!(length.source, LengthSource::Field(known) if known == field);
        let found = self.lengths.iter().position(is_it)?;
        Some(graph.symbol(Variable::Length(found).symbol()))
    }

    /// The length of this name, if it is no field, as a node of the graph.
    pub(in crate::resolve) fn length_called(&self, name: &str, graph: &mut Graph) -> Option<Id> {
        let is_it = |length: &Length| length.name == name && !matches!(length.source, LengthSource::Field(_));
        let found = self.lengths.iter().position(is_it)?;
        Some(graph.symbol(Variable::Length(found).symbol()))
    }
}

/// Names of fields, coordinates and definitions.
fn names(declaration: &Declaration) -> Vec<String> {
    let fields = declaration.fields.iter().map(|field| &field.name);
    let coordinates = declaration.coordinates.iter().map(|coordinate| &coordinate.name);
    let definitions = declaration.defines.iter().map(|define| &define.target.name);
    fields.chain(coordinates).chain(definitions).map(|name| name.text.clone()).collect()
}

/// Fields whose shape is stated with a length that is known at run time.
fn open_fields(declaration: &Declaration) -> Vec<(usize, &Name, &Lengths)> {
    let stated = declaration.parameters.iter().filter_map(|parameter| match &parameter.fact {
        Fact::Shape(lengths) if !lengths.open.is_empty() => Some((&parameter.name, lengths)),
        _ => None,
    });
    let field = |name: &Name| declaration.fields.iter().position(|field| field.name.text == name.text);
    stated.filter_map(|(name, lengths)| Some((field(name)?, name, lengths))).collect()
}

fn source(
    declaration: &Declaration,
    parameters: &Parameters,
    open: &[(usize, &Name, &Lengths)],
    name: &Name,
) -> Option<LengthSource> {
    if let Some(field) = declaration.fields.iter().position(|field| field.name.text == name.text) {
        return is_length(parameters, field).then_some(LengthSource::Field(field));
    }
    let is_alone = |length: &Expression| matches!(&length.kind, Kind::Name(known) if known.text == name.text);
    if let Some((field, ..)) = open.iter().find(|(_, _, lengths)| lengths.open.first().is_some_and(is_alone))
    {
        return Some(LengthSource::Of(*field));
    }
    let is_constant = !name.text.chars().any(char::is_lowercase);
    is_constant.then(|| {
        let mut ident = syn::Ident::new(&name.text, name.place.start());
        ident.set_span(name.place.start());
        LengthSource::Constant(ident)
    })
}

/// True for a field of type `usize`.
fn is_length(parameters: &Parameters, field: usize) -> bool {
    let shape = parameters.fields[field].shape.as_ref();
    shape.is_ok_and(|shape| shape.layout.is_scalar() && shape.scalar.as_ref().is_some_and(is_index))
}

fn unknown(declaration: &Declaration, Name { text: name, place }: &Name, diagnostics: &mut Diagnostics) {
    if let Some(field) = declaration.fields.iter().find(|field| field.name.text == *name) {
        let ty = field.ty.to_token_stream();
        return diagnostics.error(
            *place,
            format!("a length is a whole number: the type of `{name}` has to be `usize`, and is `{ty}`"),
        );
    }
    diagnostics.error(*place, format!(
        "the length `{name}` is no integer field and no length of a field: add a field `{name}: usize`, or say whose length it is, `#[parameter(m: [{name}])]` for `m: Vec<f64>`"
    ));
}

/// True for `usize`.
fn is_index(ty: &syn::Type) -> bool {
    ty.to_token_stream().to_string() == "usize"
}

/// True if the elements are indices: `usize`, `[usize; 2]`.
fn is_table(element: &syn::Type) -> bool {
    match element {
        syn::Type::Array(array) => is_table(&array.elem),
        other => is_index(other),
    }
}

/// Number of elements of an array, if it is no vector, and the lengths of an element.
fn apart(lengths: &[usize]) -> (Option<usize>, Vec<usize>) {
    match lengths {
        [length, rest @ ..] if !rest.is_empty() || *length > VECTOR => (Some(*length), rest.to_vec()),
        lengths => (None, lengths.to_vec()),
    }
}

/// Advice where equations that are written out are too long, if they could be loops.
pub(crate) fn loops_instead(coordinates: &[Coordinate]) -> &'static str {
    let is_array =
        |coordinate: &Coordinate| coordinate.open.is_empty() && apart(&coordinate.lengths).0.is_some();
    match coordinates.iter().any(is_array) {
        true => {
            "; give the length of an array a name, `const N: usize = 100;` and `#[coordinates(r: [N, 3])]`: sums then become loops (any number of bodies)"
        }
        false => "",
    }
}
