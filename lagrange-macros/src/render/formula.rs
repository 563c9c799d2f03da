//! A formula as it is to be read: names, fractions, powers. It comes from what the user [wrote](mod@super::written) or
//! from the [graph](mod@super::derived), and goes to a [`notation`](super::notation).

use num_traits::{One, Signed, Zero};

use super::digits::decimal;
use crate::symbolic::{Rational, Scaled, finite_decimal};

#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) enum Formula {
    Number(Rational),
    /// A number with a power of ten.
    Scaled(Scaled),
    Pi,
    /// A name with dots above it and indices behind it.
    Name {
        base: String,
        dots: usize,
        indices: Vec<Self>,
    },
    /// A member of a struct: the struct, and the member's name with its indices.
    Member(Box<Self>, Box<Self>),
    /// An entry of what is no name.
    Entry(Box<Self>, Box<Self>),
    /// An index that runs from the first to before the last; of a slice it has no name.
    Running {
        index: Option<String>,
        from: Box<Self>,
        to: Box<Self>,
    },
    /// λ with the constraint's name.
    Multiplier(String),
    Negative(Box<Self>),
    Sum(Vec<Self>),
    /// Numerators over denominators.
    Product(Vec<Self>, Vec<Self>),
    Power(Box<Self>, Box<Self>),
    Root(Box<Self>),
    Call(String, Vec<Self>),
    /// Σ over an index.
    SumOver {
        index: String,
        from: Box<Self>,
        to: Box<Self>,
        body: Box<Self>,
    },
    Vector(Vec<Self>),
    /// A derivative of a function of one argument, and where it is taken.
    Derivative {
        function: Box<Self>,
        order: usize,
        argument: Box<Self>,
    },
    /// A partial derivative, and where it is taken unless that is clear.
    Partial {
        function: Box<Self>,
        by: Vec<Self>,
        arguments: Vec<Self>,
    },
}

impl Formula {
    /// `r_dot[2]`, given the flat name of a coordinate and the number of dots; or a parameter, `link[2].c[0]`.
    pub(super) fn labelled(text: &str, dots: usize) -> Self {
        if let Some((of, member)) = text.rsplit_once('.') {
            return Self::Member(Box::new(Self::labelled(of, 0)), Box::new(Self::labelled(member, dots)));
        }
        let mut parts = text.split('[');
        let base = parts.next().unwrap_or_default().to_owned();
        let indices = parts.map(|part| Self::index(part.trim_end_matches(']'))).collect();
        Self::Name { base, dots, indices }
    }

    /// p, with dots, of a coordinate.
    pub(super) fn momentum(text: &str, dots: usize) -> Self {
        Self::labelled(&format!("p_{text}"), dots)
    }

    fn index(text: &str) -> Self {
        match text.parse::<i128>() {
            Ok(number) => Self::Number(Rational::from_integer(number)),
            Err(_) => Self::Name { base: text.to_owned(), dots: 0, indices: Vec::new() },
        }
    }

    /// An element of it.
    pub(super) fn indexed(self, index: Self) -> Self {
        match self {
            Self::Name { base, dots, mut indices } => {
                indices.push(index);
                Self::Name { base, dots, indices }
            }
            Self::Member(of, member) => Self::Member(of, Box::new(member.indexed(index))),
            other => Self::Entry(Box::new(other), Box::new(index)),
        }
    }

    /// The sum of the parts, as one list of terms.
    pub(super) fn sum(parts: Vec<Self>) -> Self {
        let mut terms: Vec<Self> = Vec::new();
        for part in parts {
            match part {
                Self::Sum(inner) => terms.extend(inner),
                part => terms.push(part),
            }
        }
        match terms.len() {
            0 => Self::Number(Rational::from_integer(0)),
            1 => terms.remove(0),
            _ => Self::Sum(terms),
        }
    }

    /// Whether a minus sign stands in front of it.
    pub(super) fn is_negative(&self) -> bool {
        match self {
            Self::Number(value) => value.is_negative(),
            Self::Negative(_) => true,
            _ => false,
        }
    }

    /// Whether it is subtracted, and what.
    pub(super) fn sign_and_magnitude(&self) -> (bool, Self) {
        if self.is_negative() { (true, self.clone().negated()) } else { (false, self.clone()) }
    }

    pub(super) fn negated(self) -> Self {
        match self {
            Self::Negative(inner) => *inner,
            Self::Number(value) => Self::Number(-value),
            other => Self::Negative(Box::new(other)),
        }
    }

    pub(super) fn signed(self, negative: bool) -> Self {
        if negative { self.negated() } else { self }
    }

    /// With a power of ten where there are many zeros before or behind its digits.
    pub(super) fn number(value: Scaled) -> Self {
        const ZEROS: u32 = 12;
        let Scaled { fraction, exponent } = value;
        let is_negative = fraction.is_negative();
        let magnitude = Scaled { fraction: fraction.abs(), exponent };
        let is_long = match finite_decimal(fraction) {
            Some((digits, 0)) => !digits.is_zero() && digits % 10_i128.pow(ZEROS) == 0,
            Some((_, places)) => places > ZEROS,
            None => false,
        };
        let apart = magnitude.apart().filter(|apart| apart.exponent != 0 && (is_long || exponent != 0));
        apart.map_or(Self::Number(magnitude.fraction), Self::Scaled).signed(is_negative)
    }

    /// number · above / below
    pub(super) fn product(number: Scaled, mut above: Vec<Self>, mut below: Vec<Self>) -> Self {
        let Scaled { mut fraction, exponent } = number;
        // p²/(2 m), and not ½ p²/m.
        if !below.is_empty() && !fraction.is_integer() && decimal(fraction).is_none() {
            below.insert(0, Self::Number(Rational::from_integer(*fraction.denom())));
            fraction = Rational::from_integer(*fraction.numer());
        }
        if !fraction.abs().is_one() || exponent != 0 || above.is_empty() {
            above.insert(0, Self::number(Scaled { fraction: fraction.abs(), exponent }));
        }
        let formula = match (above.len(), below.is_empty()) {
            (1, true) => above.remove(0),
            _ => Self::Product(above, below),
        };
        formula.signed(fraction.is_negative())
    }
}
