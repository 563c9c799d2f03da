//! A formula for readers: names, fractions, powers. It is built from the user's [input](mod@super::written) or from the
//! [graph](mod@super::derived), and written by a [`notation`](super::notation).

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
    /// Entry of a formula that is not a name.
    Entry(Box<Self>, Box<Self>),
    /// Range of an index, `to` excluded. In a slice, the index has no name.
    Running {
        index: Option<String>,
        from: Box<Self>,
        to: Box<Self>,
    },
    /// Multiplier λ of the constraint with this name.
    Multiplier(String),
    Negative(Box<Self>),
    Sum(Vec<Self>),
    /// Factors of the numerator, and of the denominator.
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
    /// Σ over all values of an index of which an equation holds, such as j ≠ i.
    SumWhere {
        condition: Box<[Self; 2]>,
        sign: &'static str,
        body: Box<Self>,
    },
    Vector(Vec<Self>),
    /// Transpose of a matrix.
    Transpose(Box<Self>),
    /// Derivative of a function of one argument, evaluated at an argument.
    Derivative {
        function: Box<Self>,
        order: usize,
        argument: Box<Self>,
    },
    /// Partial derivative, evaluated at these arguments; the list is empty if they are clear from the context.
    Partial {
        function: Box<Self>,
        by: Vec<Self>,
        arguments: Vec<Self>,
    },
}

impl Formula {
    /// Parses the flat name of a coordinate, such as `r[2]`, with a number of dots, or of a parameter, such as
    /// `link[2].c[0]`.
    pub(super) fn labelled(text: &str, dots: usize) -> Self {
        if let Some((of, member)) = text.rsplit_once('.') {
            return Self::Member(Box::new(Self::labelled(of, 0)), Box::new(Self::labelled(member, dots)));
        }
        let (base, mut rest) = text.split_at(text.find('[').unwrap_or(text.len()));
        let mut indices = Vec::new();
        while let Some(end) = closing(rest) {
            indices.push(Self::index(&rest[1..end]));
            rest = &rest[end + 1..];
        }
        Self::Name { base: base.to_owned(), dots, indices }
    }

    /// A name with one more dot.
    pub(super) fn dotted(self) -> Option<Self> {
        match self {
            Self::Name { base, dots: dots @ 0..=1, indices } => {
                Some(Self::Name { base, dots: dots + 1, indices })
            }
            _ => None,
        }
    }

    /// Parses an index: `2`, `i`, `n - 1 - i`, `2*i`, `bond[i][0]`.
    pub(super) fn index(text: &str) -> Self {
        let signs = [(" + ", false), (" - ", true)];
        let last = signs.iter().filter_map(|&(sign, minus)| Some((text.rfind(sign)?, sign, minus))).max();
        if let Some((place, sign, minus)) = last.filter(|(place, ..)| closing_is_behind(text, *place)) {
            let before = Self::index(&text[..place]);
            return Self::sum(vec![before, Self::index(&text[place + sign.len()..]).signed(minus)]);
        }
        if let Some((one, other)) = text.split_once('*') {
            return Self::Product(vec![Self::index(one), Self::index(other)], Vec::new());
        }
        match text.parse::<i128>() {
            Ok(number) => Self::Number(Rational::from_integer(number)),
            Err(_) => Self::labelled(text, 0),
        }
    }

    /// Element of this formula at an index.
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

    /// Parts that the formula is composed of.
    fn parts(&self) -> Vec<&Self> {
        match self {
            Self::Number(_) | Self::Scaled(_) | Self::Pi | Self::Multiplier(_) => Vec::new(),
            Self::Name { indices, .. } => indices.iter().collect(),
            Self::Member(one, other) | Self::Entry(one, other) | Self::Power(one, other) => vec![one, other],
            Self::Running { from, to, .. } => vec![from, to],
            Self::Negative(inner) | Self::Root(inner) | Self::Transpose(inner) => vec![inner],
            Self::Sum(all) | Self::Vector(all) | Self::Call(_, all) => all.iter().collect(),
            Self::Product(above, below) => above.iter().chain(below).collect(),
            Self::SumOver { from, to, body, .. } => vec![from, to, body],
            Self::SumWhere { condition, body, .. } => vec![&condition[0], &condition[1], body],
            Self::Derivative { function, argument, .. } => vec![function, argument],
            Self::Partial { function, by, arguments } => {
                std::iter::once(&**function).chain(by).chain(arguments).collect()
            }
        }
    }

    /// Returns whether the velocity of a coordinate stands in the formula.
    pub(super) fn has_velocity(&self) -> bool {
        matches!(self, Self::Name { dots: 1, .. }) || self.parts().into_iter().any(Self::has_velocity)
    }

    pub(super) fn contains(&self, formula: &Self) -> bool {
        let of_multiplier = |name: &String| Self::labelled(name, 0).contains(formula);
        self == formula
            || self.parts().into_iter().any(|part| part.contains(formula))
            || matches!(self, Self::Multiplier(name) if of_multiplier(name))
    }

    /// Returns whether a name stands in the formula, by itself or with indices behind its own.
    pub(super) fn has_name(&self, name: &Self) -> bool {
        let is_it = match (self, name) {
            (Self::Name { base, indices, .. }, Self::Name { base: own, indices: first, .. }) => {
                base == own && indices.starts_with(first)
            }
            _ => false,
        };
        is_it || self.parts().into_iter().any(|part| part.has_name(name))
    }

    /// Returns whether an element of an array stands in the formula by its number, as `r[2]`.
    pub(super) fn has_numbered_element(&self) -> bool {
        let is_number = |index: &Self| matches!(index, Self::Number(_));
        let is_it = match self {
            Self::Name { indices, .. } => indices.iter().any(is_number),
            Self::Entry(_, index) => is_number(index),
            Self::Multiplier(name) | Self::Call(name, _) => name.ends_with(']'),
            _ => false,
        };
        is_it || self.parts().into_iter().any(Self::has_numbered_element)
    }

    /// True if a term is a product with a sum whose terms differ in their degree in the velocities, as w (2 ẏ + w x).
    pub(super) fn mixes_degrees(&self) -> bool {
        match self {
            Self::Sum(terms) => terms.iter().any(Self::mixes_degrees),
            Self::Negative(inner) => inner.mixes_degrees(),
            Self::Product(above, _) => above.iter().any(Self::is_mixed),
            other => other.is_mixed(),
        }
    }

    fn is_mixed(&self) -> bool {
        match self {
            Self::Power(base, _) => base.is_mixed(),
            Self::Sum(terms) => terms.iter().any(|term| term.speeds() != terms[0].speeds()),
            _ => false,
        }
    }

    /// Degree of a term in the velocities that are visible in it.
    fn speeds(&self) -> Rational {
        match self {
            Self::Name { dots: 1, .. } => Rational::one(),
            Self::Negative(inner) => inner.speeds(),
            Self::Product(above, _) => above.iter().map(Self::speeds).sum(),
            Self::Power(base, exponent) => match **exponent {
                Self::Number(exponent) => base.speeds() * exponent,
                _ => Rational::zero(),
            },
            Self::Sum(terms) => terms.iter().map(Self::speeds).max().unwrap_or_default(),
            Self::Call(_, arguments) => arguments.iter().map(Self::speeds).sum(),
            _ => Rational::zero(),
        }
    }

    /// Sum of the parts, flattened into one list of terms.
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

    /// Number of terms.
    pub(super) fn terms(&self) -> usize {
        if let Self::Sum(terms) = self { terms.len() } else { 1 }
    }

    /// Returns whether the formula begins with a minus sign.
    pub(super) fn is_negative(&self) -> bool {
        match self {
            Self::Number(value) => value.is_negative(),
            Self::Negative(_) => true,
            _ => false,
        }
    }

    /// Sign of the formula (true for minus), and its magnitude.
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

    /// Formula of a number. Many zeros before or after the digits become a power of ten.
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

    /// Product number · above / below.
    pub(super) fn product(number: Scaled, mut above: Vec<Self>, mut below: Vec<Self>) -> Self {
        let Scaled { mut fraction, exponent } = number;
        // p²/(2 m) instead of ½ p²/m.
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

/// Place of the bracket that closes the one at the beginning of the text.
fn closing(text: &str) -> Option<usize> {
    let mut open = 0;
    text.char_indices().find_map(|(place, sign)| {
        open += match sign {
            '[' => 1,
            ']' => -1,
            _ => 0,
        };
        (open == 0 && sign == ']').then_some(place)
    })
}

/// True if a place of the text is in no brackets.
fn closing_is_behind(text: &str, place: usize) -> bool {
    text[..place].matches('[').count() == text[..place].matches(']').count()
}
