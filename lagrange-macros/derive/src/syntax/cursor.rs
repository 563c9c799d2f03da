//! Token cursor over one attribute.

use proc_macro2::{Delimiter, Group, Ident, Spacing, Span, TokenStream, TokenTree};
use syn::{Error, Result};

use super::name::Name;
use crate::diagnostics::Place;

/// Maximum nesting depth of parentheses, operators and powers. Bounds the recursion of the parser.
pub(crate) const NESTING_LIMIT: usize = 256;

/// Returns the first group nested deeper than [`NESTING_LIMIT`]. Avoids recursion, because the input may nest
/// arbitrarily deep.
pub(crate) fn too_deep(tokens: TokenStream) -> Option<Span> {
    let mut levels = vec![tokens.into_iter()];
    while let Some(level) = levels.last_mut() {
        match level.next() {
            Some(TokenTree::Group(group)) if levels.len() >= NESTING_LIMIT => return Some(group.span_open()),
            Some(TokenTree::Group(group)) => levels.push(group.stream().into_iter()),
            Some(_) => {}
            None => {
                levels.pop();
            }
        }
    }
    None
}

/// Truncates each group that nests too deep to its first token, so that the remaining tokens can be parsed.
pub(crate) fn shallow(tokens: TokenStream) -> TokenStream {
    let cut = |token: TokenTree| match token {
        TokenTree::Group(group) if too_deep(group.stream()).is_some() => {
            Group::new(group.delimiter(), group.stream().into_iter().take(1).collect()).into()
        }
        token => token,
    };
    tokens.into_iter().map(cut).collect()
}

/// Position in a sequence of tokens.
#[derive(Clone)]
pub(super) struct Cursor {
    tokens: Vec<TokenTree>,
    position: usize,
    end: Span,
}

impl Cursor {
    /// Starts at the first of `tokens`. Errors about a missing token at the end point to `end`.
    pub(super) fn new(tokens: TokenStream, end: Span) -> Self {
        Self { tokens: tokens.into_iter().collect(), position: 0, end }
    }

    /// Starts inside the delimiters of a group.
    pub(super) fn inside(group: &Group) -> Self {
        Self::new(group.stream(), group.span_close())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.position >= self.tokens.len()
    }

    pub(super) fn peek(&self) -> Option<&TokenTree> {
        self.tokens.get(self.position)
    }

    /// Returns the token after the next one.
    pub(super) fn follower(&self) -> Option<&TokenTree> {
        self.tokens.get(self.position + 1)
    }

    pub(super) fn next(&mut self) -> Option<TokenTree> {
        let token = self.tokens.get(self.position).cloned();
        self.position += 1;
        token
    }

    /// Location of the next token, or of the end.
    pub(super) fn place(&self) -> Place {
        Place::at(self.peek().map_or(self.end, TokenTree::span))
    }

    /// Returns the last token read.
    pub(super) fn last(&self) -> Option<&TokenTree> {
        self.position.checked_sub(1).and_then(|last| self.tokens.get(last))
    }

    /// Location of the last token read.
    pub(super) fn last_place(&self) -> Place {
        Place::at(self.last().map_or(self.end, TokenTree::span))
    }

    /// Location of the next two tokens, which form an operator.
    pub(super) fn pair_place(&self) -> Place {
        let second = self.follower().map_or(self.end, TokenTree::span);
        self.place().to(Place::at(second))
    }

    pub(super) fn error(&self, message: impl std::fmt::Display) -> Error {
        self.place().error(message)
    }

    pub(super) fn is_punct(&self, symbol: char) -> bool {
        matches!(self.peek(), Some(TokenTree::Punct(punct)) if punct.as_char() == symbol)
    }

    /// True if the next two tokens form the operator `first` `second`.
    pub(super) fn is_pair(&self, first: char, second: char) -> bool {
        let joint = |token: Option<&TokenTree>| matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == first && punct.spacing() == Spacing::Joint);
        let then = |token: Option<&TokenTree>| matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == second);
        joint(self.peek()) && then(self.follower())
    }

    pub(super) fn take_punct(&mut self, symbol: char) -> bool {
        let found = self.is_punct(symbol);
        self.position += usize::from(found);
        found
    }

    pub(super) fn take_word(&mut self, word: &str) -> bool {
        let found = matches!(self.peek(), Some(TokenTree::Ident(ident)) if ident == word);
        self.position += usize::from(found);
        found
    }

    pub(super) fn take_ident(&mut self) -> Option<Ident> {
        match self.peek() {
            Some(TokenTree::Ident(ident)) => {
                let ident = ident.clone();
                self.position += 1;
                Some(ident)
            }
            // An identifier that `macro_rules` substitutes for `$name:ident` may come in an invisible group.
            Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::None => {
                let mut inside = Self::inside(group);
                let ident = inside.take_ident().filter(|_| inside.is_empty())?;
                self.position += 1;
                Some(ident)
            }
            _ => None,
        }
    }

    /// Reads `.m` and returns `m`. Returns `None` for a method call.
    pub(super) fn take_member(&mut self) -> Option<Ident> {
        match self.tokens.get(self.position..)? {
            [_, _, TokenTree::Group(group), ..] if group.delimiter() == Delimiter::Parenthesis => None,
            [TokenTree::Punct(point), TokenTree::Ident(member), ..] if point.as_char() == '.' => {
                let member = member.clone();
                self.position += 2;
                Some(member)
            }
            _ => None,
        }
    }

    /// Reads a name, or returns an error that says what was expected.
    pub(super) fn name(&mut self, wanted: &str) -> Result<Name> {
        let Some(ident) = self.take_ident() else { return Err(self.error(format!("expected {wanted}"))) };
        let name = Name::new(&ident);
        // Keywords that cannot become identifiers even with `r#`.
        if ["_", "self", "Self", "super", "crate"].contains(&name.text.as_str()) {
            return Err(name.place.error(format!("`{}` is no name: expected {wanted}", name.text)));
        }
        Ok(name)
    }

    pub(super) fn take_group(&mut self, delimiter: Delimiter) -> Option<Group> {
        match self.peek() {
            Some(TokenTree::Group(group)) if group.delimiter() == delimiter => {
                let group = group.clone();
                self.position += 1;
                Some(group)
            }
            _ => None,
        }
    }

    /// Consumes the token `symbol`, or returns an error with `message`.
    pub(super) fn expect_punct(&mut self, symbol: char, message: &str) -> Result<()> {
        if self.take_punct(symbol) { Ok(()) } else { Err(self.error(message)) }
    }

    /// Consumes the tokens up to and including the next comma outside of parentheses. Returns them without the comma.
    pub(super) fn until_comma(&mut self) -> Self {
        let part = self.until(|cursor| cursor.is_punct(','));
        self.take_punct(',');
        part
    }

    /// Consumes and returns the tokens up to the next `=`.
    pub(super) fn until_equals(&mut self) -> Self {
        self.until(|cursor| cursor.is_punct('='))
    }

    /// Skips this many tokens.
    pub(super) fn skip(&mut self, count: usize) {
        self.position += count;
    }

    /// Moves to the next token where `stop` is true, or to the end.
    pub(super) fn find(mut self, stop: impl Fn(&Self) -> bool) -> Self {
        self.until(stop);
        self
    }

    /// Consumes and returns the tokens before the next one where `stop` is true.
    pub(super) fn until(&mut self, stop: impl Fn(&Self) -> bool) -> Self {
        let start = self.position;
        while !self.is_empty() && !stop(self) {
            self.position += 1;
        }
        let end = self.place().start();
        Self { tokens: self.tokens[start..self.position].to_vec(), position: 0, end }
    }

    /// Returns the remaining tokens.
    pub(super) fn rest(mut self) -> TokenStream {
        self.tokens.split_off(self.position.min(self.tokens.len())).into_iter().collect()
    }
}
