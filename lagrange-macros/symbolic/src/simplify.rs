//! Constructors that keep every expression in canonical form: like terms are collected, powers merged and constants
//! folded. Products are never expanded.

use num_traits::{One, Signed, Zero};

use super::graph::{External, Fault, Function, Graph, Id, Node};
use super::rational::{self, Rational, plus, times};
use super::rounded;
use super::scaled::Scaled;
use super::wide::to_f64;

impl Graph {
    pub fn add(&mut self, x: Id, y: Id) -> Id {
        self.total([x, y])
    }

    pub fn sub(&mut self, x: Id, y: Id) -> Id {
        self.sum([(x, Rational::one()), (y, -Rational::one())])
    }

    pub fn neg(&mut self, x: Id) -> Id {
        self.sum([(x, -Rational::one())])
    }

    pub fn mul(&mut self, x: Id, y: Id) -> Id {
        self.product([(x, Rational::one()), (y, Rational::one())])
    }

    pub fn div(&mut self, x: Id, y: Id) -> Id {
        self.product([(x, Rational::one()), (y, -Rational::one())])
    }

    /// `base` to a rational power.
    pub fn pow(&mut self, base: Id, exponent: Rational) -> Id {
        self.product([(base, exponent)])
    }

    pub fn square(&mut self, x: Id) -> Id {
        self.pow(x, Rational::from_integer(2))
    }

    pub fn sqrt(&mut self, x: Id) -> Id {
        self.pow(x, Rational::new_raw(1, 2))
    }

    /// `base` to any power.
    pub fn power(&mut self, base: Id, exponent: Id) -> Id {
        match self.as_number(exponent) {
            Some(exponent) => self.pow(base, exponent),
            None if base == Id::ONE => Id::ONE,
            None => self.intern(Node::Power(base, exponent)),
        }
    }

    pub fn external(&mut self, mut external: External) -> Id {
        external.derivatives.sort_unstable();
        self.intern(Node::External(Box::new(external)))
    }

    pub fn atan2(&mut self, y: Id, x: Id) -> Id {
        self.intern(Node::Atan2(y, x))
    }

    /// A constant of any magnitude.
    pub fn scaled(&mut self, value: Scaled) -> Id {
        self.sum_of([(Id::ONE, value)])
    }

    /// Σ term
    pub fn total(&mut self, terms: impl IntoIterator<Item = Id>) -> Id {
        self.sum(terms.into_iter().map(|term| (term, Rational::one())))
    }

    /// Σ x_i y_i
    pub fn dot(&mut self, x: &[Id], y: &[Id]) -> Id {
        let products: Vec<Id> = x.iter().zip(y).map(|(&x, &y)| self.mul(x, y)).collect();
        self.total(products)
    }

    /// Σ coefficient · term
    pub fn sum(&mut self, terms: impl IntoIterator<Item = (Id, Rational)>) -> Id {
        self.sum_of(terms.into_iter().map(|(term, coefficient)| (term, coefficient.into())))
    }

    fn sum_of(&mut self, terms: impl IntoIterator<Item = (Id, Scaled)>) -> Id {
        let mut flat = Vec::new();
        for (term, coefficient) in terms {
            if self.push_term(&mut flat, term, coefficient).is_none() {
                return self.fail(Fault::Overflow);
            }
        }
        match self.collected(flat) {
            None => self.fail(Fault::Overflow),
            Some(terms) => match terms[..] {
                [] => Id::ZERO,
                [(term, coefficient)] if coefficient.is_one() => term,
                [(Id::ONE, coefficient)] => self.number(coefficient),
                _ => self.intern(Node::Sum(terms.into())),
            },
        }
    }

    fn push_term(&mut self, flat: &mut Vec<(Id, Scaled)>, term: Id, coefficient: Scaled) -> Option<()> {
        let first = flat.len();
        match self.node(term) {
            Node::Number(value) => flat.push((Id::ONE, (*value).into())),
            Node::Sum(terms) => flat.extend(terms.iter().map(|&(inner, c)| (inner, c.into()))),
            _ => flat.push((term, Rational::one().into())),
        }
        for (_, c) in &mut flat[first..] {
            *c = self.roundings.times(coefficient, *c)?;
        }
        Some(())
    }

    /// Collects like terms. A coefficient that needs a power of ten passes it to the factors of its term. Sums with
    /// too many digits, such as 1 + 10⁻⁵⁰, stay two terms.
    fn collected(&mut self, flat: Vec<(Id, Scaled)>) -> Option<Vec<(Id, Rational)>> {
        let mut flat = match self.ten {
            None => flat,
            Some(_) => flat.into_iter().map(|(term, c)| self.without_tens(term, c)).collect::<Option<_>>()?,
        };
        flat.sort_unstable_by(|(x, a), (y, b)| x.cmp(y).then_with(|| b.cmp_size(a)));
        let mut merged: Vec<(Id, Scaled)> = Vec::with_capacity(flat.len());
        for (term, value) in flat {
            let start = merged.iter().rposition(|&(known, _)| known != term).map_or(0, |before| before + 1);
            let mut total = value;
            // A partial sum may be able to absorb a further coefficient of the same term.
            while let Some((place, sum)) = (start..merged.len())
                .find_map(|place| Some((place, self.roundings.plus(merged[place].1, total)?)))
            {
                merged.remove(place);
                total = sum;
            }
            merged.push((term, total));
        }
        merged.retain(|(_, value)| !value.fraction.is_zero());
        let mut terms = Vec::with_capacity(merged.len());
        let mut is_sorted = true;
        for like in merged.chunk_by(|(x, _), (y, _)| x == y) {
            for &(term, value) in like {
                let Scaled { fraction, exponent } = if like.len() == 1 { value } else { value.apart()? };
                is_sorted &= exponent == 0;
                terms.push((if exponent == 0 { term } else { self.times_ten(term, exponent) }, fraction));
            }
        }
        if !is_sorted {
            terms.sort_unstable_by_key(|&(term, _)| term);
        }
        terms.windows(2).all(|pair| pair[0].0 != pair[1].0).then_some(terms)
    }

    /// Moves a power of ten from the factors of a term to its coefficient.
    fn without_tens(&mut self, term: Id, coefficient: Scaled) -> Option<(Id, Scaled)> {
        let Node::Product(factors) = self.node(term) else { return Some((term, coefficient)) };
        let exponent = self.power_of_ten(factors);
        if exponent == 0 {
            return Some((term, coefficient));
        }
        let rest: Vec<_> = factors.iter().copied().filter(|&factor| !self.is_power_of_ten(factor)).collect();
        let tens = Scaled { fraction: Rational::one(), exponent };
        Some((self.factors_of(rest), coefficient.times(tens)?))
    }

    /// `term` · 10^`exponent`, with the power of ten as a factor.
    fn times_ten(&mut self, term: Id, exponent: i32) -> Id {
        let ten = self.integer(10);
        self.ten = Some(ten);
        let mut factors = match self.node(term) {
            Node::Product(factors) => factors.to_vec(),
            _ if term == Id::ONE => Vec::new(),
            _ => vec![(term, Rational::one())],
        };
        factors.push((ten, Rational::from_integer(exponent.into())));
        factors.sort_unstable_by_key(|&(factor, _)| factor);
        self.intern(Node::Product(factors.into()))
    }

    /// Interns sorted factors without further simplification.
    fn factors_of(&mut self, factors: Vec<(Id, Rational)>) -> Id {
        match factors[..] {
            [] => Id::ONE,
            [(factor, exponent)] if exponent.is_one() => factor,
            _ => self.intern(Node::Product(factors.into())),
        }
    }

    /// Π factor ^ exponent.
    pub fn product(&mut self, factors: impl IntoIterator<Item = (Id, Rational)>) -> Id {
        let mut flat: Vec<(Id, Rational)> = factors.into_iter().collect();
        let mut coefficient = Scaled::from(Rational::one());
        loop {
            let mut next = Vec::with_capacity(flat.len());
            let mut changed = false;
            for (factor, exponent) in flat {
                match self.push_factor(&mut next, &mut coefficient, factor, exponent) {
                    Ok(reduced) => changed |= reduced,
                    Err(fault) => return self.fail(fault),
                }
            }
            let Some(merged) = merge(next) else { return self.fail(Fault::Overflow) };
            flat = merged;
            if !changed
                && flat.iter().all(|&(factor, exponent)| self.is_irreducible(coefficient, factor, exponent))
            {
                break;
            }
        }
        if coefficient.fraction.is_zero() {
            return Id::ZERO;
        }
        if !self.is_in_range(&flat, coefficient) {
            return self.fail(Fault::Overflow);
        }
        let product = self.factors_of(flat);
        self.sum_of([(product, coefficient)])
    }

    /// True if floating point can multiply the numbers in a product in any order without overflow or underflow.
    fn is_in_range(&self, factors: &[(Id, Rational)], coefficient: Scaled) -> bool {
        let (mut least, mut greatest) = (0.0, 0.0);
        for &(factor, exponent) in factors {
            if let Some(value) = self.as_number(factor) {
                let magnitude = Scaled::from(value).magnitude() * to_f64(exponent);
                least += magnitude.min(0.0);
                greatest += magnitude.max(0.0);
            }
        }
        let magnitude = coefficient.magnitude();
        least == 0.0 && greatest == 0.0 || least.min(magnitude) > -RANGE && greatest.max(magnitude) < RANGE
    }

    /// Splits `factor ^ exponent` as far as that is exact. Returns true if the new factors may need merging.
    fn push_factor(
        &mut self,
        flat: &mut Vec<(Id, Rational)>,
        coefficient: &mut Scaled,
        factor: Id,
        exponent: Rational,
    ) -> Result<bool, Fault> {
        if factor == Id::ZERO && exponent.is_negative() {
            return Err(Fault::DivisionByZero);
        }
        match self.node(factor) {
            Node::Number(value) => {
                let value = *value;
                match number_power(value, exponent).and_then(|power| {
                    self.roundings.note_power(power, value, exponent);
                    self.roundings.times(*coefficient, power)
                }) {
                    Some(product) => *coefficient = product,
                    None => flat.push((factor, exponent)),
                }
            }
            Node::Sum(terms) if exponent.is_integer() && !common_coefficient(terms).is_one() => {
                let common = common_coefficient(terms);
                flat.push((self.number(common), exponent));
                flat.push((self.sum([(factor, common.recip())]), exponent));
                return Ok(true);
            }
            Node::Product(parts) if exponent.is_integer() => {
                for (part, inner) in parts {
                    flat.push((*part, times(*inner, exponent).ok_or(Fault::Overflow)?));
                }
                return Ok(true);
            }
            Node::Function(Function::Abs, x) if is_even(exponent) => {
                flat.push((*x, exponent));
                return Ok(true);
            }
            _ => flat.push((factor, exponent)),
        }
        Ok(false)
    }

    /// True if [`push_factor`](Self::push_factor) would leave `factor ^ exponent` unchanged.
    fn is_irreducible(&self, coefficient: Scaled, factor: Id, exponent: Rational) -> bool {
        match self.node(factor) {
            Node::Number(value) => {
                number_power(*value, exponent).and_then(|power| rounded::times(coefficient, power)).is_none()
            }
            Node::Sum(terms) => !exponent.is_integer() || common_coefficient(terms).is_one(),
            Node::Product(_) => !exponent.is_integer(),
            Node::Function(Function::Abs, _) => !is_even(exponent),
            _ => true,
        }
    }

    /// `function(x)`, folded at arguments with exact values. Odd and even functions lose the sign of their argument.
    pub fn function(&mut self, function: Function, x: Id) -> Id {
        if let Some(value) = self.exact_value(function, x) {
            return value;
        }
        let parity = function.parity();
        if parity != Parity::None && self.leads_negative(x) {
            let x = self.neg(x);
            let value = self.function(function, x);
            return if parity == Parity::Odd { self.neg(value) } else { value };
        }
        match (function, self.node(x)) {
            (Function::Exp, Node::Function(Function::Ln, inner)) => *inner,
            (Function::Ln, Node::Function(Function::Exp, inner)) => *inner,
            (Function::Abs, Node::Function(Function::Abs, _)) => x,
            _ => self.intern(Node::Function(function, x)),
        }
    }

    fn exact_value(&mut self, function: Function, x: Id) -> Option<Id> {
        use Function as F;
        match (function, x) {
            (F::Sin | F::Tan | F::Asin | F::Atan | F::Sinh | F::Tanh | F::Abs, Id::ZERO) => Some(Id::ZERO),
            (F::Ramp, _) => self.as_number(x).map(|value| if value.is_positive() { x } else { Id::ZERO }),
            (F::Cos | F::Cosh | F::Exp, Id::ZERO) => Some(Id::ONE),
            (F::Ln | F::Acos, Id::ONE) => Some(Id::ZERO),
            (F::Abs, _) => self.as_number(x).map(|value| self.number(value.abs())),
            (F::Sin | F::Cos, _) => self.quarter_turns(x).map(|quarters| {
                let quarters = if function == F::Cos { quarters + 1 } else { quarters };
                self.integer([0, 1, 0, -1][quarters.rem_euclid(4) as usize])
            }),
            _ => None,
        }
    }

    /// n if x = n π/2.
    fn quarter_turns(&self, x: Id) -> Option<i128> {
        let (term, coefficient) = match self.node(x) {
            Node::Pi => (x, Rational::one()),
            Node::Sum(terms) if terms.len() == 1 => terms[0],
            _ => return None,
        };
        let quarters = times(coefficient, Rational::from_integer(2))?;
        (*self.node(term) == Node::Pi && quarters.is_integer()).then(|| quarters.to_integer() % 4)
    }

    /// True if the leading coefficient is negative, which holds for exactly one of x and −x.
    fn leads_negative(&self, x: Id) -> bool {
        match self.node(x) {
            Node::Number(value) => value.is_negative(),
            Node::Sum(terms) => terms[0].1.is_negative(),
            _ => false,
        }
    }
}

/// Largest decimal exponent, either way, of numbers in a product: about half the range of `f64`.
const RANGE: f64 = 150.0;

/// Symmetry of a function under x → −x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Parity {
    Even,
    Odd,
    None,
}

impl Function {
    pub fn parity(self) -> Parity {
        match self {
            Self::Cos | Self::Cosh | Self::Abs => Parity::Even,
            Self::Sin | Self::Tan | Self::Asin | Self::Atan | Self::Sinh | Self::Tanh => Parity::Odd,
            Self::Acos | Self::Exp | Self::Ln | Self::Ramp | Self::Step => Parity::None,
        }
    }
}

fn is_even(exponent: Rational) -> bool {
    exponent.is_integer() && exponent.to_integer() % 2 == 0
}

/// Factor to take out of a sum: the first coefficient if all have the same magnitude, else the sign of the first one.
/// So in every product, 2 x + 2 y and y − x become multiples of x + y and x − y.
fn common_coefficient(terms: &[(Id, Rational)]) -> Rational {
    let first = terms[0].1;
    let alike =
        terms.iter().all(|(_, c)| c.denom() == first.denom() && c.numer().abs() == first.numer().abs());
    if alike { first } else { first.signum() }
}

/// value ^ exponent if it is rational and its digits fit; otherwise the number stays a factor.
fn number_power(value: Rational, exponent: Rational) -> Option<Scaled> {
    match *exponent.denom() {
        1 => Scaled::from(value).power(*exponent.numer()),
        _ if value.is_zero() || value.is_one() => Some(value.into()),
        2 => Scaled::from(rational::square_root(value)?).power(*exponent.numer()),
        _ => None,
    }
}

/// Sorts by node and adds the values of equal nodes. Entries that sum to zero are dropped.
fn merge(mut parts: Vec<(Id, Rational)>) -> Option<Vec<(Id, Rational)>> {
    parts.sort_unstable_by_key(|&(id, _)| id);
    let mut merged: Vec<(Id, Rational)> = Vec::with_capacity(parts.len());
    for (id, value) in parts {
        match merged.last_mut() {
            Some(last) if last.0 == id => last.1 = plus(last.1, value)?,
            _ => merged.push((id, value)),
        }
    }
    merged.retain(|(_, value)| !value.is_zero());
    Some(merged)
}
