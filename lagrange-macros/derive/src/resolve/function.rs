//! Functions supplied by the user: fields that expressions call.

use super::label::entry_names;
use super::lowering::Lowering;
use super::scope::{Entity, Scope};
use super::unknown::nearest;
use super::value::Shape;
use super::value::Value;
use crate::diagnostics::{Diagnostics, Place};
use crate::symbolic::External;
use crate::syntax::{Coordinate, Declaration, Expression, FunctionDeclaration, Name, numbers};

/// A user-supplied function, as generated code calls it.
pub(crate) struct Supplied {
    /// Name in expressions.
    pub(crate) name: String,
    pub(crate) field: syn::Ident,
    /// Type of the function, without the reference if the field is one.
    pub(crate) ty: syn::Type,
    pub(crate) is_reference: bool,
    /// Source position of the name in the attribute.
    pub(crate) place: Place,
    /// Name and array lengths of each declared argument.
    pub(crate) formals: Vec<(String, Vec<usize>)>,
    /// Number of scalars in all arguments together.
    pub(crate) inputs: usize,
    /// Number of scalars in the result.
    pub(crate) outputs: usize,
    /// Names of the scalars in the result: `A[0]`, `A[1]`.
    pub(crate) names: Vec<String>,
}

/// Finds the field of each declared function.
pub(super) fn supplied(
    declaration: &Declaration,
    scope: &Scope,
    diagnostics: &mut Diagnostics,
) -> Vec<Supplied> {
    let supplied = declaration.functions.iter().filter_map(|function| {
        let Some(field) = declaration.fields.iter().find(|field| field.name.text == function.field.text)
        else {
            diagnostics.push(no_such_field(function, declaration));
            return None;
        };
        let formals = function.formals.iter();
        let formals: Vec<_> = formals
            .map(|formal| (formal.0.text.clone(), formal_lengths(formal, &declaration.coordinates, scope)))
            .collect();
        let (ty, is_reference) = match &field.ty {
            syn::Type::Reference(reference) => (&*reference.elem, true),
            ty => (ty, false),
        };
        Some(Supplied {
            name: function.name.text.clone(),
            field: field.ident.clone(),
            ty: ty.clone(),
            is_reference,
            place: function.name.place,
            inputs: formals.iter().map(|(_, lengths)| numbers(lengths)).sum(),
            formals,
            outputs: numbers(&function.lengths),
            names: entry_names(&function.name.text, &function.lengths),
        })
    });
    supplied.collect()
}

fn no_such_field(
    FunctionDeclaration { name, field, .. }: &FunctionDeclaration,
    declaration: &Declaration,
) -> syn::Error {
    let fields = declaration.fields.iter().map(|field| field.name.text.as_str());
    let advice = match nearest(&field.text, fields) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("name the one that is the function, `#[function({}(…) = field)]`", name.text),
    };
    field.place.error(format!("there is no field `{}`: {advice}", field.text))
}

/// Shape of a formal argument: its declared shape, else that of the coordinate of the same name, else a scalar.
fn formal_lengths(
    (name, lengths): &(Name, Vec<usize>),
    coordinates: &[Coordinate],
    scope: &Scope,
) -> Vec<usize> {
    match scope.get(&name.text) {
        Some(Entity::Coordinate(index) | Entity::Velocity(index)) if lengths.is_empty() => {
            coordinates[index].lengths.clone()
        }
        _ => lengths.clone(),
    }
}

impl Lowering<'_> {
    pub(super) fn supplied_function(
        &mut self,
        index: usize,
        arguments: &[Expression],
        place: Place,
    ) -> Option<Value> {
        let function: &FunctionDeclaration = &self.functions[index];
        let (name, wanted, given) = (&function.name.text, function.formals.len(), arguments.len());
        if wanted != given {
            return self.wrong_number(&function.name, wanted, given, place);
        }
        let values = self.lower_all(arguments)?;
        let mut flat = Vec::new();
        for ((value, argument), formal) in values.iter().zip(arguments).zip(&function.formals) {
            let lengths = formal_lengths(formal, self.coordinates, &self.scope);
            if value.shape().lengths != lengths {
                let wanted = Shape::plain(lengths);
                let message =
                    format!("`{name}` takes {wanted} as `{}`, but this is {}", formal.0.text, value.shape());
                return self.report(argument.place, message);
            }
            flat.extend(value.flat());
        }
        let output = |lowering: &mut Self, output| {
            let arguments = flat.clone().into();
            let (function, derivatives) = (index as u32, Box::default());
            let external = External { function, output, derivatives, arguments, is_along: false };
            lowering.graph.external(external)
        };
        let outputs: Vec<_> = (0..numbers(&function.lengths)).map(|i| output(self, i as u32)).collect();
        Some(Value::array(&function.lengths, &outputs))
    }
}
