//! From tokens to a [`Declaration`]: what the user wrote, without asking what it means.

mod attribute;
mod cursor;
mod declaration;
mod expression;
mod field;
mod forms;
mod number;
mod slips;
mod target;
mod unread;

pub(crate) use attribute::declaration;
pub(crate) use cursor::{NESTING_LIMIT, shallow, too_deep};
pub(crate) use declaration::{Constraint, Coordinate, Declaration, Define, Function, Parameter};
pub(crate) use expression::{Expression, Kind, Operator, Sign, SumOver};
pub(crate) use field::{Field, FieldShape, LENGTH_LIMIT, Layout};
pub(crate) use target::{Target, TargetIndex};

use crate::diagnostics::Place;

/// An identifier: `r#` stripped, in the normal form in which rustc compares identifiers.
#[derive(Clone, Debug)]
pub(crate) struct Name {
    pub(crate) text: String,
    pub(crate) place: Place,
}

impl Name {
    fn new(ident: &proc_macro2::Ident) -> Self {
        let text = ident.to_string();
        Self { text: normal_form(text.strip_prefix("r#").unwrap_or(&text)), place: Place::at(ident.span()) }
    }
}

/// Unicode normalization form C, which rustc applies to identifiers and proc-macro2's fallback does not.
pub(crate) fn normal_form(text: &str) -> String {
    use unicode_normalization::UnicodeNormalization;
    text.nfc().collect()
}
