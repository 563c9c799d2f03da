//! Names and their equality.

use crate::diagnostics::Place;

/// Identifier without `r#`, in the Unicode normal form in which rustc compares identifiers.
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

/// Converts to Unicode normalization form C. rustc does this for identifiers; the fallback of proc-macro2 does not.
pub(crate) fn normal_form(text: &str) -> String {
    use unicode_normalization::UnicodeNormalization;
    text.nfc().collect()
}
