//! Parsers of the attributes, one function each.

use proc_macro2::{Delimiter, Group, TokenTree};
use quote::ToTokens;
use syn::Result;

use super::cursor::Cursor;
use super::declaration::{Coordinate, Define, Force, FunctionDeclaration, Named, Options, Power};
use super::expression::{self, Expression, Kind};
use super::field::{LENGTH_LIMIT, Lengths, NOT_A_LITERAL, numbers};
use super::name::Name;
use super::target::{running, target};
use super::unread::unread;
use crate::diagnostics::Place;

/// Maximum number of coordinates. With more, rustc takes minutes and the matrices overflow the stack.
const COORDINATE_LIMIT: usize = 1000;

/// Maximum number of results of a user-supplied function: as many as there are coordinates. Each is a node of the graph that holds all
/// arguments.
const RESULT_LIMIT: usize = 1000;

/// Names of the attributes, with an example of each for error messages.
pub(super) const FORMS: [(&str, &str); 15] = [
    ("coordinates", "#[coordinates(x, y)]"),
    ("define", "#[define(name = expression)]"),
    ("function", "#[function(U(r))]` or `#[function(Omega(t): [3] = field)]"),
    ("frame", "#[frame(body in parent: translate(v), rotate_z(angle))]"),
    ("lagrangian", "#[lagrangian(expression)]"),
    ("constraint", "#[constraint(name: expression = expression)]"),
    ("contact", "#[contact(name: gap >= 0)]"),
    ("friction", "#[friction(name: velocity, sliding: force)]"),
    ("force", "#[force(coordinate: expression)]"),
    ("power", "#[power(force, velocity)]` or `#[power(i in 0..3, force, velocity)]"),
    ("dissipation", "#[dissipation(expression)]"),
    ("observable", "#[observable(name = expression)]"),
    ("conserved", "#[conserved(name = expression)]"),
    (
        "parameter",
        "#[parameter(name: [3])]`, `#[parameter(name: 0..1)]`, `#[parameter(name: symmetric)]` or `#[parameter(name: {m, c: [3]})]",
    ),
    ("lagrange", "#[lagrange(crate = path, scalar = T)]"),
];

pub(super) fn form(word: &str) -> &'static str {
    FORMS.iter().find(|(known, _)| *known == word).map_or("", |(_, form)| form)
}

/// Accepts a trailing comma and requires the end of the attribute.
pub(super) fn finish(cursor: &mut Cursor, word: &str) -> Result<()> {
    cursor.take_punct(',');
    if cursor.is_empty() {
        return Ok(());
    }
    Err(cursor.error(format!(
        "expected the end of the attribute: write `{}`, once for each or with `;` between several",
        form(word)
    )))
}

/// Reads an expression with `read`. After an error, returns a guess from the tokens, so that later stages still find
/// the names and the shape.
fn read_or_guess(
    cursor: &mut Cursor,
    read: impl FnOnce(&mut Cursor) -> Result<Expression>,
) -> (Expression, Result<()>) {
    let written = cursor.clone();
    match read(cursor) {
        Ok(value) => (value, Ok(())),
        Err(error) => (unread(written), Err(error)),
    }
}

pub(super) fn only(cursor: &mut Cursor, slot: &mut Option<Expression>) -> Result<()> {
    let (value, result) = read_or_guess(cursor, alone);
    *slot = Some(value);
    result
}

fn alone(cursor: &mut Cursor) -> Result<Expression> {
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

/// Reports a name before the expression, as in `L = …`.
fn reject_name_of_whole(cursor: &Cursor) -> Result<()> {
    match (cursor.peek(), cursor.follower()) {
        (Some(TokenTree::Ident(name)), Some(TokenTree::Punct(sign))) if sign.as_char() == '=' => {
            Err(cursor.pair_place().error(format!("write the expression alone: leave out `{name} =`")))
        }
        _ => Ok(()),
    }
}

pub(super) fn coordinates(cursor: &mut Cursor, coordinates: &mut Vec<Coordinate>) -> Result<()> {
    let mut count = 0;
    while !cursor.is_empty() {
        let name = cursor.name("the name of a coordinate")?;
        let Lengths { open, known: lengths } =
            if cursor.take_punct(':') { any_lengths(cursor)? } else { Lengths::default() };
        let coordinate = Coordinate { name, open, lengths };
        count += coordinate.count();
        reject_too_many(count, &coordinate.name)?;
        coordinates.push(coordinate);
        if cursor.is_punct('=') {
            return Err(cursor.error("a coordinate gets its value at the start from a `State`, not here"));
        }
        if !cursor.is_empty() {
            cursor.expect_punct(',', "expected `,` between coordinates (a vector is written `r: [3]`)")?;
        }
    }
    Ok(())
}

/// Limits the number of coordinates: the mass matrix has its square as entries.
fn reject_too_many(count: usize, last: &Name) -> Result<()> {
    if count <= COORDINATE_LIMIT {
        return Ok(());
    }
    Err(last.place.error(format!(
        "a system has at most {COORDINATE_LIMIT} coordinates, and up to here there are {count}"
    )))
}

/// Reads `: [3]` or `: [4, 3]`. Returns no lengths for a number, which has no colon.
fn shape(cursor: &mut Cursor) -> Result<Vec<usize>> {
    if cursor.take_punct(':') { lengths(cursor) } else { Ok(Vec::new()) }
}

const LENGTHS: &str =
    "expected a length such as `[3]`, an integer literal, or `[4, 3]` for an array of vectors";

/// Reads `[3]` or `[4, 3]`.
pub(super) fn lengths(cursor: &mut Cursor) -> Result<Vec<usize>> {
    let Lengths { open, known } = any_lengths(cursor)?;
    match open.first() {
        None => Ok(known),
        Some(Expression { place, .. }) => Err(place.error(NOT_A_LITERAL)),
    }
}

/// Reads `[3]`, `[n]`, `[n, 3]` or `[rows, columns, 3]`: lengths that are known when the program runs come first.
pub(super) fn any_lengths(cursor: &mut Cursor) -> Result<Lengths> {
    let Some(group) = cursor.take_group(Delimiter::Bracket) else { return Err(cursor.error(LENGTHS)) };
    let (mut inside, place) = (Cursor::inside(&group), Place::at(group.span()));
    let (mut open, mut known) = (Vec::new(), Vec::new());
    loop {
        let length = expression::whole(&mut inside.until_comma()).map_err(|_| place.error(LENGTHS))?;
        match &length.kind {
            Kind::Number(value) => {
                let value = value.to_integer().and_then(|value| usize::try_from(value).ok());
                known.push(value.filter(|length| *length > 0).ok_or_else(|| place.error(LENGTHS))?);
            }
            _ if has_names(&length) => match known.is_empty() {
                true => open.push(length),
                false => return Err(length.place.error(OPEN_FIRST)),
            },
            _ => return Err(length.place.error(LENGTHS)),
        }
        if inside.is_empty() {
            break;
        }
    }
    if numbers(&known) > LENGTH_LIMIT { Err(place.error(LENGTHS)) } else { Ok(Lengths { open, known }) }
}

fn has_names(expression: &Expression) -> bool {
    let mut has_names = false;
    expression.names(&mut |_| has_names = true);
    has_names
}

const OPEN_FIRST: &str =
    "a length that is known when the program runs comes first: `[n, 3]` is n vectors of 3";

/// Reads the last expression of an attribute, after its `=` or `:`.
fn last(cursor: &mut Cursor, word: &str) -> Result<Expression> {
    let value = expression::whole(&mut cursor.until_comma())?;
    finish(cursor, word)?;
    Ok(value)
}

pub(super) fn define(cursor: &mut Cursor, defines: &mut Vec<Define>) -> Result<()> {
    let target = target(cursor, "the name of the definition")?;
    let formals = match cursor.take_group(Delimiter::Parenthesis) {
        Some(group) => {
            let advice = "a value is written `#[define(name = expression)]`";
            Some(formals(&group, advice, |_, name, _| Ok(name))?)
        }
        None => None,
    };
    let (body, result) =
        read_or_guess(cursor, |cursor| equals(cursor, "define").and_then(|()| last(cursor, "define")));
    defines.push(Define { target, formals, body });
    result
}

pub(super) fn function(cursor: &mut Cursor) -> Result<FunctionDeclaration> {
    let name = cursor.name("the name of the function")?;
    let Some(group) = cursor.take_group(Delimiter::Parenthesis) else {
        return Err(cursor.error(format!("expected its arguments: write `{}`", form("function"))));
    };
    let formals = formals(&group, "a constant is a field", shaped)?;
    let lengths = shape(cursor)?;
    if numbers(&lengths) > RESULT_LIMIT {
        let message = format!("a function has at most {RESULT_LIMIT} results");
        return Err(cursor.last_place().error(message));
    }
    let field = if cursor.take_punct('=') { cursor.name("the name of a field")? } else { name.clone() };
    finish(cursor, "function")?;
    Ok(FunctionDeclaration { name, formals, lengths, field })
}

/// Reads the formal arguments of a function. `read` parses what follows each name.
fn formals<T>(
    group: &Group,
    advice: &str,
    read: impl Fn(&mut Cursor, Name, &[T]) -> Result<T>,
) -> Result<Vec<T>> {
    let (mut cursor, mut formals) = (Cursor::inside(group), Vec::new());
    while !cursor.is_empty() {
        let name = cursor.name("the name of an argument")?;
        formals.push(read(&mut cursor, name, &formals)?);
        if !cursor.is_empty() {
            cursor.expect_punct(',', "expected `,` between arguments")?;
        }
    }
    if formals.is_empty() {
        Err(cursor.error(format!("a function has arguments; {advice}")))
    } else {
        Ok(formals)
    }
}

/// Reads the lengths of an argument, as in `s: [3]`.
fn shaped(cursor: &mut Cursor, name: Name, earlier: &[(Name, Vec<usize>)]) -> Result<(Name, Vec<usize>)> {
    let lengths = shape(cursor)?;
    if earlier.iter().any(|(earlier, _)| earlier.text == name.text) {
        return Err(name.place.error(format!("the argument `{}` is given twice", name.text)));
    }
    Ok((name, lengths))
}

pub(super) fn equals(cursor: &mut Cursor, word: &str) -> Result<()> {
    if cursor.is_pair('=', '=') {
        return Err(cursor.pair_place().error("an equation is written with one `=`"));
    }
    cursor.expect_punct('=', &format!("expected `=`: write `{}`", form(word)))
}

pub(super) fn colon(cursor: &mut Cursor, word: &str) -> Result<()> {
    cursor.expect_punct(':', &format!("expected `:` after the name: write `{}`", form(word)))
}

pub(super) fn force(cursor: &mut Cursor, forces: &mut Vec<Force>) -> Result<()> {
    let wanted = format!("the coordinate that the force acts on: write `{}`", form("force"));
    let target = target(cursor, &wanted)?;
    let (value, result) =
        read_or_guess(cursor, |cursor| colon(cursor, "force").and_then(|()| last(cursor, "force")));
    forces.push(Force { target, value });
    result
}

pub(super) fn power(cursor: &mut Cursor) -> Result<Power> {
    let mut indices = Vec::new();
    while let Some(index) = running(cursor)? {
        indices.push(index);
        cursor.expect_punct(',', &format!("expected `,` and a force: write `{}`", form("power")))?;
    }
    let mut before_comma = cursor.until_comma();
    let force = expression::whole(&mut before_comma)?;
    if cursor.is_empty() {
        return Err(cursor
            .error(format!("expected the velocity that the force acts along: write `{}`", form("power"))));
    }
    let velocity = last(cursor, "power")?;
    Ok(Power { indices, force, velocity })
}

/// Reads an observable. After an error, still adds its name, because the program may call the method.
pub(super) fn observable(word: &str, cursor: &mut Cursor, observables: &mut Vec<Named>) -> Result<()> {
    let target = target(cursor, &format!("a name: write `{}`", form(word)))?;
    let (value, result) =
        read_or_guess(cursor, |cursor| equals(cursor, word).and_then(|()| last(cursor, word)));
    observables.push(Named { target, is_conserved: word == "conserved", value });
    result
}

pub(super) fn options(cursor: &mut Cursor, options: &mut Options) -> Result<()> {
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
