//! Cells of a line: quoted texts, and lists of numbers as JSON.

use core::fmt::{self, Display, Formatter};

use crate::number::Real;

/// Splits a line at its commas. Quoted cells keep their quotes. `None` if text follows a closing quote, or if a quote is not
/// closed: the line was cut off.
pub(super) fn split(line: &str) -> Option<Vec<&str>> {
    let (mut cells, mut rest) = (Vec::new(), line);
    loop {
        let end = match rest.strip_prefix('"') {
            Some(inner) => closing(inner)? + 2,
            None => rest.find(',').unwrap_or(rest.len()),
        };
        let (cell, after) = rest.split_at(end);
        cells.push(cell);
        match after.strip_prefix(',') {
            Some(next) => rest = next,
            None => return after.is_empty().then_some(cells),
        }
    }
}

/// Position of the closing quote; a quote in the text is doubled.
fn closing(text: &str) -> Option<usize> {
    let mut from = 0;
    loop {
        let at = from + text[from..].find('"')?;
        if !text[at + 1..].starts_with('"') {
            return Some(at);
        }
        from = at + 2;
    }
}

/// The text as a quoted cell.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

/// Text of a quoted cell; `None` if the cell is not quoted.
pub(super) fn unquoted(cell: &str) -> Option<String> {
    let inner = cell.strip_prefix('"')?.strip_suffix('"')?;
    Some(inner.replace("\"\"", "\""))
}

/// Writes control characters as `\u000a`, and `\` and the characters of `also` with a `\` before them: a cell contains no
/// line break.
pub(super) fn escaped(text: &str, also: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            c if c.is_control() => escaped += &format!("\\u{:04x}", u32::from(c)),
            c => escaped.extend((c == '\\' || also.contains(c)).then_some('\\').into_iter().chain([c])),
        }
    }
    escaped
}

/// The text that [`escaped`] wrote; `None` for other escapes.
pub(super) fn unescaped(text: &str) -> Option<String> {
    let (mut plain, mut rest) = (String::with_capacity(text.len()), text);
    while let Some(at) = rest.find('\\') {
        plain += &rest[..at];
        rest = &rest[at + 1..];
        let (c, length) = match rest.chars().next()? {
            'u' => (char::from_u32(u32::from_str_radix(rest.get(1..5)?, 16).ok()?)?, 5),
            c => (c, c.len_utf8()),
        };
        plain.push(c);
        rest = &rest[length..];
    }
    Some(plain + rest)
}

/// A number in JSON. NaN is `null`, and an infinity is a number too large for its type.
pub(super) struct Number<T>(pub(super) T);

impl<T: Real> Display for Number<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0.to_f64() {
            x if x.is_nan() => f.write_str("null"),
            f64::INFINITY => f.write_str("1e999"),
            f64::NEG_INFINITY => f.write_str("-1e999"),
            // `Debug` prints the fewest digits that read back to the same number.
            _ => write!(f, "{:?}", self.0),
        }
    }
}

/// Lists of equal length, each under its name, as an object of JSON: `{"t":[0.0,1.0],"x":[0.5,0.25]}`.
#[derive(Default)]
pub(super) struct Lists(String);

impl Lists {
    pub(super) fn push<D: Display>(&mut self, name: &str, items: impl IntoIterator<Item = D>) {
        self.0 += if self.0.is_empty() { "{" } else { "," };
        self.0 += &format!("{}:[", text(name));
        for (k, item) in items.into_iter().enumerate() {
            self.0 += if k == 0 { "" } else { "," };
            self.0 += &item.to_string();
        }
        self.0.push(']');
    }

    /// The object as a quoted cell.
    pub(super) fn cell(self) -> String {
        quoted(&(self.0 + "}"))
    }
}

/// The text as a string of JSON.
pub(super) fn text(text: &str) -> String {
    format!("\"{}\"", escaped(text, "\""))
}

/// The text of a string of JSON.
pub(super) fn read_text(token: &str) -> Option<String> {
    unescaped(token.strip_prefix('"')?.strip_suffix('"')?)
}

/// Names and lists of an object of JSON; the items are numbers and strings as they are written.
pub(super) fn read_lists(object: &str) -> Option<Vec<(String, Vec<&str>)>> {
    let (mut lists, mut rest) = (Vec::new(), object.strip_prefix('{')?);
    loop {
        let (name, mut after) = token(rest)?;
        let mut items = Vec::new();
        after = after.strip_prefix(":[")?;
        loop {
            let (item, next) = token(after)?;
            items.push(item);
            match next.strip_prefix(',') {
                Some(next) => after = next,
                None => break after = next.strip_prefix(']')?,
            }
        }
        lists.push((read_text(name)?, items));
        match after.strip_prefix(',') {
            Some(next) => rest = next,
            None => return (after == "}").then_some(lists),
        }
    }
}

/// The first number or string, and what follows it.
fn token(text: &str) -> Option<(&str, &str)> {
    let Some(inner) = text.strip_prefix('"') else { return text.split_at_checked(text.find([',', ']'])?) };
    let mut is_escaped = false;
    let end = inner.find(|c| {
        let is_end = c == '"' && !is_escaped;
        is_escaped = c == '\\' && !is_escaped;
        is_end
    })?;
    text.split_at_checked(end + 2)
}
