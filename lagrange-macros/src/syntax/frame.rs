//! Frames: what each is in, and how it lies there.

use proc_macro2::{Delimiter, TokenTree};
use syn::Result;

use super::cursor::Cursor;
use super::declaration::{Constraint, Coordinate, Declaration, Frame};
use super::expression::{self, Expression, Kind};
use super::forms::form;
use super::name::Name;
use super::target::{Target, TargetIndex, target};
use crate::symbolic::Rational;

/// `name in parent: step, step`
pub(super) fn frame(cursor: &mut Cursor, definitions: usize) -> Result<Frame> {
    let target = target(cursor, &format!("the name of the frame: write `{}`", form("frame")))?;
    let parent = if cursor.take_word("in") { Some(parent(cursor)?) } else { None };
    cursor.expect_punct(
        ':',
        &format!("expected `:` and how the frame lies in the one that it is in: `{}`", form("frame")),
    )?;
    let mut steps = Vec::new();
    while !cursor.is_empty() {
        let mut step = cursor.until_comma();
        let written = step.clone();
        steps.push(expression::whole(&mut step).map_err(|error| unseparated(&written).unwrap_or(error))?);
    }
    if steps.is_empty() {
        return Err(cursor
            .error(format!("expected how the frame lies in the one that it is in: `{}`", form("frame"))));
    }
    Ok(Frame { target, parent, steps, definitions })
}

/// `rotate_z(x) translate(v)`
fn unseparated(step: &Cursor) -> Option<syn::Error> {
    let mut step = step.clone();
    step.take_ident()?;
    step.take_group(Delimiter::Parenthesis)?;
    let is_name = matches!(step.peek(), Some(TokenTree::Ident(_)));
    is_name.then(|| step.error("expected `,` between the steps of a frame"))
}

/// `ground` or `link[i-1]`
fn parent(cursor: &mut Cursor) -> Result<Expression> {
    let name = cursor.name("the frame that it is in")?;
    let place = name.place;
    let base = Expression { kind: Kind::Name(name), place };
    let Some(brackets) = cursor.take_group(Delimiter::Bracket) else { return Ok(base) };
    let index = expression::whole(&mut Cursor::inside(&brackets))?;
    let place = place.to(cursor.last_place());
    Ok(Expression { kind: Kind::Index(Box::new(base), Box::new(index)), place })
}

/// dot(q, q) = 1 of each coordinate that frames are turned by as a quaternion.
pub(super) fn unit_constraints(declaration: &Declaration) -> Vec<Constraint> {
    let steps = declaration.frames.iter().flat_map(|frame| &frame.steps);
    let mut found: Vec<Constraint> = Vec::new();
    for q in steps.filter_map(turned_by) {
        let is_quaternion =
            |coordinate: &Coordinate| coordinate.name.text == q.text && coordinate.length == Some(4);
        let is_new = found.iter().all(|known| known.target.name.text != q.text);
        if is_new && declaration.coordinates.iter().any(is_quaternion) {
            found.push(unit_constraint(q));
        }
    }
    found
}

/// `q` of `rotate(q)`
fn turned_by(step: &Expression) -> Option<&Name> {
    match &step.kind {
        Kind::Call(name, arguments) if name.text == "rotate" => match &arguments[..] {
            [Expression { kind: Kind::Name(q), .. }] => Some(q),
            _ => None,
        },
        _ => None,
    }
}

fn unit_constraint(q: &Name) -> Constraint {
    let at = |kind| Expression { kind, place: q.place };
    let factor = at(Kind::Name(q.clone()));
    let dot = Name { text: "dot".to_owned(), place: q.place };
    Constraint {
        target: Target { name: q.clone(), index: TargetIndex::None },
        left: at(Kind::Call(dot, vec![factor.clone(), factor])),
        right: at(Kind::Number(Rational::from_integer(1).into())),
        is_implied: true,
    }
}
