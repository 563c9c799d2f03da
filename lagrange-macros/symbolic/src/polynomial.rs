//! Polynomials with exact coefficients: a normal form for expressions as long as a constraint.
//!
//! The generators are symbols, functions, roots and reciprocals. A square of a sine, a power of a root and the like
//! are rewritten by identities, so that sin² + cos² is 1. Identities between generators of different arguments, such
//! as double angles, are not applied. Equal polynomials therefore mean equal expressions, but not the reverse.

use std::cell::Cell;
use std::collections::BTreeMap;

use num_traits::{One, Zero};
use rustc_hash::FxHashMap;

use super::graph::{Function, Graph, Id, Node};
use super::rational::{Rational, plus, times};

/// Largest number of terms of a polynomial.
const TERMS: usize = 2000;

/// Largest number of multiplications of terms, which take an unoptimised macro one or two seconds.
const WORK: usize = 100_000;

/// Largest exponent that is expanded, and largest number of distinct reciprocals that are cleared from a row.
const POWER: u32 = 16;

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) enum Generator {
    Node(Id),
    /// base^(1/degree)
    Root(Id, u32),
    /// base^(−1/degree)
    Reciprocal(Id, u32),
}

/// Generators in descending order, with their exponents. As vectors they compare lexicographically, a monomial order
/// that products preserve.
pub(super) type PowerProduct = Vec<(Generator, u32)>;

/// Σ coefficient · monomial, all coefficients nonzero.
#[derive(Clone, Default, PartialEq, Eq, Debug)]
pub struct ExactPolynomial(pub(super) BTreeMap<PowerProduct, Rational>);

/// Cache of expressions as polynomials, and rewriting rules for powers of generators.
#[derive(Debug, Default)]
pub struct Polynomials {
    known: FxHashMap<Id, Option<ExactPolynomial>>,
    /// For each generator, the least exponent that is rewritten, and the polynomial that equals this power.
    relations: FxHashMap<Generator, (u32, ExactPolynomial)>,
    /// Number of multiplications of terms so far.
    work: Cell<usize>,
}

impl ExactPolynomial {
    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    pub fn number(value: Rational) -> Self {
        Self::term(PowerProduct::new(), value)
    }

    pub(super) fn term(monomial: PowerProduct, coefficient: Rational) -> Self {
        Self([(monomial, coefficient)].into_iter().filter(|(_, c)| !c.is_zero()).collect())
    }

    fn generator(generator: Generator, exponent: u32) -> Self {
        Self::term(if exponent == 0 { Vec::new() } else { vec![(generator, exponent)] }, Rational::one())
    }

    pub fn as_number(&self) -> Option<Rational> {
        match self.0.iter().next() {
            None => Some(Rational::zero()),
            Some((monomial, &c)) => (self.0.len() == 1 && monomial.is_empty()).then_some(c),
        }
    }

    /// Every monomial with its coefficient.
    pub fn terms(&self) -> impl Iterator<Item = (&impl Ord, Rational)> {
        self.0.iter().map(|(monomial, &c)| (monomial, c))
    }

    /// self + factor · other; `None` if exact arithmetic overflows or the sum is too long.
    pub fn plus(&self, other: &Self, factor: Rational) -> Option<Self> {
        let mut sum = self.clone();
        sum.add(other, factor)?;
        Some(sum)
    }

    fn add(&mut self, other: &Self, factor: Rational) -> Option<()> {
        for (monomial, &c) in &other.0 {
            let c = times(c, factor)?;
            let both = plus(self.0.remove(monomial).unwrap_or_default(), c)?;
            if !both.is_zero() {
                self.0.insert(monomial.clone(), both);
            }
        }
        (self.0.len() <= TERMS).then_some(())
    }

    /// The generators, each with its largest exponent.
    fn generators(&self) -> BTreeMap<Generator, u32> {
        let mut greatest = BTreeMap::new();
        for &(generator, exponent) in self.0.keys().flatten() {
            let known = greatest.entry(generator).or_insert(exponent);
            *known = exponent.max(*known);
        }
        greatest
    }

    /// The node under each generator.
    pub fn bases(&self) -> impl Iterator<Item = Id> {
        self.generators().into_keys().map(|generator| match generator {
            Generator::Node(base) | Generator::Root(base, _) | Generator::Reciprocal(base, _) => base,
        })
    }

    /// Splits p + r g into p and r.
    fn split(&self, by: Generator) -> (Self, Self) {
        let (mut without, mut with) = (Self::default(), Self::default());
        for (monomial, &c) in &self.0 {
            match monomial.iter().position(|&(generator, _)| generator == by) {
                None => without.0.insert(monomial.clone(), c),
                Some(place) => {
                    let mut rest = monomial.clone();
                    match rest[place].1 {
                        1 => drop(rest.remove(place)),
                        _ => rest[place].1 -= 1,
                    }
                    with.0.insert(rest, c)
                }
            };
        }
        (without, with)
    }
}

impl Polynomials {
    /// Expands an expression without definitions into a polynomial; `None` if it is too long.
    pub fn of(&mut self, graph: &mut Graph, root: Id) -> Option<ExactPolynomial> {
        for id in graph.reachable(&[root]) {
            if !self.known.contains_key(&id) {
                let polynomial = self.expanded(graph, id);
                self.known.insert(id, polynomial);
            }
        }
        self.known[&root].clone()
    }

    fn expanded(&mut self, graph: &mut Graph, id: Id) -> Option<ExactPolynomial> {
        let itself = ExactPolynomial::generator(Generator::Node(id), 1);
        match graph.node(id).clone() {
            Node::Number(value) => Some(ExactPolynomial::number(value)),
            Node::Sum(terms) => {
                let mut sum = ExactPolynomial::default();
                for (term, c) in terms {
                    sum.add(self.known[&term].as_ref()?, c)?;
                }
                Some(sum)
            }
            Node::Product(factors) => {
                let mut product = ExactPolynomial::number(Rational::one());
                for (factor, exponent) in factors {
                    let power = match exponent.numer().unsigned_abs() <= POWER.into() {
                        true => self.raised(factor, exponent)?,
                        false => ExactPolynomial::generator(Generator::Node(graph.pow(factor, exponent)), 1),
                    };
                    product = self.times(&product, &power)?;
                }
                Some(product)
            }
            Node::Function(function @ (Function::Sin | Function::Cosh), x) => {
                let (other, sign) = match function {
                    Function::Sin => (Function::Cos, -1),
                    _ => (Function::Sinh, 1),
                };
                let other = graph.function(other, x);
                // sin² and cosh² are rewritten as 1 ± other², with `other` the cofunction.
                let other = ExactPolynomial::generator(Generator::Node(other), 2);
                let square = ExactPolynomial::number(Rational::one()).plus(&other, sign.into())?;
                self.relations.insert(Generator::Node(id), (2, square));
                Some(itself)
            }
            _ => Some(itself),
        }
    }

    /// base^exponent
    fn raised(&mut self, base: Id, exponent: Rational) -> Option<ExactPolynomial> {
        let whole = &self.known[&base];
        if exponent.is_integer() && *exponent.numer() > 0 {
            let whole = whole.as_ref()?;
            let times = |power: ExactPolynomial, _| self.times(&power, whole);
            return (0..*exponent.numer()).try_fold(ExactPolynomial::number(Rational::one()), times);
        }
        let degree = u32::try_from(*exponent.denom()).ok()?;
        let count = u32::try_from(exponent.numer().unsigned_abs()).ok()?;
        if let Some(whole) = whole {
            self.relations.insert(Generator::Root(base, degree), (degree, whole.clone()));
        }
        match *exponent.numer() > 0 {
            true => self.reduced(vec![(Generator::Root(base, degree), count)]),
            false => Some(ExactPolynomial::generator(Generator::Reciprocal(base, degree), count)),
        }
    }

    /// Product of two polynomials; `None` if it is too long.
    pub fn times(&self, x: &ExactPolynomial, y: &ExactPolynomial) -> Option<ExactPolynomial> {
        let mut product = ExactPolynomial::default();
        self.work.set(self.work.get() + x.0.len() * y.0.len());
        (self.work.get() <= WORK).then_some(())?;
        for (first, &c) in &x.0 {
            for (second, &d) in &y.0 {
                product.add(&self.reduced(joined(first, second))?, times(c, d)?)?;
            }
        }
        Some(product)
    }

    /// Applies the rewriting rules to the powers in a monomial.
    fn reduced(&self, monomial: PowerProduct) -> Option<ExactPolynomial> {
        let rewritten = monomial.iter().enumerate().find_map(|(place, &(generator, exponent))| {
            let (power, equal) = self.relations.get(&generator)?;
            (exponent >= *power).then_some((place, *power, equal))
        });
        let Some((place, power, equal)) = rewritten else {
            return Some(ExactPolynomial::term(monomial, Rational::one()));
        };
        let mut rest = monomial;
        rest[place].1 -= power;
        rest.retain(|&(_, exponent)| exponent > 0);
        self.times(&ExactPolynomial::term(rest, Rational::one()), equal)
    }

    /// Multiplies all polynomials by a common factor that clears their reciprocals. The factor is nonzero wherever the
    /// polynomials have values.
    pub fn cleared(&self, row: &[ExactPolynomial]) -> Option<Vec<ExactPolynomial>> {
        let mut row = row.to_vec();
        // A base may itself contain reciprocals, which are cleared in later passes.
        for _ in 0..POWER {
            let greatest =
                row.iter().flat_map(|entry| entry.generators()).filter_map(|(generator, exponent)| {
                    match generator {
                        Generator::Reciprocal(base, degree) => Some((base, degree, exponent)),
                        _ => None,
                    }
                });
            let Some((base, degree, exponent)) = greatest.max() else { return Some(row) };
            for entry in &mut row {
                *entry = self.without_reciprocal(entry, (base, degree), exponent)?;
            }
        }
        None
    }

    /// Multiplies a polynomial by base^(exponent/degree).
    fn without_reciprocal(
        &self,
        polynomial: &ExactPolynomial,
        (base, degree): (Id, u32),
        exponent: u32,
    ) -> Option<ExactPolynomial> {
        let mut cleared = ExactPolynomial::default();
        for (monomial, &c) in &polynomial.0 {
            let mut rest = monomial.clone();
            let place = rest.iter().position(|&(other, _)| other == Generator::Reciprocal(base, degree));
            let left = exponent - place.map_or(0, |place| rest.remove(place).1);
            let root = ExactPolynomial::generator(Generator::Root(base, degree), left);
            let term = ExactPolynomial::term(rest, c);
            cleared.add(&self.times(&root, &term)?, Rational::one())?;
        }
        Some(cleared)
    }

    /// Quotient q with x = q y; `None` if there is none or it is not found.
    pub fn quotient(&self, x: &ExactPolynomial, y: &ExactPolynomial) -> Option<ExactPolynomial> {
        let (mut x, mut y) = (x.clone(), y.clone());
        // Multiply x and y by the conjugate p − r g, where y = p + r g with a known g²: this eliminates g from y.
        while let Some(square) =
            y.generators().keys().find(|g| self.relations.get(g).is_some_and(|r| r.0 == 2))
        {
            let (without, with) = y.split(*square);
            let with = self.times(&with, &ExactPolynomial::generator(*square, 1))?;
            let conjugate = without.plus(&with, -Rational::one())?;
            (x, y) = (self.times(&x, &conjugate)?, self.times(&y, &conjugate)?);
        }
        let (leading, &c) = y.0.last_key_value()?;
        let mut quotient = ExactPolynomial::default();
        while let Some((monomial, &d)) = x.0.last_key_value() {
            let term = ExactPolynomial::term(divided(monomial, leading)?, times(d, c.recip())?);
            x.add(&self.times(&term, &y)?, -Rational::one())?;
            quotient.add(&term, Rational::one())?;
        }
        Some(quotient)
    }
}

fn joined(x: &PowerProduct, y: &PowerProduct) -> PowerProduct {
    let mut exponents: BTreeMap<Generator, u32> = x.iter().copied().collect();
    for &(generator, exponent) in y {
        *exponents.entry(generator).or_default() += exponent;
    }
    exponents.into_iter().rev().collect()
}

pub(super) fn divided(x: &PowerProduct, y: &PowerProduct) -> Option<PowerProduct> {
    let mut exponents: BTreeMap<Generator, u32> = x.iter().copied().collect();
    for (generator, exponent) in y {
        let left = exponents.get_mut(generator)?;
        *left = left.checked_sub(*exponent)?;
    }
    Some(exponents.into_iter().rev().filter(|&(_, exponent)| exponent > 0).collect())
}
