//! Collects errors, each with its source location, so that all are reported together.

use std::fmt::Display;

use proc_macro2::{Span, TokenStream, TokenTree};
use quote::ToTokens;
use syn::Error;

use crate::symbolic::{Fault, Graph};

/// Source range, from the first to the last token of a construct.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    start: Span,
    end: Span,
}

impl Place {
    pub(crate) fn at(span: Span) -> Self {
        Self { start: span, end: span }
    }

    /// Returns the range that covers all tokens.
    pub(crate) fn of(tokens: impl ToTokens) -> Self {
        let mut places = tokens.into_token_stream().into_iter().map(|token| Self::at(token.span()));
        let first = places.next().unwrap_or(Self::at(Span::call_site()));
        first.to(places.last().unwrap_or(first))
    }

    pub(crate) fn to(self, last: Self) -> Self {
        Self { start: self.start, end: last.end }
    }

    pub(crate) fn start(self) -> Span {
        self.start
    }

    /// Creates an error that underlines the whole range.
    pub(crate) fn error(self, message: impl Display) -> Error {
        let [first, last] = [self.start, self.end].map(|span| {
            let mut token = TokenTree::from(proc_macro2::Punct::new('.', proc_macro2::Spacing::Alone));
            token.set_span(span);
            token
        });
        Error::new_spanned([first, last].into_iter().collect::<TokenStream>(), message)
    }

    /// Creates an error with a note at a related place.
    pub(crate) fn error_beside(self, message: impl Display, other: Self, note: impl Display) -> Error {
        let mut error = self.error(message);
        error.combine(other.error(note));
        error
    }
}

/// Errors collected so far.
#[derive(Debug, Default)]
pub(crate) struct Diagnostics {
    errors: Vec<Error>,
}

impl Diagnostics {
    pub(crate) fn push(&mut self, error: Error) {
        self.errors.push(error);
    }

    pub(crate) fn error(&mut self, place: Place, message: impl Display) {
        self.push(place.error(message));
    }

    /// Returns the value. Records an error and returns `None`.
    pub(crate) fn note<T>(&mut self, result: Result<T, Error>) -> Option<T> {
        result.map_err(|error| self.push(error)).ok()
    }

    /// Records a pending arithmetic fault of the graph as an error at `place` and returns `None`. A fault is an
    /// overflow, a division by zero or an expression that grew too large in a derivative.
    pub(crate) fn stop_at_fault(&mut self, place: Place, graph: &mut Graph) -> Option<()> {
        let Some(fault) = graph.take_fault() else { return Some(()) };
        self.error(place, format!("in the derivatives of this: {}", fault_message(fault)));
        None
    }

    /// Number of errors so far.
    pub(crate) fn count(&self) -> usize {
        self.errors.len()
    }

    /// Forgets all errors but the first `count`: those of an attempt for which there is another way.
    pub(crate) fn forget_after(&mut self, count: usize) {
        self.errors.truncate(count);
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    pub(crate) fn into_errors(self) -> Vec<Error> {
        self.errors
    }
}

pub(crate) fn fault_message(fault: Fault) -> &'static str {
    match fault {
        Fault::Overflow => {
            "a number here is beyond the range of f64 (1e-308 to 1e308): make one of the constants a field"
        }
        Fault::DivisionByZero => "this divides by zero",
        Fault::TooLarge => "the expression grows beyond a million nodes here",
    }
}
