//! Parser of expressions, by precedence climbing.
//!
//! Sums and products are flat lists. Only parentheses, indices, calls, signs and powers nest.

use proc_macro2::{Delimiter, Group, TokenTree};
use syn::Result;

use super::cursor::{Cursor, NESTING_LIMIT};
use super::name::Name;
use super::number::number;
use super::slips::{reject_adjacent, reject_keyword, unexpected};
use crate::diagnostics::Place;
use crate::symbolic::Scaled;

/// Expression with its source location.
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
    Number(Scaled),
    Name(Name),
    Index(Box<Expression>, Box<Expression>),
    /// `base[from..to]`
    Slice(Box<Slice>),
    /// `base.member`
    Member(Box<Expression>, Name),
    Call(Name, Vec<Expression>),
    /// `sum(index in from..to, body)`
    SumOver(Box<SumOver>),
    Negative(Box<Expression>),
    Sum(Vec<(Sign, Expression)>),
    Product(Vec<(Operator, Expression)>),
    Power(Box<Expression>, Box<Expression>),
    Vector(Vec<Expression>),
}

/// `base[from..to]`
#[derive(Clone, Debug)]
pub(crate) struct Slice {
    pub(crate) base: Expression,
    pub(crate) from: Expression,
    pub(crate) to: Expression,
}

/// `sum(index in from..to, body)`
#[derive(Clone, Debug)]
pub(crate) struct SumOver {
    pub(crate) index: Name,
    pub(crate) from: Expression,
    pub(crate) to: Expression,
    pub(crate) body: Expression,
}

/// Reads an expression up to the end of the tokens.
pub(super) fn whole(cursor: &mut Cursor) -> Result<Expression> {
    let expression = sum(cursor, 0)?;
    if cursor.is_empty() { Ok(expression) } else { Err(unexpected(cursor)) }
}

/// Reads `from..to`.
pub(super) fn range(cursor: &mut Cursor) -> Result<(Expression, Expression)> {
    let from = sum(cursor, 0)?;
    Ok((from, end_of_range(cursor, 0)?))
}

/// Reads `..to`.
fn end_of_range(cursor: &mut Cursor, depth: usize) -> Result<Expression> {
    let dots = cursor.place();
    if !(cursor.take_punct('.') && cursor.take_punct('.')) {
        return Err(dots.error("expected a range such as `0..3`"));
    }
    if cursor.is_punct('=') {
        return Err(dots.to(cursor.place()).error("ranges are half-open: write `0..3` for 0, 1, 2"));
    }
    if cursor.is_empty() {
        return Err(cursor.error("a range says where it ends: write `0..3` for 0, 1, 2"));
    }
    sum(cursor, depth)
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

/// Returns the element of a list of one, else a node of all elements.
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
    loop {
        let start = expression.place;
        let kind = if let Some(brackets) = cursor.take_group(Delimiter::Bracket) {
            depth = deeper(cursor, depth)?;
            in_brackets(&brackets, expression, depth)?
        } else if has_members(&expression)
            && let Some(member) = cursor.take_member()
        {
            depth = deeper(cursor, depth)?;
            Kind::Member(Box::new(expression), Name::new(&member))
        } else {
            break;
        };
        expression = Expression { kind, place: start.to(cursor.last_place()) };
    }
    suffix_after_index(cursor, &expression)?;
    Ok(expression)
}

/// `base[index]` or `base[from..to]`
fn in_brackets(brackets: &Group, base: Expression, depth: usize) -> Result<Kind> {
    let mut inside = Cursor::inside(brackets);
    let index = sum(&mut inside, depth)?;
    let to = inside.is_punct('.').then(|| end_of_range(&mut inside, depth)).transpose()?;
    if !inside.is_empty() {
        return Err(inside.error("one index a bracket: write `a[i][j]`"));
    }
    Ok(match to {
        Some(to) => Kind::Slice(Box::new(Slice { base, from: index, to })),
        None => Kind::Index(Box::new(base), Box::new(index)),
    })
}

fn has_members(base: &Expression) -> bool {
    matches!(base.kind, Kind::Name(_) | Kind::Index(..) | Kind::Member(..))
}

/// Reports `r[0]_dot`, which the tokenizer splits into `r[0] _dot`.
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
            let kind = Kind::Number(number(literal, place)?);
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

/// Reads parentheses, a vector, or the invisible group around tokens that `macro_rules` substitutes.
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

impl Expression {
    /// Returns the terms of a sum; for any other expression, the expression itself.
    pub(crate) fn terms(&self) -> Vec<(Sign, &Self)> {
        match &self.kind {
            Kind::Sum(terms) => terms.iter().map(|(sign, term)| (*sign, term)).collect(),
            _ => vec![(Sign::Plus, self)],
        }
    }

    /// Returns an entry of a vector literal.
    pub(crate) fn entry(&self, index: usize) -> Option<&Self> {
        match &self.kind {
            Kind::Vector(entries) => entries.get(index),
            _ => None,
        }
    }

    /// Calls `visit` with every name that the expression uses.
    pub(crate) fn names(&self, visit: &mut impl FnMut(&Name)) {
        if let Kind::Name(name) | Kind::Call(name, _) = &self.kind {
            visit(name);
        }
        self.parts().into_iter().for_each(|part| part.names(visit));
    }

    /// Calls `visit` with every name that is used without an index.
    pub(crate) fn whole_names(&self, visit: &mut impl FnMut(&Name)) {
        match &self.kind {
            Kind::Name(name) => visit(name),
            Kind::Index(base, index) if matches!(base.kind, Kind::Name(_)) => index.whole_names(visit),
            _ => self.parts().into_iter().for_each(|part| part.whole_names(visit)),
        }
    }

    /// Calls `visit` with the index of every `sum` in the expression.
    pub(crate) fn indices(&self, visit: &mut impl FnMut(&Name)) {
        if let Kind::SumOver(sum) = &self.kind {
            visit(&sum.index);
        }
        self.parts().into_iter().for_each(|part| part.indices(visit));
    }

    /// Splits `x`, `x[0]` or `x[i][j]` into a name and its indices. `None` for any other expression.
    pub(crate) fn element(&self) -> Option<(&Name, Vec<&Self>)> {
        let (mut base, mut indices) = (self, Vec::new());
        while let Kind::Index(inner, index) = &base.kind {
            indices.insert(0, &**index);
            base = inner;
        }
        match &base.kind {
            Kind::Name(name) => Some((name, indices)),
            _ => None,
        }
    }

    /// Returns the direct subexpressions.
    pub(crate) fn parts(&self) -> Vec<&Self> {
        match &self.kind {
            Kind::Number(_) | Kind::Name(_) => Vec::new(),
            Kind::Negative(inner) | Kind::Member(inner, _) => vec![inner],
            Kind::Index(first, second) | Kind::Power(first, second) => vec![first, second],
            Kind::Call(_, items) | Kind::Vector(items) => items.iter().collect(),
            Kind::SumOver(sum) => vec![&sum.from, &sum.to, &sum.body],
            Kind::Slice(slice) => vec![&slice.base, &slice.from, &slice.to],
            Kind::Sum(terms) => terms.iter().map(|(_, term)| term).collect(),
            Kind::Product(factors) => factors.iter().map(|(_, factor)| factor).collect(),
        }
    }
}
