//! Frames: the parent of each, and its pose in the parent.

use proc_macro2::{Delimiter, TokenTree};
use syn::Result;

use super::cursor::Cursor;
use super::declaration::{Constraint, Declaration, FrameDeclaration, Law};
use super::expression::{self, Expression, Kind};
use super::forms::form;
use super::name::Name;
use super::target::{Target, TargetIndex, target};
use crate::symbolic::Rational;

/// Reads `name in parent: step, step`.
pub(super) fn frame(cursor: &mut Cursor, definitions: usize) -> Result<FrameDeclaration> {
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
    Ok(FrameDeclaration { target, parent, steps, definitions })
}

/// Reports steps without a comma between them, as in `rotate_z(x) translate(v)`.
fn unseparated(step: &Cursor) -> Option<syn::Error> {
    let mut step = step.clone();
    step.take_ident()?;
    step.take_group(Delimiter::Parenthesis)?;
    let is_name = matches!(step.peek(), Some(TokenTree::Ident(_)));
    is_name.then(|| step.error("expected `,` between the steps of a frame"))
}

/// Reads the parent: `ground`, `link[i-1]` or `leg[i][0]`.
fn parent(cursor: &mut Cursor) -> Result<Expression> {
    let name = cursor.name("the frame that it is in")?;
    let place = name.place;
    let mut parent = Expression { kind: Kind::Name(name), place };
    while let Some(brackets) = cursor.take_group(Delimiter::Bracket) {
        let index = expression::whole(&mut Cursor::inside(&brackets))?;
        let place = place.to(cursor.last_place());
        parent = Expression { kind: Kind::Index(Box::new(parent), Box::new(index)), place };
    }
    Ok(parent)
}

/// Returns dot(q, q) = 1 for each quaternion coordinate that rotates a frame, and for each row of an array of
/// quaternions.
pub(super) fn unit_constraints(declaration: &Declaration) -> Vec<Constraint> {
    let steps = declaration.frames.iter().flat_map(|frame| &frame.steps);
    let mut found: Vec<Constraint> = Vec::new();
    for (q, indices) in steps.filter_map(turned_by) {
        let coordinate = declaration.coordinates.iter().find(|coordinate| coordinate.name.text == q.text);
        let is_new = found.iter().all(|known| known.target.name.text != q.text);
        match coordinate.map(|coordinate| &coordinate.lengths[..]) {
            Some([rows @ .., 4]) if is_new && rows.len() == indices => found.push(unit_constraint(q, rows)),
            _ => {}
        }
    }
    found
}

/// Returns `q` and the number of indices of `rotate(q)`, `rotate(q[i])` and so on.
fn turned_by(step: &Expression) -> Option<(&Name, usize)> {
    match &step.kind {
        Kind::Call(name, arguments) if name.text == "rotate" => match &arguments[..] {
            [q] => q.element().map(|(q, indices)| (q, indices.len())),
            _ => None,
        },
        _ => None,
    }
}

/// Builds `q[i in 0..rows]: dot(q[i], q[i]) = 1`.
fn unit_constraint(q: &Name, rows: &[usize]) -> Constraint {
    let at = |kind| Expression { kind, place: q.place };
    let number = |value: usize| at(Kind::Number(Rational::from_integer(value as i128).into()));
    let name = |text: &str| Name { text: text.to_owned(), place: q.place };
    // Choose an index name that differs from the coordinate, which it would shadow.
    let letter = if q.text.starts_with('i') { 'k' } else { 'i' };
    let names: Vec<Name> =
        (0..rows.len()).map(|level| name(&format!("{letter}{}", "'".repeat(level)))).collect();
    let factor = names.iter().fold(at(Kind::Name(q.clone())), |base, index| {
        at(Kind::Index(Box::new(base), Box::new(at(Kind::Name(index.clone())))))
    });
    let indices = names.into_iter().zip(rows);
    let indices =
        indices.map(|(index, &row)| TargetIndex::Family { index, from: number(0), to: number(row) });
    Constraint {
        target: Target { name: q.clone(), indices: indices.collect() },
        left: at(Kind::Call(name("dot"), vec![factor.clone(), factor])),
        right: number(1),
        is_implied: true,
        when: None,
        law: Law::Equation,
    }
}
