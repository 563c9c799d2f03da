//! What stands left of a definition, a constraint or a force: a name, an element or a family.

use proc_macro2::Delimiter;
use syn::Result;

use super::cursor::Cursor;
use super::expression::{self, Expression};
use super::name::Name;

/// `name`, `name[0]` or `name[i in 1..10]`.
#[derive(Clone, Debug)]
pub(crate) struct Target {
    pub(crate) name: Name,
    pub(crate) index: TargetIndex,
}

#[derive(Clone, Debug)]
pub(crate) enum TargetIndex {
    None,
    Element(Expression),
    Family { index: Name, from: Expression, to: Expression },
}

pub(super) fn target(cursor: &mut Cursor, wanted: &str) -> Result<Target> {
    let name = cursor.name(wanted)?;
    let index = match cursor.take_group(Delimiter::Bracket) {
        None => TargetIndex::None,
        Some(brackets) => target_index(&mut Cursor::inside(&brackets))?,
    };
    Ok(Target { name, index })
}

fn target_index(cursor: &mut Cursor) -> Result<TargetIndex> {
    let start = cursor.place();
    if let Some(ident) = cursor.take_ident() {
        if cursor.take_word("in") {
            let (from, to) = expression::range(cursor)?;
            if !cursor.is_empty() {
                return Err(cursor.error("expected the end of the range"));
            }
            return Ok(TargetIndex::Family { index: Name::new(&ident), from, to });
        }
        return Err(start.error(format!("a family is written `name[{ident} in 0..3]`")));
    }
    expression::whole(cursor).map(TargetIndex::Element)
}
