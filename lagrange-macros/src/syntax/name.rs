//! Names, and when two are the same.

use crate::diagnostics::Place;

/// An identifier: `r#` stripped, in the normal form in which rustc compares identifiers.
#[derive(Clone, Debug)]
pub(crate) struct Name {
    pub(crate) text: String,
    pub(crate) place: Place,
}

impl Name {
    pub(super) fn new(ident: &proc_macro2::Ident) -> Self {
        let text = ident.to_string();
        Self { text: normal_form(text.strip_prefix("r#").unwrap_or(&text)), place: Place::at(ident.span()) }
    }
}

/// Unicode normalization form C, which rustc applies to identifiers and proc-macro2's fallback does not.
pub(crate) fn normal_form(text: &str) -> String {
    use unicode_normalization::UnicodeNormalization;
    text.nfc().collect()
}
