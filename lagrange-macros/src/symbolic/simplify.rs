//! Constructors that keep every expression in canonical form: like terms collected, powers merged,
//! constants folded, products never expanded.

use num_traits::{One, Signed, Zero};

use super::graph::{External, Fault, Function, Graph, Id, Node};
use super::rational::{self, Rational, plus, times};

impl Graph {
    pub(crate) fn add(&mut self, x: Id, y: Id) -> Id {
        self.sum([(x, Rational::one()), (y, Rational::one())])
    }

    pub(crate) fn sub(&mut self, x: Id, y: Id) -> Id {
        self.sum([(x, Rational::one()), (y, -Rational::one())])
    }

    pub(crate) fn neg(&mut self, x: Id) -> Id {
        self.sum([(x, -Rational::one())])
    }

    pub(crate) fn mul(&mut self, x: Id, y: Id) -> Id {
        self.product([(x, Rational::one()), (y, Rational::one())])
    }

    pub(crate) fn div(&mut self, x: Id, y: Id) -> Id {
        self.product([(x, Rational::one()), (y, -Rational::one())])
    }

    /// `base` to a rational power.
    pub(crate) fn pow(&mut self, base: Id, exponent: Rational) -> Id {
        self.product([(base, exponent)])
    }

    pub(crate) fn square(&mut self, x: Id) -> Id {
        self.pow(x, Rational::from_integer(2))
    }

    pub(crate) fn sqrt(&mut self, x: Id) -> Id {
        self.pow(x, Rational::new_raw(1, 2))
    }

    /// `base` to any power.
    pub(crate) fn power(&mut self, base: Id, exponent: Id) -> Id {
        match self.as_number(exponent) {
            Some(exponent) => self.pow(base, exponent),
            None if base == Id::ONE => Id::ONE,
            None => self.intern(Node::Power(base, exponent)),
        }
    }

    pub(crate) fn external(&mut self, mut external: External) -> Id {
        external.derivatives.sort_unstable();
        self.intern(Node::External(Box::new(external)))
    }

    pub(crate) fn atan2(&mut self, y: Id, x: Id) -> Id {
        self.intern(Node::Atan2(y, x))
    }

    /// Σ coefficient · term.
    pub(crate) fn sum(&mut self, terms: impl IntoIterator<Item = (Id, Rational)>) -> Id {
        let mut flat = Vec::new();
        for (term, coefficient) in terms {
            if self.push_term(&mut flat, term, coefficient).is_none() {
                return self.fail(Fault::Overflow);
            }
        }
        match merge(flat) {
            None => self.fail(Fault::Overflow),
            Some(terms) => match terms[..] {
                [] => Id::ZERO,
                [(term, coefficient)] if coefficient.is_one() => term,
                [(Id::ONE, coefficient)] => self.number(coefficient),
                _ => self.intern(Node::Sum(terms.into())),
            },
        }
    }

    fn push_term(&self, flat: &mut Vec<(Id, Rational)>, term: Id, coefficient: Rational) -> Option<()> {
        match self.node(term) {
            Node::Number(value) => flat.push((Id::ONE, times(*value, coefficient)?)),
            Node::Sum(terms) => {
                for (inner, c) in terms {
                    flat.push((*inner, times(*c, coefficient)?));
                }
            }
            _ => flat.push((term, coefficient)),
        }
        Some(())
    }

    /// Π factor ^ exponent.
    pub(crate) fn product(&mut self, factors: impl IntoIterator<Item = (Id, Rational)>) -> Id {
        let mut flat: Vec<(Id, Rational)> = factors.into_iter().collect();
        let mut coefficient = Rational::one();
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
            if !changed && flat.iter().all(|&(factor, exponent)| self.is_irreducible(factor, exponent)) {
                break;
            }
        }
        if coefficient.is_zero() {
            return Id::ZERO;
        }
        let product = match flat[..] {
            [] => return self.number(coefficient),
            [(factor, exponent)] if exponent.is_one() => factor,
            _ => self.intern(Node::Product(flat.into())),
        };
        self.sum([(product, coefficient)])
    }

    /// Takes `factor ^ exponent` apart as far as that is exact; true where parts may merge anew.
    fn push_factor(
        &mut self,
        flat: &mut Vec<(Id, Rational)>,
        coefficient: &mut Rational,
        factor: Id,
        exponent: Rational,
    ) -> Result<bool, Fault> {
        if factor == Id::ZERO && exponent.is_negative() {
            return Err(Fault::DivisionByZero);
        }
        let mut scale = |c| times(*coefficient, c).map(|c| *coefficient = c).ok_or(Fault::Overflow);
        match self.node(factor) {
            Node::Number(value) => match exact_power(*value, exponent)? {
                Some(value) => scale(value)?,
                None => flat.push((factor, exponent)),
            },
            Node::Sum(terms) if exponent.is_integer() && !common_coefficient(terms).is_one() => {
                let common = common_coefficient(terms);
                scale(rational::power(common, exponent.to_integer()).ok_or(Fault::Overflow)?)?;
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

    /// Whether [`push_factor`](Self::push_factor) would leave `factor ^ exponent` as it is.
    fn is_irreducible(&self, factor: Id, exponent: Rational) -> bool {
        match self.node(factor) {
            Node::Number(value) => matches!(exact_power(*value, exponent), Ok(None)),
            Node::Sum(terms) => !exponent.is_integer() || common_coefficient(terms).is_one(),
            Node::Product(_) => !exponent.is_integer(),
            Node::Function(Function::Abs, _) => !is_even(exponent),
            _ => true,
        }
    }

    /// `function(x)`, folded at its exact values and with the sign taken out of odd and even functions.
    pub(crate) fn function(&mut self, function: Function, x: Id) -> Id {
        if let Some(value) = self.exact_value(function, x) {
            return value;
        }
        let parity = parity(function);
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

    /// n where x = n π/2.
    fn quarter_turns(&self, x: Id) -> Option<i128> {
        let (term, coefficient) = match self.node(x) {
            Node::Pi => (x, Rational::one()),
            Node::Sum(terms) if terms.len() == 1 => terms[0],
            _ => return None,
        };
        let quarters = times(coefficient, Rational::from_integer(2))?;
        (*self.node(term) == Node::Pi && quarters.is_integer()).then(|| quarters.to_integer() % 4)
    }

    /// Of x and −x, exactly one leads negative.
    fn leads_negative(&self, x: Id) -> bool {
        match self.node(x) {
            Node::Number(value) => value.is_negative(),
            Node::Sum(terms) => terms[0].1.is_negative(),
            _ => false,
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Parity {
    Even,
    Odd,
    None,
}

fn parity(function: Function) -> Parity {
    use Function as F;
    match function {
        F::Cos | F::Cosh | F::Abs => Parity::Even,
        F::Sin | F::Tan | F::Asin | F::Atan | F::Sinh | F::Tanh => Parity::Odd,
        F::Acos | F::Exp | F::Ln => Parity::None,
    }
}

fn is_even(exponent: Rational) -> bool {
    exponent.is_integer() && exponent.to_integer() % 2 == 0
}

/// What can be taken out of a sum as a factor: the first coefficient where all are alike but for their signs,
/// otherwise the first one's sign. So 2 x + 2 y and y − x are multiples of x + y and x − y in every product.
fn common_coefficient(terms: &[(Id, Rational)]) -> Rational {
    let first = terms[0].1;
    let alike =
        terms.iter().all(|(_, c)| c.denom() == first.denom() && c.numer().abs() == first.numer().abs());
    if alike { first } else { first.signum() }
}

/// value ^ exponent where that is rational.
fn exact_power(value: Rational, exponent: Rational) -> Result<Option<Rational>, Fault> {
    if exponent.is_integer() {
        return rational::power(value, exponent.to_integer()).map(Some).ok_or(Fault::Overflow);
    }
    if value.is_zero() || value.is_one() {
        return Ok(Some(value));
    }
    match (*exponent.denom(), rational::square_root(value)) {
        (2, Some(root)) => rational::power(root, *exponent.numer()).map(Some).ok_or(Fault::Overflow),
        _ => Ok(None),
    }
}

/// Sorts by node and adds what stands at the same one; entries that add to zero go.
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
