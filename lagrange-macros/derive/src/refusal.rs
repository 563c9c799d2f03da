//! Errors of a declaration, for use outside of a compiler.

use std::error::Error;
use std::fmt::{self, Display, Formatter};
use std::ops::Range;

use proc_macro2::{LexError, Span};
use unicode_normalization::char::is_combining_mark;

/// Errors of a declaration: at least one, and all that can be found together.
///
/// `Display` writes each error as `line:column: message`, above the line of the source and carets under the tokens at
/// fault.
///
/// ```
/// use lagrange_derive::System;
///
/// let text = "#[coordinates(theta)]
/// #[lagrangian(theta_dot^2/2 + cos(thta))]
/// struct Pendulum;";
/// let refusal = System::parse(text).unwrap_err();
/// let diagnostic = &refusal.diagnostics()[0];
/// assert_eq!(diagnostic.message(), "nothing is called `thta`: did you mean `theta`?");
/// let location = diagnostic.location().unwrap();
/// assert_eq!((location.line, location.column, &*location.text), (2, 34, "thta"));
/// assert_eq!(&text[location.bytes.clone()], "thta");
///
/// assert_eq!(refusal.to_string(), "\
/// 2:34: nothing is called `thta`: did you mean `theta`?
/// #[lagrangian(theta_dot^2/2 + cos(thta))]
///                                  ^^^^");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    diagnostics: Vec<Diagnostic>,
    /// Text that the tokens come from, if it is known.
    source: Option<String>,
}

/// An error: a message, and the tokens at fault.
///
/// `Display` writes `line:column: message`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    message: String,
    location: Option<Location>,
    notes: Vec<Self>,
}

/// Range of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// Bytes of the range, counted from the start of the text.
    pub bytes: Range<usize>,
    /// Line of the first character; the first line is 1.
    pub line: usize,
    /// Column of the first character, in characters; the first column is 1.
    pub column: usize,
    /// Characters of the range; more than one line if the construct is.
    pub text: String,
}

const OPENING: [char; 3] = ['(', '[', '{'];
const CLOSING: [char; 3] = [')', ']', '}'];

/// Signs of mathematics, with advice.
const SIGNS: [(&str, &str); 9] = [
    ("²", "write `^2`"),
    ("³", "write `^3`"),
    ("½", "write `1/2*`"),
    ("−–—", "write `-`"),
    ("×⋅∙", "write `*`"),
    ("÷∕⁄", "write `/`"),
    ("√", "write `sqrt(…)`"),
    ("≥", "write `>=`"),
    ("'’′", "write `x_dot` for the velocity of a coordinate `x`"),
];

impl Refusal {
    /// Returns the errors, in the order in which they were found.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    pub(crate) fn new(errors: Vec<syn::Error>, source: Option<&str>) -> Self {
        let diagnostics = errors.into_iter().map(Diagnostic::new).collect();
        Self { diagnostics, source: source.map(str::to_owned) }
    }

    /// Refusal of a text that is no sequence of tokens.
    pub(crate) fn of_text(source: &str, error: &LexError) -> Self {
        let start = error.span().byte_range().start;
        let found = source[start..].chars().next();
        let diagnostics = match found {
            Some('(' | '[' | '{') => {
                vec![Diagnostic::in_text(source, start, "this is never closed".to_owned())]
            }
            Some(sign @ (')' | ']' | '}')) => vec![Diagnostic::of_delimiter(source, start, sign)],
            _ => match Diagnostic::of_signs(source) {
                signs if signs.is_empty() => {
                    vec![Diagnostic::in_text(source, start, "no token of Rust begins here".to_owned())]
                }
                signs => signs,
            },
        };
        Self { diagnostics, source: Some(source.to_owned()) }
    }
}

impl Diagnostic {
    /// Returns what is wrong, and what to write instead.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Returns the place of the tokens at fault; `None` if they come from no text.
    pub fn location(&self) -> Option<&Location> {
        self.location.as_ref()
    }

    /// Returns notes at related places, such as the first of two definitions of a name.
    pub fn notes(&self) -> &[Self] {
        &self.notes
    }

    fn in_text(source: &str, start: usize, message: String) -> Self {
        Self { message, location: Some(Location::in_text(source, start)), notes: Vec::new() }
    }

    /// A delimiter that closes nothing, or not what was opened last.
    fn of_delimiter(source: &str, start: usize, sign: char) -> Self {
        let mut open = Vec::new();
        for (at, c) in source[..start].char_indices() {
            match c {
                '(' | '[' | '{' => open.push((at, c)),
                ')' | ']' | '}' => _ = open.pop(),
                _ => {}
            }
        }
        let Some((at, opening)) = open.pop() else {
            return Self::in_text(source, start, "this closes nothing that is open".to_owned());
        };
        let closing = CLOSING[OPENING.iter().position(|c| *c == opening).unwrap_or(0)];
        let message = format!("either a `{closing}` is missing before this `{sign}`, or it is one too many");
        let note = Self::in_text(source, at, format!("this `{opening}` is open until then"));
        Self { notes: vec![note], ..Self::in_text(source, start, message) }
    }

    /// All signs of mathematics that are no tokens, each with what is written for it.
    fn of_signs(source: &str) -> Vec<Self> {
        let signs = source.char_indices().filter_map(|(at, c)| {
            let (_, instead) = SIGNS.iter().find(|(signs, _)| signs.contains(c))?;
            Some(Self::in_text(source, at, format!("instead of `{c}`, {instead}")))
        });
        signs.collect()
    }

    fn new(error: syn::Error) -> Self {
        let mut all = error.into_iter().map(|error| Self {
            message: error.to_string(),
            location: Location::of(error.span()),
            notes: Vec::new(),
        });
        let first = all.next().expect("an error has a message");
        Self { notes: all.collect(), ..first }
    }
}

impl Location {
    fn of(span: Span) -> Option<Self> {
        let text = span.source_text()?;
        let start = span.start();
        Some(Self { bytes: span.byte_range(), line: start.line, column: start.column + 1, text })
    }

    /// Location of the character of `text` that begins at byte `start`.
    fn in_text(text: &str, start: usize) -> Self {
        let (before, after) = text.split_at(start);
        let found: String = after.chars().take(1).collect();
        Self {
            bytes: start..start + found.len(),
            line: before.matches('\n').count() + 1,
            column: before.chars().rev().take_while(|&c| c != '\n').count() + 1,
            text: found,
        }
    }

    /// Writes the line of the source in which the range begins, and carets under the range.
    fn underline(&self, source: &str, f: &mut Formatter<'_>) -> fmt::Result {
        let line = source.lines().nth(self.line - 1).unwrap_or_default();
        write!(f, "\n{line}\n")?;
        // A mark above a letter takes no place of its own.
        let letters = |text: &str| text.chars().filter(|&c| !is_combining_mark(c)).collect::<Vec<_>>();
        let before: String = line.chars().take(self.column - 1).collect();
        for c in letters(&before) {
            f.write_str(if c == '\t' { "\t" } else { " " })?;
        }
        let mut lines = self.text.lines();
        let carets = lines.next().map_or(0, |line| letters(line).len()).max(1);
        write!(f, "{}{}", "^".repeat(carets), if lines.next().is_some() { " …" } else { "" })
    }
}

impl Display for Diagnostic {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if let Some(Location { line, column, .. }) = &self.location {
            write!(f, "{line}:{column}: ")?;
        }
        f.write_str(&self.message)
    }
}

impl Display for Refusal {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let all =
            self.diagnostics.iter().flat_map(|diagnostic| [diagnostic].into_iter().chain(&diagnostic.notes));
        for (number, diagnostic) in all.enumerate() {
            let separator = if number == 0 { "" } else { "\n\n" };
            write!(f, "{separator}{diagnostic}")?;
            if let (Some(location), Some(source)) = (&diagnostic.location, &self.source) {
                location.underline(source, f)?;
            }
        }
        Ok(())
    }
}

impl Error for Refusal {}
