//! Reads a struct and its attributes into a [`Declaration`]. Reports attributes that are missing, repeated or
//! misplaced.

use syn::{Attribute, Data, DeriveInput, Fields, MacroDelimiter, Meta, Result};

use super::constraint::{constraint, contact, friction};
use super::cursor::Cursor;
use super::declaration::{Declaration, Options};
use super::digest::digest;
use super::field::Field;
use super::forms::{FORMS, coordinates, define, force, form, function, observable, only, options, power};
use super::frame::{frame, unit_constraints};
use super::parameter::parameter;
use crate::diagnostics::{Diagnostics, Place};

/// Reads the struct. Despite errors, returns all parts that could be read.
pub(crate) fn declaration(input: DeriveInput, diagnostics: &mut Diagnostics) -> Declaration {
    let fields = fields(&input, diagnostics);
    let digest = digest(&input.ident, &fields, input.attrs.iter().filter(|attribute| moves(attribute)));
    let mut declaration = Declaration {
        ident: input.ident,
        visibility: input.vis,
        generics: input.generics,
        fields,
        coordinates: Vec::new(),
        are_coordinates_read: false,
        defines: Vec::new(),
        functions: Vec::new(),
        frames: Vec::new(),
        lagrangian: None,
        constraints: Vec::new(),
        forces: Vec::new(),
        powers: Vec::new(),
        dissipation: None,
        observables: Vec::new(),
        parameters: Vec::new(),
        options: Options::default(),
        digest,
    };
    let mut seen = Vec::new();
    for attribute in &input.attrs {
        if let Some(word) = own(attribute) {
            let statements = once(word, attribute, &mut seen).and_then(|()| statements(word, attribute));
            for mut statement in diagnostics.note(statements).unwrap_or_default() {
                let result = read(&mut declaration, word, &mut statement);
                diagnostics.note(result);
            }
        }
    }
    for (word, example) in
        [("coordinates", "#[coordinates(x, y)]"), ("lagrangian", "#[lagrangian(m/2 * x_dot^2)]")]
    {
        if !seen.iter().any(|(found, _)| *found == word) {
            let place = Place::at(declaration.ident.span());
            diagnostics.error(place, format!("`#[{word}(…)]` is missing, for example `{example}`"));
        }
    }
    let units = unit_constraints(&declaration);
    declaration.constraints.extend(units);
    declaration
}

fn fields(input: &DeriveInput, diagnostics: &mut Diagnostics) -> Vec<Field> {
    let place = Place::at(input.ident.span());
    let Data::Struct(data) = &input.data else {
        diagnostics.error(place, "a Lagrangian system is a struct whose fields are its parameters");
        return Vec::new();
    };
    let (Fields::Named(_) | Fields::Unit) = &data.fields else {
        diagnostics.error(place, "the fields need names, for expressions to use them: `struct S { m: f64 }`");
        return Vec::new();
    };
    for attribute in data.fields.iter().flat_map(|field| &field.attrs) {
        if let Some(word) = own(attribute) {
            diagnostics.error(
                Place::of(&attribute.meta),
                format!("`#[{word}(…)]` belongs on the struct, not on a field"),
            );
        }
    }
    data.fields
        .iter()
        .filter_map(|field| field.ident.as_ref().map(|ident| Field::new(field, ident)))
        .collect()
}

/// Attributes of a struct that Rust knows, and common ones of other derives.
const OF_OTHERS: [&str; 18] = [
    "allow",
    "automatically_derived",
    "cfg",
    "cfg_attr",
    "default",
    "deny",
    "deprecated",
    "derive",
    "doc",
    "expect",
    "forbid",
    "inline",
    "must_use",
    "non_exhaustive",
    "repr",
    "serde",
    "track_caller",
    "warn",
];

/// Reports attributes that nobody knows. A compiler does so itself; elsewhere a slip such as `#[constrain(…)]` would leave
/// out what it says.
pub(crate) fn refuse_unknown(input: &DeriveInput, diagnostics: &mut Diagnostics) {
    let is_unknown = |attribute: &&Attribute| {
        let word = attribute.path().get_ident().map(ToString::to_string);
        own(attribute).is_none() && word.is_some_and(|word| !OF_OTHERS.contains(&&*word))
    };
    for attribute in input.attrs.iter().filter(is_unknown) {
        let word = attribute.path().get_ident().map_or_else(String::new, ToString::to_string);
        let distance = |known: &str| strsim::damerau_levenshtein(&word, known);
        let near = FORMS.into_iter().map(|(known, _)| known).min_by_key(|known| distance(known));
        let advice = match near.filter(|known| distance(known) <= 2) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("there are {}", FORMS.map(|(known, _)| format!("`{known}`")).join(", ")),
        };
        diagnostics.error(Place::of(attribute.path()), format!("no attribute is called `{word}`: {advice}"));
    }
}

/// Returns the name of an attribute that belongs to this derive.
fn own(attribute: &Attribute) -> Option<&'static str> {
    FORMS.into_iter().map(|(word, _)| word).find(|word| attribute.path().is_ident(word))
}

/// True if the attribute affects the motion.
fn moves(attribute: &Attribute) -> bool {
    own(attribute).is_some_and(|word| !matches!(word, "observable" | "conserved"))
}

/// Reports a repeated attribute that may occur only once.
fn once(word: &'static str, attribute: &Attribute, seen: &mut Vec<(&'static str, Place)>) -> Result<()> {
    let place = Place::of(&attribute.meta);
    let earlier = seen.iter().find(|(found, _)| *found == word).map(|(_, place)| *place);
    seen.push((word, place));
    let (Some(advice), Some(earlier)) = (advice_on_several(word), earlier) else { return Ok(()) };
    let message = format!("`#[{word}(…)]` is given twice: {advice}");
    Err(place.error_beside(message, earlier, "the first one is here"))
}

/// Advice in place of several statements of this kind; `None` where a system may have several.
fn advice_on_several(word: &str) -> Option<&'static str> {
    match word {
        "coordinates" => Some("list all coordinates in one: `#[coordinates(x, y)]`"),
        "lagrangian" => Some("a system has one Lagrangian: write it as one sum"),
        "dissipation" => Some("a system has one dissipation function: write it as one sum"),
        "lagrange" => Some("put all options into one"),
        _ => None,
    }
}

/// Returns the statements in the parentheses of the attribute: those of a kind that a system may have several of are
/// separated by `;`.
fn statements(word: &str, attribute: &Attribute) -> Result<Vec<Cursor>> {
    let mut rest = content(word, attribute)?;
    if advice_on_several(word).is_some() {
        return Ok(vec![rest]);
    }
    let mut statements = Vec::new();
    while !rest.is_empty() {
        statements.push(rest.until(|cursor| cursor.is_punct(';')));
        rest.take_punct(';');
    }
    Ok(statements)
}

fn read(declaration: &mut Declaration, word: &str, cursor: &mut Cursor) -> Result<()> {
    match word {
        "coordinates" => {
            coordinates(cursor, &mut declaration.coordinates)?;
            declaration.are_coordinates_read = true;
        }
        "define" => define(cursor, &mut declaration.defines)?,
        "function" => declaration.functions.push(function(cursor)?),
        "frame" => declaration.frames.push(frame(cursor, declaration.defines.len())?),
        "lagrangian" => only(cursor, &mut declaration.lagrangian)?,
        "constraint" => constraint(cursor, &mut declaration.constraints)?,
        "contact" => contact(cursor, &mut declaration.constraints)?,
        "friction" => friction(cursor, &mut declaration.constraints)?,
        "force" => force(cursor, &mut declaration.forces)?,
        "power" => declaration.powers.push(power(cursor)?),
        "dissipation" => only(cursor, &mut declaration.dissipation)?,
        "observable" | "conserved" => observable(word, cursor, &mut declaration.observables)?,
        "parameter" => declaration.parameters.push(parameter(cursor)?),
        _ => options(cursor, &mut declaration.options)?,
    }
    Ok(())
}

/// Returns the tokens between the parentheses of the attribute. Empty parentheses are an error.
fn content(word: &str, attribute: &Attribute) -> Result<Cursor> {
    match &attribute.meta {
        Meta::List(list) if matches!(list.delimiter, MacroDelimiter::Paren(_)) && !list.tokens.is_empty() => {
            Ok(Cursor::new(list.tokens.clone(), list.delimiter.span().close()))
        }
        _ => Err(Place::of(&attribute.meta).error(format!("this attribute is written `{}`", form(word)))),
    }
}
