//! Operator precedence: decides where a formula needs parentheses.

use num_traits::{One, Signed};

use super::formula::Formula;
use crate::symbolic::Rational;

/// Precedence of a formula. A formula of lower precedence than its context requires needs parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Binding {
    Sum,
    Product,
    Power,
    Atom,
}

impl Binding {
    /// Precedence of a formula; `is_flat` if it is written on a single line of text.
    pub(super) fn of(formula: &Formula, is_flat: bool) -> Self {
        match formula {
            Formula::Number(value) if value.is_negative() => Self::Sum,
            Formula::Negative(_) | Formula::Sum(_) => Self::Sum,
            Formula::Product(..) | Formula::SumOver { .. } | Formula::SumWhere { .. } => Self::Product,
            Formula::Call(name, _) => match name.as_str() {
                "dot" | "cross" | "der" => Self::Product,
                // `sin x` is a factor, but not the base of a power.
                name if PREFIX.contains(&name) => Self::Power,
                _ => Self::Atom,
            },
            Formula::Partial { arguments, .. } if arguments.is_empty() => match is_flat {
                true => Self::Product,
                false => Self::Power,
            },
            Formula::Power(..) => Self::Power,
            Formula::Root(_) if is_flat => Self::Power,
            Formula::Number(value) if !value.denom().is_one() => Self::Power,
            Formula::Scaled(_) => Self::Power,
            // A further index would run into the index of the entry.
            Formula::Entry(..) if !is_flat => Self::Power,
            _ => Self::Atom,
        }
    }
}

/// Functions written without parentheses before a single name.
pub(super) const PREFIX: [&str; 8] = ["sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "ln"];

/// Returns whether a formula is a function written as a name before its argument.
pub(super) fn is_prefixed(formula: &Formula) -> bool {
    match formula {
        Formula::Call(name, arguments) => PREFIX.contains(&name.as_str()) && arguments.len() == 1,
        _ => false,
    }
}

/// Exponent written at the name of a function, as in sin² x. Negative ones are excluded: sin⁻¹ would be the inverse.
pub(super) fn exponent_at_name(base: &Formula, exponent: &Formula) -> Option<Rational> {
    match exponent {
        Formula::Number(value) if is_prefixed(base) && value.is_integer() && value.is_positive() => {
            Some(*value)
        }
        _ => None,
    }
}

/// Returns whether a formula begins with a function, as `sin x` and `sin² x` do: it then ends a bare argument before
/// it.
pub(super) fn begins_with_function(formula: &Formula) -> bool {
    match formula {
        Formula::Power(base, exponent) => exponent_at_name(base, exponent).is_some(),
        other => is_prefixed(other),
    }
}
