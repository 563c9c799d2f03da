//! The expressions of the language, by precedence climbing.
//!
//! Sums and products are lists, so that only parentheses, signs and powers nest.

use proc_macro2::{Delimiter, Group, Literal, TokenTree};
use syn::Result;

use super::Name;
use super::cursor::{Cursor, NESTING_LIMIT};
use crate::diagnostics::Place;
use crate::symbolic::{Rational, parse_decimal};

/// An expression and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Expression {
    pub(crate) kind: Kind,
    pub(crate) place: Place,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Sign {
    Plus,
    Minus,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Operator {
    Times,
    Over,
}

#[derive(Clone, Debug)]
pub(crate) enum Kind {
    Number(Rational),
    Name(Name),
    Index(Box<Expression>, Box<Expression>),
    Call(Name, Vec<Expression>),
    /// `sum(index in from..to, body)`
    SumOver(Box<SumOver>),
    Negative(Box<Expression>),
    Sum(Vec<(Sign, Expression)>),
    Product(Vec<(Operator, Expression)>),
    Power(Box<Expression>, Box<Expression>),
    Vector(Vec<Expression>),
}

/// `sum(index in from..to, body)`
#[derive(Clone, Debug)]
pub(crate) struct SumOver {
    pub(crate) index: Name,
    pub(crate) from: Expression,
    pub(crate) to: Expression,
    pub(crate) body: Expression,
}

/// An expression that is all of what is left.
pub(super) fn whole(cursor: &mut Cursor) -> Result<Expression> {
    let expression = sum(cursor, 0)?;
    if cursor.is_empty() { Ok(expression) } else { Err(unexpected(cursor)) }
}

/// `from..to`, where the dots have not been read yet.
pub(super) fn range(cursor: &mut Cursor) -> Result<(Expression, Expression)> {
    let from = sum(cursor, 0)?;
    let dots = cursor.place();
    if !(cursor.take_punct('.') && cursor.take_punct('.')) {
        return Err(dots.error("expected a range such as `0..3`"));
    }
    if cursor.is_punct('=') {
        return Err(dots.to(cursor.place()).error("ranges are half-open: write `0..3` for 0, 1, 2"));
    }
    Ok((from, sum(cursor, 0)?))
}

fn deeper(cursor: &Cursor, depth: usize) -> Result<usize> {
    if depth < NESTING_LIMIT {
        return Ok(depth + 1);
    }
    Err(cursor.error(format!(
        "this expression nests more than {NESTING_LIMIT} deep: name parts of it with `#[define(…)]`"
    )))
}

fn sum(cursor: &mut Cursor, depth: usize) -> Result<Expression> {
    let first = product(cursor, depth)?;
    let mut terms = vec![(Sign::Plus, first)];
    loop {
        let sign = if cursor.is_punct('+') {
            Sign::Plus
        } else if cursor.is_punct('-') {
            Sign::Minus
        } else {
            break;
        };
        cursor.next();
        terms.push((sign, product(cursor, depth)?));
    }
    Ok(one_or(terms, Kind::Sum))
}

fn product(cursor: &mut Cursor, depth: usize) -> Result<Expression> {
    let first = signed(cursor, depth)?;
    let mut factors = vec![(Operator::Times, first)];
    loop {
        let operator = if cursor.is_pair('*', '*') {
            return Err(cursor.pair_place().error("a power is written `x^2`"));
        } else if cursor.is_punct('*') {
            Operator::Times
        } else if cursor.is_punct('/') {
            Operator::Over
        } else {
            break;
        };
        cursor.next();
        factors.push((operator, signed(cursor, depth)?));
    }
    Ok(one_or(factors, Kind::Product))
}

/// The only element, or all of them in one list.
fn one_or<T>(mut parts: Vec<(T, Expression)>, list: impl Fn(Vec<(T, Expression)>) -> Kind) -> Expression {
    match (parts.len(), parts.pop()) {
        (1, Some((_, only))) => only,
        (_, last) => {
            parts.extend(last);
            let place = parts[0].1.place.to(parts[parts.len() - 1].1.place);
            Expression { kind: list(parts), place }
        }
    }
}

/// A sign binds weaker than a power: `-x^2` is `-(x^2)`.
fn signed(cursor: &mut Cursor, depth: usize) -> Result<Expression> {
    let place = cursor.place();
    if cursor.is_punct('+') {
        return Err(cursor.error("there is no unary plus: leave it out"));
    }
    if !cursor.take_punct('-') {
        return power(cursor, depth);
    }
    let operand = signed(cursor, deeper(cursor, depth)?)?;
    let place = place.to(operand.place);
    Ok(Expression { kind: Kind::Negative(Box::new(operand)), place })
}

fn power(cursor: &mut Cursor, depth: usize) -> Result<Expression> {
    let base = postfix(cursor, depth)?;
    if !cursor.take_punct('^') {
        return Ok(base);
    }
    let exponent = signed(cursor, deeper(cursor, depth)?)?;
    let place = base.place.to(exponent.place);
    Ok(Expression { kind: Kind::Power(Box::new(base), Box::new(exponent)), place })
}

fn postfix(cursor: &mut Cursor, depth: usize) -> Result<Expression> {
    let mut expression = atom(cursor, depth)?;
    let mut depth = depth;
    while let Some(brackets) = cursor.take_group(Delimiter::Bracket) {
        depth = deeper(cursor, depth)?;
        let mut inside = Cursor::inside(&brackets);
        let index = sum(&mut inside, depth)?;
        if !inside.is_empty() {
            return Err(inside.error("one index a bracket: write `a[i][j]`"));
        }
        let place = expression.place.to(cursor.last_place());
        expression = Expression { kind: Kind::Index(Box::new(expression), Box::new(index)), place };
    }
    suffix_after_index(cursor, &expression)?;
    Ok(expression)
}

/// `r[0]_dot` reaches us as `r[0] _dot`.
fn suffix_after_index(cursor: &Cursor, expression: &Expression) -> Result<()> {
    let (Kind::Index(base, _), Some(TokenTree::Ident(suffix))) = (&expression.kind, cursor.peek()) else {
        return Ok(());
    };
    let (Kind::Name(name), true) = (&base.kind, suffix.to_string().starts_with('_')) else { return Ok(()) };
    Err(expression.place.to(cursor.place()).error(format!(
        "the velocity of an element is written `{}{suffix}[…]`, with the index last",
        name.text
    )))
}

fn atom(cursor: &mut Cursor, depth: usize) -> Result<Expression> {
    let place = cursor.place();
    match cursor.peek() {
        Some(TokenTree::Literal(literal)) => {
            let kind = number(literal, place)?;
            cursor.next();
            reject_adjacent(cursor)?;
            Ok(Expression { kind, place })
        }
        Some(TokenTree::Group(group)) => {
            let group = group.clone();
            cursor.next();
            grouped(cursor, &group, place, depth)
        }
        Some(TokenTree::Ident(ident)) => {
            let name = Name::new(ident);
            reject_keyword(&ident.to_string(), name.place)?;
            cursor.next();
            named(cursor, name, depth)
        }
        _ => Err(unexpected(cursor)),
    }
}

fn named(cursor: &mut Cursor, name: Name, depth: usize) -> Result<Expression> {
    let place = name.place;
    let Some(parentheses) = cursor.take_group(Delimiter::Parenthesis) else {
        return Ok(Expression { kind: Kind::Name(name), place });
    };
    let place = place.to(cursor.last_place());
    let mut inside = Cursor::inside(&parentheses);
    let depth = deeper(cursor, depth)?;
    let kind = if name.text == "sum" {
        sum_over(&mut inside, depth)?
    } else {
        Kind::Call(name, list(&mut inside, depth)?)
    };
    Ok(Expression { kind, place })
}

/// Parentheses, a vector, or the invisible group around what `macro_rules` substitutes.
fn grouped(cursor: &Cursor, group: &Group, place: Place, depth: usize) -> Result<Expression> {
    let mut inside = Cursor::inside(group);
    let depth = deeper(cursor, depth)?;
    match group.delimiter() {
        Delimiter::Parenthesis | Delimiter::None => {
            let expression = sum(&mut inside, depth)?;
            if inside.is_punct(',') {
                return Err(inside.error("a vector is written in brackets: `[a, b, c]`"));
            }
            if !inside.is_empty() {
                return Err(unexpected(&inside));
            }
            Ok(Expression {
                place: if group.delimiter() == Delimiter::None { expression.place } else { place },
                ..expression
            })
        }
        Delimiter::Bracket => Ok(Expression { kind: Kind::Vector(list(&mut inside, depth)?), place }),
        Delimiter::Brace => {
            Err(place.error("braces have no meaning here: a vector is `[a, b]`, and `( )` groups"))
        }
    }
}

fn list(cursor: &mut Cursor, depth: usize) -> Result<Vec<Expression>> {
    let mut items = Vec::new();
    while !cursor.is_empty() {
        items.push(sum(cursor, depth)?);
        if !cursor.is_empty() && !cursor.take_punct(',') {
            return Err(unexpected(cursor));
        }
    }
    Ok(items)
}

fn sum_over(cursor: &mut Cursor, depth: usize) -> Result<Kind> {
    let form = "a sum is written `sum(i in 0..3, expression)`";
    let index = cursor.name(form)?;
    if !cursor.take_word("in") {
        return Err(cursor.error(form));
    }
    let (from, to) = range(cursor)?;
    cursor.expect_punct(',', form)?;
    let body = sum(cursor, depth)?;
    cursor.take_punct(',');
    if !cursor.is_empty() {
        return Err(unexpected(cursor));
    }
    Ok(Kind::SumOver(Box::new(SumOver { index, from, to, body })))
}

fn number(literal: &Literal, place: Place) -> Result<Kind> {
    let text = literal.to_string();
    let unsigned = text.strip_prefix('-').unwrap_or(&text);
    if !unsigned.starts_with(|c: char| c.is_ascii_digit()) {
        return Err(place.error("text and characters have no meaning here: write a number or a name"));
    }
    if ["0x", "0o", "0b"].iter().any(|prefix| unsigned.starts_with(prefix)) {
        return Err(place.error("numbers are written in decimal"));
    }
    let length = number_length(unsigned);
    let (digits, suffix) = unsigned.split_at(length);
    if !suffix.is_empty() {
        return Err(place.error(suffix_message(digits, suffix)));
    }
    let value = parse_decimal(&text).ok_or_else(|| {
        place.error("this number does not fit exact arithmetic (128-bit fractions): make it a field")
    })?;
    Ok(Kind::Number(value))
}

/// How many characters of a literal are the number, as opposed to its suffix.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(|b| b.is_ascii_digit() || *b == b'_' || *b == b'.') {
            at += 1;
        }
        at
    };
    let mantissa = digits(0);
    if !matches!(bytes.get(mantissa), Some(b'e' | b'E')) {
        return mantissa;
    }
    let sign = usize::from(matches!(bytes.get(mantissa + 1), Some(b'+' | b'-')));
    let end = digits(mantissa + 1 + sign);
    if end > mantissa + 1 + sign { end } else { mantissa }
}

fn suffix_message(digits: &str, suffix: &str) -> String {
    if ["f64", "f32", "i8", "i16", "i32", "i64", "u8", "u16", "u32", "u64", "usize", "isize"]
        .contains(&suffix)
    {
        format!("numbers are exact and have no type: write `{digits}`")
    } else {
        format!("a product needs its sign: write `{digits}*{}`", suffix.trim_start_matches('_'))
    }
}

/// `2 x` or `2 (x + y)`: a product without its sign.
fn reject_adjacent(cursor: &Cursor) -> Result<()> {
    match cursor.peek() {
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis => {
            Err(cursor.error(
                "a product needs its sign: write `*` before the parenthesis (and `sin(x)^2` for a power of a function)",
            ))
        }
        _ => Ok(()),
    }
}

/// `r#loop` is a name, `loop` is not.
fn reject_keyword(ident: &str, place: Place) -> Result<()> {
    let message = match ident {
        "if" | "else" | "match" => {
            "the Lagrangian is one smooth expression: there is no branching (`abs`, `sqrt` and `tanh` may serve)"
        }
        "let" => "intermediate quantities are written `#[define(name = expression)]`",
        "self" => "fields are named without `self`",
        "true" | "false" => "there are no truth values here: an expression is a number",
        "for" | "while" | "loop" => "repetition is written `sum(i in 0..3, expression)`",
        "as" => AS,
        _ => return Ok(()),
    };
    Err(place.error(message))
}

const AS: &str = "numbers are exact and have no type: leave `as` out";

/// What to write instead of the token at the cursor, which nothing here begins or goes on with.
fn unexpected(cursor: &Cursor) -> syn::Error {
    let message = match cursor.peek() {
        None => "expected an expression",
        Some(TokenTree::Punct(punct)) => return unexpected_sign(cursor, punct.as_char()),
        Some(TokenTree::Ident(word)) if word == "as" => AS,
        Some(TokenTree::Literal(_) | TokenTree::Ident(_)) => {
            "two factors stand side by side: a product needs its sign `*`, a function its parentheses `sin(x)`"
        }
        Some(TokenTree::Group(_)) => "unexpected group: a product needs its sign `*`",
    };
    cursor.error(message)
}

fn unexpected_sign(cursor: &Cursor, sign: char) -> syn::Error {
    let message = match sign {
        '=' => {
            let place = if cursor.is_pair('=', '=') { cursor.pair_place() } else { cursor.place() };
            return place.error(
                "an equation belongs into `#[constraint(name: left = right)]`; here an expression is expected",
            );
        }
        '|' => "the absolute value is written `abs(x)`, and there is no logic here",
        '<' | '>' | '!' | '&' => {
            "there are no comparisons or logic here: expressions are smooth, and constraints are equations"
        }
        '.' => return unexpected_point(cursor),
        ':' if cursor.is_pair(':', ':') => {
            return cursor.pair_place().error("there are no paths here: write `pi`, `sin(x)`");
        }
        '%' => "there is no remainder: the expression must be smooth",
        other => return cursor.error(format!("unexpected `{other}`")),
    };
    cursor.error(message)
}

fn unexpected_point(cursor: &Cursor) -> syn::Error {
    if cursor.is_pair('.', '.') {
        return cursor.pair_place().error("a range belongs into `sum(i in 0..3, expression)`");
    }
    let message = match (cursor.last(), cursor.follower()) {
        (_, Some(TokenTree::Literal(_))) => "a number begins with a digit: write `0.5`",
        (Some(TokenTree::Literal(_)), _) => {
            "a product needs its sign, and an exponent a digit before it: write `2.0*x`, `2.0e3`"
        }
        _ => {
            "there are no methods or fields here: write `sin(x)` for `x.sin()`, `r[0]` for `r.x`, `m` for `self.m`"
        }
    };
    cursor.error(message)
}

impl Expression {
    /// The terms of a sum; of anything else, itself.
    pub(crate) fn terms(&self) -> Vec<(Sign, &Self)> {
        match &self.kind {
            Kind::Sum(terms) => terms.iter().map(|(sign, term)| (*sign, term)).collect(),
            _ => vec![(Sign::Plus, self)],
        }
    }

    /// Calls `visit` with every name that the expression uses.
    pub(crate) fn names(&self, visit: &mut impl FnMut(&Name)) {
        if let Kind::Name(name) | Kind::Call(name, _) = &self.kind {
            visit(name);
        }
        self.parts().into_iter().for_each(|part| part.names(visit));
    }

    /// Calls `visit` with the index of every `sum` in the expression.
    pub(crate) fn indices(&self, visit: &mut impl FnMut(&Name)) {
        if let Kind::SumOver(sum) = &self.kind {
            visit(&sum.index);
        }
        self.parts().into_iter().for_each(|part| part.indices(visit));
    }

    fn parts(&self) -> Vec<&Self> {
        match &self.kind {
            Kind::Number(_) | Kind::Name(_) => Vec::new(),
            Kind::Negative(inner) => vec![inner],
            Kind::Index(first, second) | Kind::Power(first, second) => vec![first, second],
            Kind::Call(_, items) | Kind::Vector(items) => items.iter().collect(),
            Kind::SumOver(sum) => vec![&sum.from, &sum.to, &sum.body],
            Kind::Sum(terms) => terms.iter().map(|(_, term)| term).collect(),
            Kind::Product(factors) => factors.iter().map(|(_, factor)| factor).collect(),
        }
    }
}
