//! Antiderivatives of terms that are a constant times f(u) ∂u/∂x. No other terms are integrated.

use num_traits::{One, Signed};
use rustc_hash::FxHashMap;

use super::differentiate::Forward;
use super::graph::{External, Function, Graph, Id, Node, Symbol};
use super::rational::{Rational, plus};

/// Largest exponent of a sum that is expanded.
const EXPANDED: i128 = 4;

/// Largest number of nonconstant factors of a product that is integrated. Each factor is tried, so that the cost is a
/// power of their number.
const FACTORS: usize = 16;

/// Largest number of terms of an expanded product: it grows exponentially with the number of factors.
const TERMS: u64 = 256;

impl Graph {
    /// Finds a function whose derivative by `symbol` is `root`.
    pub fn antiderivative(&mut self, root: Id, symbol: Symbol) -> Option<Id> {
        if !self.depends(root, symbol) {
            let variable = self.symbol(symbol);
            return Some(self.mul(root, variable));
        }
        match self.node(root).clone() {
            Node::Sum(terms) => self.integrate_terms(&terms, Id::ONE, symbol),
            Node::Product(factors) => self.integrate_product(&factors, symbol),
            _ => self.integrate_product(&[(root, Rational::one())], symbol),
        }
    }

    fn depends(&self, root: Id, symbol: Symbol) -> bool {
        self.symbols(&[root]).any(|known| known == symbol)
    }

    /// ∫ Σ coefficient · term · factor
    fn integrate_terms(&mut self, terms: &[(Id, Rational)], factor: Id, symbol: Symbol) -> Option<Id> {
        let mut parts = Vec::new();
        for &(term, coefficient) in terms {
            let term = self.mul(term, factor);
            parts.push((self.antiderivative(term, symbol)?, coefficient));
        }
        Some(self.sum(parts))
    }

    fn integrate_product(&mut self, factors: &[(Id, Rational)], symbol: Symbol) -> Option<Id> {
        let (varying, constant): (Vec<_>, Vec<_>) =
            factors.iter().copied().partition(|&(factor, _)| self.depends(factor, symbol));
        if varying.len() > FACTORS {
            return None;
        }
        let integrand = self.product(varying.iter().copied());
        let integral = self.substitute(&varying, integrand, symbol);
        let integral = integral.or_else(|| self.multiply_out(&varying, symbol))?;
        let constant = self.product(constant);
        Some(self.mul(constant, integral))
    }

    /// Tries substitution: for each factor in turn, its antiderivative as a function of its argument.
    fn substitute(&mut self, factors: &[(Id, Rational)], integrand: Id, symbol: Symbol) -> Option<Id> {
        for &(base, exponent) in factors {
            for candidate in self.candidates(base, exponent) {
                let slope = Forward::along([(symbol, Id::ONE)]).of(self, candidate);
                if slope == Id::ZERO {
                    continue;
                }
                let ratio = self.div(integrand, slope);
                if !self.depends(ratio, symbol) {
                    return Some(self.mul(ratio, candidate));
                }
            }
        }
        None
    }

    /// Candidate antiderivatives of base ^ exponent, up to a factor.
    fn candidates(&mut self, base: Id, exponent: Rational) -> Vec<Id> {
        let mut found = Vec::new();
        if exponent.is_one() {
            match self.node(base).clone() {
                Node::Function(function, x) => {
                    found.extend(primitive(function).map(|primitive| self.function(primitive, x)));
                }
                Node::External(external) => found.extend(self.less_differentiated(&external)),
                _ => {}
            }
        }
        if exponent == -Rational::one() {
            let magnitude = self.function(Function::Abs, base);
            found.push(self.function(Function::Ln, magnitude));
        } else {
            found.extend(plus(exponent, Rational::one()).map(|exponent| self.pow(base, exponent)));
        }
        found
    }

    fn less_differentiated(&mut self, external: &External) -> Vec<Id> {
        let lower = |position: usize| {
            let mut derivatives = external.derivatives.to_vec();
            derivatives.remove(position);
            External { derivatives: derivatives.into(), ..external.clone() }
        };
        (0..external.derivatives.len()).map(|position| self.external(lower(position))).collect()
    }

    /// Expands one factor: (Σ term) ^ n · rest = Σ term · (Σ term) ^ (n − 1) · rest
    fn multiply_out(&mut self, factors: &[(Id, Rational)], symbol: Symbol) -> Option<Id> {
        let position = factors.iter().position(|&factor| self.expands(factor))?;
        if self.terms_multiplied_out(factors) > TERMS {
            return None;
        }
        let mut rest = factors.to_vec();
        let Node::Sum(terms) = self.node(rest[position].0).clone() else { return None };
        rest[position].1 -= Rational::one();
        let rest = self.product(rest);
        self.integrate_terms(&terms, rest, symbol)
    }

    fn expands(&self, (factor, exponent): (Id, Rational)) -> bool {
        let is_power =
            exponent.is_integer() && exponent.is_positive() && exponent <= Rational::from_integer(EXPANDED);
        is_power && matches!(self.node(factor), Node::Sum(terms) if terms.len() > 1)
    }

    /// Number of terms of the fully expanded product, counted without expanding.
    fn terms_multiplied_out(&self, factors: &[(Id, Rational)]) -> u64 {
        let mut counts: FxHashMap<Id, u64> = FxHashMap::default();
        let of_product = |factors: &[(Id, Rational)], counts: &FxHashMap<Id, u64>| {
            let expanding = factors.iter().filter(|&&factor| self.expands(factor));
            expanding.fold(1_u64, |count, (factor, exponent)| {
                count.saturating_mul(counts[factor].saturating_pow(exponent.to_integer() as u32))
            })
        };
        for id in self.reachable(&factors.iter().map(|&(factor, _)| factor).collect::<Vec<_>>()) {
            let count = match self.node(id) {
                Node::Sum(terms) => {
                    terms.iter().fold(0, |sum: u64, (term, _)| sum.saturating_add(counts[term]))
                }
                Node::Product(factors) => of_product(factors, &counts),
                _ => 1,
            };
            counts.insert(id, count);
        }
        of_product(factors, &counts)
    }
}

/// The function whose derivative is ±`function`.
fn primitive(function: Function) -> Option<Function> {
    match function {
        Function::Sin => Some(Function::Cos),
        Function::Cos => Some(Function::Sin),
        Function::Sinh => Some(Function::Cosh),
        Function::Cosh => Some(Function::Sinh),
        Function::Exp => Some(Function::Exp),
        _ => None,
    }
}
