//! Left side of a definition, constraint or force: a name, an element or an indexed family.

use proc_macro2::Delimiter;
use syn::Result;

use super::cursor::Cursor;
use super::expression::{self, Expression, Kind};
use super::name::Name;

/// `name`, `name[0]`, `name[i in 1..10]` or `name[i in 0..3, j in 0..i]`, equivalent to `name[i in 0..3][j in 0..i]`.
#[derive(Clone, Debug)]
pub(crate) struct Target {
    pub(crate) name: Name,
    pub(crate) indices: Vec<TargetIndex>,
}

#[derive(Clone, Debug)]
pub(crate) enum TargetIndex {
    Element(Expression),
    Family { index: Name, from: Expression, to: Expression },
}

impl Target {
    /// Target without indices.
    pub(super) fn whole(name: Name) -> Self {
        Self { name, indices: Vec::new() }
    }

    /// True if the target has indices.
    pub(crate) fn is_family(&self) -> bool {
        !self.indices.is_empty()
    }
}

pub(super) fn target(cursor: &mut Cursor, wanted: &str) -> Result<Target> {
    let mut target = Target::whole(cursor.name(wanted)?);
    while let Some(brackets) = cursor.take_group(Delimiter::Bracket) {
        let mut inside = Cursor::inside(&brackets);
        target.indices.push(target_index(&mut inside.until_comma())?);
        while !inside.is_empty() {
            target.indices.push(target_index(&mut inside.until_comma())?);
        }
    }
    Ok(target)
}

fn target_index(cursor: &mut Cursor) -> Result<TargetIndex> {
    if let Some(index) = running(cursor)? {
        if !cursor.is_empty() {
            return Err(cursor.error("expected the end of the range"));
        }
        return Ok(index);
    }
    let (start, first) = (cursor.place(), cursor.clone().take_ident());
    match (expression::whole(cursor), first) {
        (Ok(Expression { kind: Kind::Name(_), .. }) | Err(_), Some(index)) => {
            Err(start.error(format!("a family is written `name[{index} in 0..3]`")))
        }
        (index, _) => index.map(TargetIndex::Element),
    }
}

/// Reads a range such as `i in 0..3`; `None` if the next tokens are none.
pub(super) fn running(cursor: &mut Cursor) -> Result<Option<TargetIndex>> {
    let mut ahead = cursor.clone();
    let Some(ident) = ahead.take_ident().filter(|_| ahead.take_word("in")) else { return Ok(None) };
    let (from, to) = expression::range(&mut ahead)?;
    *cursor = ahead;
    Ok(Some(TargetIndex::Family { index: Name::new(&ident), from, to }))
}
