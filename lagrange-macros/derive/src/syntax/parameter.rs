//! Parser of `#[parameter(…)]`, which states the shape, range, property or members of a field.

use proc_macro2::{Delimiter, TokenTree};
use syn::Result;

use super::cursor::Cursor;
use super::declaration::{Fact, Parameter};
use super::expression;
use super::field::{Inside, Layout, Property};
use super::forms::{any_lengths, colon, finish, form, lengths};
use super::structure::{Member, MemberShape, Structure, numbers};

const MEMBER: &str = "a member is a number `m`, or says what it is: `c: [3]`, `A: [3, 3]`, `I: symmetric`, `R: rotation`, `q: quaternion`, `place: pose`, or a struct again, `tip: {m, c: [3]}`";

pub(super) fn parameter(cursor: &mut Cursor) -> Result<Parameter> {
    let name = cursor.name("the name of a field")?;
    colon(cursor, "parameter")?;
    let fact = match cursor.peek() {
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
            Fact::Struct(structure(cursor, Vec::new())?)
        }
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Bracket => {
            let mut behind = cursor.clone();
            behind.next();
            match is_brace(&behind) {
                true => {
                    let lengths = lengths(cursor)?;
                    Fact::Struct(structure(cursor, lengths)?)
                }
                false => Fact::Shape(any_lengths(cursor)?),
            }
        }
        Some(TokenTree::Ident(_)) => Fact::Property(property(cursor)?),
        _ => {
            let (low, high) = expression::range(cursor)?;
            Fact::Range(low, high)
        }
    };
    finish(cursor, "parameter")?;
    Ok(Parameter { name, fact })
}

fn property(cursor: &mut Cursor) -> Result<Property> {
    let place = cursor.place();
    match cursor.take_ident().map(|ident| ident.to_string()).as_deref() {
        Some("symmetric") => Ok(Property::Symmetric),
        Some("rotation") => Ok(Property::Rotation),
        _ => Err(place.error(format!(
            "a matrix is `symmetric` or a `rotation`, and of other fields there is a shape or a range: write `{}`",
            form("parameter")
        ))),
    }
}

fn is_brace(cursor: &Cursor) -> bool {
    matches!(cursor.peek(), Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace)
}

/// Reads `{m, c: [3], I: symmetric}`.
fn structure(cursor: &mut Cursor, lengths: Vec<usize>) -> Result<Structure> {
    let Some(group) = cursor.take_group(Delimiter::Brace) else { return Err(cursor.error(MEMBER)) };
    let (mut inside, mut members) = (Cursor::inside(&group), Vec::<Member>::new());
    while !inside.is_empty() {
        let member = member(&mut inside)?;
        if let Some(known) = members.iter().find(|known| known.name.text == member.name.text) {
            let message = format!("the member `{}` is given twice", member.name.text);
            return Err(member.name.place.error_beside(message, known.name.place, "the first one is here"));
        }
        members.push(member);
        if !inside.is_empty() {
            inside.expect_punct(',', &format!("expected `,` between members: {MEMBER}"))?;
        }
    }
    if members.is_empty() {
        return Err(inside.error(format!("expected the members that expressions use: {MEMBER}")));
    }
    Ok(Structure { lengths, members })
}

fn member(cursor: &mut Cursor) -> Result<Member> {
    let mut token = cursor.clone();
    let name = cursor.name("the name of a member")?;
    let Some(ident) = token.take_ident() else { return Err(cursor.error(MEMBER)) };
    let shape = if cursor.take_punct(':') { member_shape(cursor)? } else { numbers(Layout::array([])) };
    Ok(Member { name, ident, shape })
}

fn member_shape(cursor: &mut Cursor) -> Result<MemberShape> {
    let place = cursor.place();
    if is_brace(cursor) {
        return structure(cursor, Vec::new()).map(MemberShape::Struct);
    }
    if let Some(word) = cursor.take_ident() {
        let matrix = |property| MemberShape::Numbers(Layout::matrix(3, 3), Some(property));
        return match word.to_string().as_str() {
            "symmetric" => Ok(matrix(Property::Symmetric)),
            "rotation" => Ok(matrix(Property::Rotation)),
            "quaternion" => Ok(numbers(Layout::quaternion(Inside::UnitQuaternion))),
            "pose" => Ok(MemberShape::Struct(Structure::pose(
                word.span(),
                Layout::quaternion(Inside::UnitQuaternion),
            ))),
            _ => Err(place.error(MEMBER)),
        };
    }
    let lengths = match cursor.peek() {
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Bracket => lengths(cursor)?,
        _ => return Err(place.error(MEMBER)),
    };
    match lengths[..] {
        _ if is_brace(cursor) => structure(cursor, lengths).map(MemberShape::Struct),
        [length] => Ok(numbers(Layout::array([length]))),
        [rows, columns] => Ok(numbers(Layout::matrix(rows, columns))),
        _ => Err(place.error(MEMBER)),
    }
}
