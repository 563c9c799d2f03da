//! The attributes, one function a form.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::ToTokens;
use syn::{Attribute, Data, DeriveInput, Fields, MacroDelimiter, Meta, Result};

use super::Name;
use super::cursor::Cursor;
use super::expression::{self, Expression, Kind};
use super::field::{Field, LENGTH_LIMIT};
use super::target::{Target, TargetIndex, target};
use crate::diagnostics::{Diagnostics, Place};

/// The struct and its attributes as written.
pub(crate) struct Declaration {
    pub(crate) ident: syn::Ident,
    pub(crate) visibility: syn::Visibility,
    pub(crate) generics: syn::Generics,
    pub(crate) fields: Vec<Field>,
    pub(crate) coordinates: Vec<Coordinate>,
    pub(crate) defines: Vec<Define>,
    pub(crate) functions: Vec<Function>,
    pub(crate) lagrangian: Option<Expression>,
    pub(crate) constraints: Vec<Constraint>,
    pub(crate) forces: Vec<Force>,
    pub(crate) dissipation: Option<Expression>,
    pub(crate) observables: Vec<Named>,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) options: Options,
}

/// `#[coordinates(x, r: [3])]`, one entry.
#[derive(Clone, Debug)]
pub(crate) struct Coordinate {
    pub(crate) name: Name,
    pub(crate) length: Option<usize>,
}

/// `#[define(name = expression)]`
#[derive(Debug)]
pub(crate) struct Define {
    pub(crate) target: Target,
    /// `#[define(f(x) = …)]`
    pub(crate) formals: Option<Vec<Name>>,
    pub(crate) body: Expression,
}

/// `#[function(Omega(t): [3] = omega)]`
#[derive(Debug)]
pub(crate) struct Function {
    pub(crate) name: Name,
    /// Each formal, with its length if it says one.
    pub(crate) formals: Vec<(Name, Option<usize>)>,
    /// The length of the result, if it is a vector.
    pub(crate) length: Option<usize>,
    /// The field; by default the one of the function's name.
    pub(crate) field: Name,
}

/// `#[constraint(name: left = right)]`
#[derive(Debug)]
pub(crate) struct Constraint {
    pub(crate) target: Target,
    pub(crate) left: Expression,
    pub(crate) right: Expression,
}

/// `#[force(coordinate: expression)]`
#[derive(Debug)]
pub(crate) struct Force {
    pub(crate) target: Target,
    pub(crate) value: Expression,
}

/// `#[observable(name = expression)]` or `#[conserved(name = expression)]`
#[derive(Debug)]
pub(crate) struct Named {
    pub(crate) name: Name,
    pub(crate) is_conserved: bool,
    pub(crate) value: Expression,
}

/// `#[parameter(a: [3])]` or `#[parameter(e: 0..1)]`
#[derive(Debug)]
pub(crate) struct Parameter {
    pub(crate) name: Name,
    pub(crate) length: Option<usize>,
    pub(crate) range: Option<(Expression, Expression)>,
}

/// `#[lagrange(crate = path, scalar = T)]`
#[derive(Default)]
pub(crate) struct Options {
    pub(crate) runtime: Option<TokenStream>,
    pub(crate) scalar: Option<syn::Type>,
}

/// Beyond, rustc takes minutes, and the matrices exceed the stack.
const COORDINATE_LIMIT: usize = 1000;

const ATTRIBUTES: [&str; 11] = [
    "coordinates",
    "define",
    "function",
    "lagrangian",
    "constraint",
    "force",
    "dissipation",
    "observable",
    "conserved",
    "parameter",
    "lagrange",
];

/// Reads the struct. What could be read is returned even where something was wrong.
pub(crate) fn declaration(input: DeriveInput, diagnostics: &mut Diagnostics) -> Declaration {
    let fields = fields(&input, diagnostics);
    let mut declaration = Declaration {
        ident: input.ident,
        visibility: input.vis,
        generics: input.generics,
        fields,
        coordinates: Vec::new(),
        defines: Vec::new(),
        functions: Vec::new(),
        lagrangian: None,
        constraints: Vec::new(),
        forces: Vec::new(),
        dissipation: None,
        observables: Vec::new(),
        parameters: Vec::new(),
        options: Options::default(),
    };
    let mut seen = Vec::new();
    for attribute in &input.attrs {
        if let Some(word) = own(attribute) {
            let result =
                once(word, attribute, &mut seen).and_then(|()| read(&mut declaration, word, attribute));
            diagnostics.note(result);
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
            diagnostics
                .error(whole(attribute), format!("`#[{word}(…)]` belongs on the struct, not on a field"));
        }
    }
    data.fields
        .iter()
        .filter_map(|field| field.ident.as_ref().map(|ident| Field::new(field, ident)))
        .collect()
}

/// The word of an attribute that is ours.
fn own(attribute: &Attribute) -> Option<&'static str> {
    ATTRIBUTES.into_iter().find(|word| attribute.path().is_ident(word))
}

fn whole(attribute: &Attribute) -> Place {
    let span = |token: Option<TokenTree>| token.map_or(attribute.pound_token.span, |token| token.span());
    let mut tokens = attribute.meta.to_token_stream().into_iter();
    let first = Place::at(span(tokens.next()));
    match tokens.last() {
        Some(last) => first.to(Place::at(last.span())),
        None => first,
    }
}

/// Attributes that say one thing are given once.
fn once(word: &'static str, attribute: &Attribute, seen: &mut Vec<(&'static str, Place)>) -> Result<()> {
    let place = whole(attribute);
    let earlier = seen.iter().find(|(found, _)| *found == word).map(|(_, place)| *place);
    seen.push((word, place));
    let advice = match word {
        "coordinates" => "list all coordinates in one: `#[coordinates(x, y)]`",
        "lagrangian" => "a system has one Lagrangian: write it as one sum",
        "dissipation" => "a system has one dissipation function: write it as one sum",
        "lagrange" => "put all options into one",
        _ => return Ok(()),
    };
    let Some(earlier) = earlier else { return Ok(()) };
    let mut error = place.error(format!("`#[{word}(…)]` is given twice: {advice}"));
    error.combine(earlier.error("the first one is here"));
    Err(error)
}

fn read(declaration: &mut Declaration, word: &str, attribute: &Attribute) -> Result<()> {
    let mut cursor = content(word, attribute)?;
    let cursor = &mut cursor;
    match word {
        "coordinates" => declaration.coordinates = coordinates(cursor)?,
        "define" => declaration.defines.push(define(cursor)?),
        "function" => declaration.functions.push(function(cursor)?),
        "lagrangian" => declaration.lagrangian = Some(only(cursor)?),
        "constraint" => declaration.constraints.push(constraint(cursor)?),
        "force" => declaration.forces.push(force(cursor)?),
        "dissipation" => declaration.dissipation = Some(only(cursor)?),
        "observable" | "conserved" => observable(word, cursor, &mut declaration.observables)?,
        "parameter" => declaration.parameters.push(parameter(cursor)?),
        _ => options(cursor, &mut declaration.options)?,
    }
    Ok(())
}

fn form(word: &str) -> &'static str {
    match word {
        "coordinates" => "#[coordinates(x, y)]",
        "define" => "#[define(name = expression)]",
        "function" => "#[function(U(r))]` or `#[function(Omega(t): [3] = field)]",
        "lagrangian" => "#[lagrangian(expression)]",
        "constraint" => "#[constraint(name: expression = expression)]",
        "force" => "#[force(coordinate: expression)]",
        "dissipation" => "#[dissipation(expression)]",
        "observable" => "#[observable(name = expression)]",
        "conserved" => "#[conserved(name = expression)]",
        "parameter" => "#[parameter(name: [3])]` or `#[parameter(name: 0..1)]",
        _ => "#[lagrange(crate = path, scalar = T)]",
    }
}

/// The tokens between the attribute's parentheses, of which there are some.
fn content(word: &str, attribute: &Attribute) -> Result<Cursor> {
    match &attribute.meta {
        Meta::List(list) if matches!(list.delimiter, MacroDelimiter::Paren(_)) && !list.tokens.is_empty() => {
            Ok(Cursor::new(list.tokens.clone(), list.delimiter.span().close()))
        }
        _ => Err(whole(attribute).error(format!("this attribute is written `{}`", form(word)))),
    }
}

/// A trailing comma, and then nothing.
fn finish(cursor: &mut Cursor, word: &str) -> Result<()> {
    cursor.take_punct(',');
    if cursor.is_empty() {
        return Ok(());
    }
    Err(cursor.error(format!("expected the end of the attribute: write `{}`, once for each", form(word))))
}

fn only(cursor: &mut Cursor) -> Result<Expression> {
    let mut inside = cursor.until_comma();
    reject_name_of_whole(&inside)?;
    let expression = expression::whole(&mut inside)?;
    if !cursor.is_empty() {
        return Err(cursor.error(
            "expected one expression, without commas (a thousand is written `1_000`, a vector `[a, b]`)",
        ));
    }
    Ok(expression)
}

/// `L = …`
fn reject_name_of_whole(cursor: &Cursor) -> Result<()> {
    match (cursor.peek(), cursor.follower()) {
        (Some(TokenTree::Ident(name)), Some(TokenTree::Punct(sign))) if sign.as_char() == '=' => {
            Err(cursor.pair_place().error(format!("write the expression alone: leave out `{name} =`")))
        }
        _ => Ok(()),
    }
}

fn coordinates(cursor: &mut Cursor) -> Result<Vec<Coordinate>> {
    let mut coordinates = Vec::new();
    while !cursor.is_empty() {
        let name = cursor.name("the name of a coordinate")?;
        let length = if cursor.take_punct(':') { Some(brackets(cursor)?) } else { None };
        coordinates.push(Coordinate { name, length });
        if cursor.is_punct('=') {
            return Err(cursor.error("a coordinate gets its value at the start from a `State`, not here"));
        }
        if !cursor.is_empty() {
            cursor.expect_punct(',', "expected `,` between coordinates (a vector is written `r: [3]`)")?;
        }
    }
    reject_too_many(&coordinates)?;
    Ok(coordinates)
}

/// The mass matrix alone has the square of their number as entries.
fn reject_too_many(coordinates: &[Coordinate]) -> Result<()> {
    let mut count = 0;
    for coordinate in coordinates {
        count += coordinate.length.unwrap_or(1);
        if count > COORDINATE_LIMIT {
            return Err(coordinate.name.place.error(format!(
                "a system has at most {COORDINATE_LIMIT} coordinates, and up to here there are {count}"
            )));
        }
    }
    Ok(())
}

/// `[3]`
fn brackets(cursor: &mut Cursor) -> Result<usize> {
    let wanted = "expected a length such as `[3]`, an integer literal";
    let Some(group) = cursor.take_group(Delimiter::Bracket) else { return Err(cursor.error(wanted)) };
    let length = expression::whole(&mut Cursor::inside(&group)).map(|length| length.kind);
    let value = match length {
        Ok(Kind::Number(value)) if value.is_integer() => usize::try_from(value.to_integer()).ok(),
        _ => None,
    };
    value
        .filter(|length| (1..=LENGTH_LIMIT).contains(length))
        .ok_or_else(|| Place::at(group.span()).error(wanted))
}

fn define(cursor: &mut Cursor) -> Result<Define> {
    let target = target(cursor, "the name of the definition")?;
    let formals = match cursor.take_group(Delimiter::Parenthesis) {
        Some(group) => Some(formals(&mut Cursor::inside(&group))?),
        None => None,
    };
    equals(cursor, "define")?;
    let body = expression::whole(&mut cursor.until_comma())?;
    finish(cursor, "define")?;
    Ok(Define { target, formals, body })
}

fn function(cursor: &mut Cursor) -> Result<Function> {
    let name = cursor.name("the name of the function")?;
    let Some(group) = cursor.take_group(Delimiter::Parenthesis) else {
        return Err(cursor.error(format!("expected its arguments: write `{}`", form("function"))));
    };
    let formals = shaped_formals(&mut Cursor::inside(&group))?;
    let length = if cursor.take_punct(':') { Some(brackets(cursor)?) } else { None };
    let field = if cursor.take_punct('=') { cursor.name("the name of a field")? } else { name.clone() };
    finish(cursor, "function")?;
    Ok(Function { name, formals, length, field })
}

/// `r`, `s: [3]`
fn shaped_formals(cursor: &mut Cursor) -> Result<Vec<(Name, Option<usize>)>> {
    let mut formals: Vec<(Name, Option<usize>)> = Vec::new();
    while !cursor.is_empty() {
        let formal = cursor.name("the name of an argument")?;
        let length = if cursor.take_punct(':') { Some(brackets(cursor)?) } else { None };
        if formals.iter().any(|(earlier, _)| earlier.text == formal.text) {
            return Err(formal.place.error(format!("the argument `{}` is given twice", formal.text)));
        }
        formals.push((formal, length));
        if !cursor.is_empty() {
            cursor.expect_punct(',', "expected `,` between arguments")?;
        }
    }
    if formals.is_empty() {
        return Err(cursor.error("a function has arguments; a constant is a field"));
    }
    Ok(formals)
}

fn formals(cursor: &mut Cursor) -> Result<Vec<Name>> {
    let mut formals = Vec::new();
    while !cursor.is_empty() {
        formals.push(cursor.name("the name of an argument")?);
        if !cursor.is_empty() {
            cursor.expect_punct(',', "expected `,` between arguments")?;
        }
    }
    if formals.is_empty() {
        return Err(
            cursor.error("a function has arguments; a value is written `#[define(name = expression)]`")
        );
    }
    Ok(formals)
}

fn equals(cursor: &mut Cursor, word: &str) -> Result<()> {
    if cursor.is_pair('=', '=') {
        return Err(cursor.pair_place().error("an equation is written with one `=`"));
    }
    cursor.expect_punct('=', &format!("expected `=`: write `{}`", form(word)))
}

fn colon(cursor: &mut Cursor, word: &str) -> Result<()> {
    cursor.expect_punct(':', &format!("expected `:` after the name: write `{}`", form(word)))
}

fn constraint(cursor: &mut Cursor) -> Result<Constraint> {
    let start = cursor.place();
    let target = match target(cursor, "the name of the constraint") {
        Ok(target) if cursor.is_punct(':') => target,
        // Without a name the first thing met is the equation itself.
        _ => {
            let message =
                format!("a constraint begins with a name of one word: write `{}`", form("constraint"));
            return Err(start.error(message));
        }
    };
    colon(cursor, "constraint")?;
    let mut equation = cursor.until_comma();
    let (left, right) = sides(&mut equation)?;
    finish(cursor, "constraint")?;
    Ok(Constraint { target, left, right })
}

/// `left = right`, exactly one `=`.
fn sides(equation: &mut Cursor) -> Result<(Expression, Expression)> {
    let mut left = equation.until_equals();
    let left = expression::whole(&mut left)?;
    equals(equation, "constraint")?;
    let mut rest = equation.until_equals();
    let right = expression::whole(&mut rest)?;
    if !equation.is_empty() {
        return Err(equation.error("a constraint has one `=`: write two constraints"));
    }
    Ok((left, right))
}

fn force(cursor: &mut Cursor) -> Result<Force> {
    let wanted = format!("the coordinate that the force acts on: write `{}`", form("force"));
    let target = target(cursor, &wanted)?;
    colon(cursor, "force")?;
    let value = expression::whole(&mut cursor.until_comma())?;
    finish(cursor, "force")?;
    Ok(Force { target, value })
}

/// Even where the value is wrong there is a method of that name, which the program may call.
fn observable(word: &str, cursor: &mut Cursor, observables: &mut Vec<Named>) -> Result<()> {
    let target = target(cursor, &format!("a name: write `{}`", form(word)))?;
    if !matches!(target.index, TargetIndex::None) {
        return Err(target.name.place.error("an observable is not a family: write a vector `[a, b]`"));
    }
    let value = match equals(cursor, word) {
        Ok(()) => expression::whole(&mut cursor.until_comma()),
        Err(error) => Err(error),
    };
    let (value, result) = match value {
        Ok(value) => (value, finish(cursor, word)),
        Err(error) => (Expression { kind: Kind::Vector(Vec::new()), place: target.name.place }, Err(error)),
    };
    observables.push(Named { name: target.name, is_conserved: word == "conserved", value });
    result
}

fn parameter(cursor: &mut Cursor) -> Result<Parameter> {
    let name = cursor.name("the name of a field")?;
    colon(cursor, "parameter")?;
    let parameter = match cursor.peek() {
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Bracket => {
            Parameter { name, length: Some(brackets(cursor)?), range: None }
        }
        _ => Parameter { name, length: None, range: Some(expression::range(cursor)?) },
    };
    finish(cursor, "parameter")?;
    Ok(parameter)
}

fn options(cursor: &mut Cursor, options: &mut Options) -> Result<()> {
    while !cursor.is_empty() {
        let place = cursor.place();
        let word = cursor.take_ident().map(|ident| ident.to_string()).unwrap_or_default();
        let word = word.as_str();
        if !["crate", "scalar"].contains(&word) {
            return Err(place.error("the options are `crate = path` and `scalar = T`"));
        }
        equals(cursor, "lagrange")?;
        let value = cursor.until_comma().rest();
        let given = if word == "crate" { options.runtime.is_some() } else { options.scalar.is_some() };
        if given {
            return Err(place.error(format!("`{word}` is given twice")));
        }
        let wrong = |message: &'static str| move |_| place.error(message);
        match word {
            "crate" => {
                let path: syn::Path = syn::parse2(value)
                    .map_err(wrong("a path belongs here: write `crate = path`, without quotation marks"))?;
                options.runtime = Some(path.into_token_stream());
            }
            _ => {
                let wrong = wrong("a type belongs here: write `scalar = f32`");
                options.scalar = Some(syn::parse2(value).map_err(wrong)?);
            }
        }
    }
    Ok(())
}
