//! Atoms of polynomials, and the meaning of each.

use std::collections::BTreeSet;

use indexmap::IndexSet;
use num_traits::{One, Signed};
use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};

use super::super::formula::Formula;
use super::turned::Tensors;
use crate::symbolic::{
    Atom, External, Function, Id, Monomial, Parity, Polynomial, Rational, power, square_root,
};
use crate::variables::Variable;

/// Meaning of an atom. Equal meanings share one atom.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) enum Meaning {
    Variable(Variable),
    Pi,
    /// A number under a root, or with too many digits for a coefficient.
    Number(Rational),
    /// A definition that keeps its name.
    Definition(Id),
    Function(Function, Polynomial),
    Atan2(Polynomial, Polynomial),
    /// A power whose exponent is not a number.
    Power(Polynomial, Polynomial),
    /// A sum, the base of a power that cannot be multiplied out.
    Sum(Polynomial),
    /// A user-supplied function, with its arguments.
    External(External, Vec<Polynomial>),
    /// A vector as written, with the variable of its first component; or a product of vectors, with the variables of
    /// all.
    Vector(Formula, Vec<Variable>),
}

#[derive(Default)]
pub(super) struct Atoms {
    meanings: IndexSet<Meaning, FxBuildHasher>,
    /// Number of names and numbers that each atom takes written out.
    sizes: Vec<u64>,
    /// Graph node of each sum.
    sources: FxHashMap<Atom, Id>,
    /// The cosine of the angle of each sine, and the sine of that of each cosine.
    pub(super) other_waves: FxHashMap<Atom, Atom>,
    /// Sums of which a definition is the root: powers of them are not multiplied out.
    pub(super) kept: FxHashSet<Atom>,
    /// Matrices and vectors of which products are recognized.
    pub(super) tensors: Tensors,
    /// Number of products computed so far.
    #[cfg(test)]
    products: usize,
}

impl Atoms {
    pub(super) fn atom(&mut self, meaning: Meaning) -> Atom {
        let (index, is_new) = self.meanings.insert_full(meaning);
        if is_new {
            let size = match &self.meanings[index] {
                Meaning::Function(_, x) | Meaning::Sum(x) => self.size(x),
                Meaning::Atan2(x, y) | Meaning::Power(x, y) => self.size(x).saturating_add(self.size(y)),
                Meaning::External(_, arguments) => {
                    arguments.iter().fold(0, |size: u64, x| size.saturating_add(self.size(x)))
                }
                _ => 0,
            };
            self.sizes.push(size.saturating_add(1));
        }
        Atom(index as u32)
    }

    /// Number of names and numbers that a polynomial takes written out. Shared parts count at each use.
    pub(super) fn size(&self, polynomial: &Polynomial) -> u64 {
        let atoms = polynomial.terms().flat_map(|(monomial, _)| monomial.factors());
        atoms
            .fold(polynomial.len() as u64, |size, (atom, _)| size.saturating_add(self.sizes[atom.0 as usize]))
    }

    pub(super) fn meaning(&self, atom: Atom) -> &Meaning {
        &self.meanings[atom.0 as usize]
    }

    pub(super) fn source(&self, atom: Atom) -> Option<Id> {
        self.sources.get(&atom).copied()
    }

    /// Applies a function to a polynomial, with the sign taken out of odd and even functions.
    pub(super) fn function(&mut self, function: Function, x: &Polynomial) -> Polynomial {
        let parity = function.parity();
        match function {
            Function::Cos if x.is_zero() => return Polynomial::number(Rational::one()),
            _ if parity == Parity::Odd && x.is_zero() => return Polynomial::default(),
            _ => {}
        }
        let is_turned = parity != Parity::None && x.leads_negative();
        let x = if is_turned { x.negated() } else { x.clone() };
        let value = Polynomial::atom(self.atom(Meaning::Function(function, x)));
        if is_turned && parity == Parity::Odd { value.negated() } else { value }
    }

    /// Power of a polynomial that the node `source` stands for; `None` for a power of zero, or if numbers overflow.
    pub(super) fn power(&mut self, base: &Polynomial, exponent: Rational, source: Id) -> Option<Polynomial> {
        if exponent.is_integer() && exponent.is_positive() {
            return self.natural_power(base, exponent.to_integer());
        }
        let one = Rational::one();
        match base.single() {
            _ if base.is_zero() => return None,
            Some((monomial, c)) if exponent.is_integer() => {
                return Some(Polynomial::term(monomial.power(exponent)?, power(c, exponent.to_integer())?));
            }
            Some((monomial, c)) if monomial.is_one() => {
                let number = self.atom(Meaning::Number(c));
                return Some(Polynomial::term(Monomial::of(number, exponent), one));
            }
            Some((monomial, c))
                if c.is_one() && matches!(monomial.factors(), [(_, inner)] if inner.is_one()) =>
            {
                return Some(Polynomial::term(monomial.power(exponent)?, one));
            }
            _ => {}
        }
        let merged = self.merged(base.clone())?;
        if merged != *base {
            return self.power(&merged, exponent, source);
        }
        let (number, monomial) = self.taken_out(base, exponent);
        let rest = base.scaled(&monomial.power(-one)?, number.recip())?;
        let sum = self.atom(Meaning::Sum(rest));
        if number.is_one() && monomial.is_one() {
            self.sources.entry(sum).or_insert(source);
        }
        let number = match exponent.is_integer() {
            true => power(number, exponent.to_integer())?,
            false => power(square_root(number)?, *exponent.numer())?,
        };
        Some(Polynomial::term(monomial.power(exponent)?.times(&Monomial::of(sum, exponent))?, number))
    }

    /// Common factor of `base` that leaves the power as a factor of its own. Out of a square root only a
    /// square number is taken, since other factors are not known to be positive.
    fn taken_out(&self, base: &Polynomial, exponent: Rational) -> (Rational, Monomial) {
        let (number, monomial) = base.content();
        if exponent.is_integer() {
            return (if base.leads_negative() { -number } else { number }, monomial);
        }
        let is_square = *exponent.denom() == 2 && square_root(number).is_some();
        (if is_square { number } else { Rational::one() }, Monomial::default())
    }

    pub(super) fn power_of_ten(&mut self, exponent: Rational) -> Polynomial {
        let ten = self.atom(Meaning::Number(Rational::from_integer(10)));
        Polynomial::term(Monomial::of(ten, exponent), Rational::one())
    }

    /// Power by repeated squaring, with a number of products that grows with the binary digits of the exponent.
    pub(super) fn natural_power(&mut self, base: &Polynomial, exponent: i128) -> Option<Polynomial> {
        if exponent == 1 {
            return Some(base.clone());
        }
        let half = self.natural_power(base, exponent / 2)?;
        let square = self.product(&half, &half)?;
        if exponent % 2 == 0 { Some(square) } else { self.product(&square, base) }
    }

    /// Product, if it has at most [`LIMIT`] terms. Natural powers of sums in it are multiplied out.
    pub(super) fn product(&mut self, x: &Polynomial, y: &Polynomial) -> Option<Polynomial> {
        #[cfg(test)]
        (self.products += 1);
        if x.len().saturating_mul(y.len()) > LIMIT {
            return None;
        }
        let product = x.times(y)?;
        let is_natural = |&(atom, exponent): &(Atom, Rational)| {
            let is_sum = matches!(self.meaning(atom), Meaning::Sum(_));
            is_sum && exponent.is_integer() && exponent.is_positive() && !self.kept.contains(&atom)
        };
        let found = product.terms().find_map(|(monomial, &c)| {
            let factor = *monomial.factors().iter().find(|factor| is_natural(factor))?;
            Some((monomial.clone(), c, factor))
        });
        let Some((monomial, c, (atom, exponent))) = found else { return Some(product) };
        let Meaning::Sum(sum) = self.meaning(atom).clone() else { return None };
        let mut rest = product;
        rest.remove(&monomial);
        let others = Polynomial::term(monomial.filtered(|other| other != atom), c);
        let power = self.natural_power(&sum, exponent.to_integer())?;
        rest.add(&self.product(&power, &others)?, Rational::one())?;
        self.product(&rest, &Polynomial::number(Rational::one()))
    }

    /// Cancels sums that are divided by themselves: x²/(x² + y²) + y²/(x² + y²) = 1.
    pub(super) fn cancelled(&mut self, polynomial: Polynomial) -> Option<Polynomial> {
        let factors = polynomial.terms().flat_map(|(monomial, _)| monomial.factors().to_vec());
        let divisors: BTreeSet<(Atom, Rational)> =
            factors.filter(|(_, exponent)| exponent.is_negative()).collect();
        for (atom, exponent) in divisors {
            let Meaning::Sum(sum) = self.meaning(atom).clone() else { continue };
            let members = polynomial.terms().filter(|(monomial, _)| monomial.exponent(atom) == exponent);
            let members: Polynomial = members.map(|(monomial, &c)| (monomial.clone(), c)).collect();
            let above = members.scaled(&Monomial::of(atom, -exponent), Rational::one())?;
            if let Some(quotient) = self.merged(above)?.divided(&sum) {
                let mut rest = polynomial;
                rest.add(&members, -Rational::one())?;
                let one = Polynomial::term(Monomial::of(atom, exponent), Rational::one());
                let power = one.scaled(&Monomial::of(atom, Rational::one()), Rational::one())?;
                rest.add(&self.product(&quotient, &power)?, Rational::one())?;
                return self.cancelled(rest);
            }
        }
        Some(polynomial)
    }
}

impl Atoms {
    /// Multiplies powers of sums out to the lowest power where that leaves fewer terms: √X + (1 − X)/√X = 1/√X.
    pub(super) fn combined(&mut self, polynomial: Polynomial) -> Option<Polynomial> {
        let factors = polynomial.terms().flat_map(|(monomial, _)| monomial.factors().to_vec());
        let sums: BTreeSet<Atom> = factors
            .filter(|&(atom, exponent)| {
                exponent.is_negative() && matches!(self.meaning(atom), Meaning::Sum(_))
            })
            .map(|(atom, _)| atom)
            .collect();
        let mut combined = polynomial;
        for atom in sums {
            if let Some(lowest) = self.at_lowest(&combined, atom).filter(|it| it.len() < combined.len()) {
                combined = lowest;
            }
        }
        Some(combined)
    }

    /// The polynomial with the sum of an atom multiplied out, but for the lowest power of it in each class of powers that
    /// differ by integers.
    fn at_lowest(&mut self, polynomial: &Polynomial, atom: Atom) -> Option<Polynomial> {
        let Meaning::Sum(sum) = self.meaning(atom).clone() else { return None };
        let exponents: BTreeSet<Rational> =
            polynomial.terms().map(|(monomial, _)| monomial.exponent(atom)).collect();
        let mut whole = Polynomial::default();
        for (monomial, &c) in polynomial.terms() {
            let own = monomial.exponent(atom);
            let lowest = exponents.iter().find(|lowest| (own - **lowest).is_integer())?;
            let rest = monomial.filtered(|other| other != atom).times(&Monomial::of(atom, *lowest))?;
            let times = (own - lowest).to_integer();
            let power = if times == 0 {
                Polynomial::number(Rational::one())
            } else {
                self.natural_power(&sum, times)?
            };
            whole.add(&power.scaled(&rest, c)?, Rational::one())?;
        }
        self.merged(whole)
    }
}

/// Maximum number of terms of a product before like terms are collected.
pub(super) const LIMIT: usize = 1000;

#[cfg(test)]
mod tests {
    use super::*;

    fn name(atoms: &mut Atoms, index: usize) -> Polynomial {
        Polynomial::atom(atoms.atom(Meaning::Variable(Variable::Coordinate(index))))
    }

    /// Powers of x, of zero, of 2 x and of x + y.
    #[test]
    fn powers_take_as_few_products_as_their_exponents_have_digits() {
        for exponent in [1, 2, 7, 1_000, 1_000_000, i128::MAX] {
            let mut atoms = Atoms::default();
            let [x, y] = [0, 1].map(|index| name(&mut atoms, index));
            let doubled = x.scaled(&Monomial::default(), Rational::from_integer(2)).expect("2 x");
            let mut both = x.clone();
            both.add(&y, Rational::one()).expect("x + y");
            let mut power = |base: &Polynomial| {
                atoms.products = 0;
                let power = atoms.natural_power(base, exponent);
                assert!(atoms.products <= 2 * exponent.ilog2() as usize, "{} products", atoms.products);
                power
            };
            let of_x = Monomial::of(Atom(0), Rational::from_integer(exponent));
            assert_eq!(power(&x), Some(Polynomial::term(of_x.clone(), Rational::one())));
            assert_eq!(power(&Polynomial::default()), Some(Polynomial::default()));
            let two = super::power(Rational::from_integer(2), exponent);
            assert_eq!(power(&doubled), two.map(|number| Polynomial::term(of_x, number)));
            let length = power(&both).map(|power| power.len() as i128);
            assert_eq!(length, (exponent < 1_000).then(|| exponent + 1));
        }
    }

    /// 2ⁿ sinⁿ(x/2) cosⁿ(x/2) becomes sinⁿ x if 2ⁿ fits into a coefficient, and is left unchanged otherwise.
    #[test]
    fn waves_of_half_an_angle_are_put_together_at_once() {
        for (exponent, is_short) in [(1, true), (100, true), (1_000, false), (i128::MAX, false)] {
            let mut atoms = Atoms::default();
            let x = name(&mut atoms, 0);
            let half = x.scaled(&Monomial::default(), Rational::new(1, 2)).expect("x/2");
            let [sine, cosine] = [Function::Sin, Function::Cos].map(|function| {
                let wave = atoms.atom(Meaning::Function(function, half.clone()));
                Monomial::of(wave, Rational::from_integer(exponent))
            });
            let product = Polynomial::term(sine.times(&cosine).expect("a product"), Rational::one());
            let merged = atoms.merged(product.clone()).expect("no long numbers");
            let whole = Monomial::of(
                atoms.atom(Meaning::Function(Function::Sin, x)),
                Rational::from_integer(exponent),
            );
            let number = super::power(Rational::new(1, 2), exponent);
            assert_eq!(number.is_some(), is_short);
            assert_eq!(merged, number.map_or(product, |number| Polynomial::term(whole, number)));
        }
    }
}
