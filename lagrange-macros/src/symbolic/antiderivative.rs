//! Antiderivatives where a term is a constant times f(u) ∂u/∂x; none elsewhere.

use num_traits::{One, Signed};

use super::differentiate::Forward;
use super::graph::{External, Function, Graph, Id, Node, Symbol};
use super::rational::Rational;

/// The greatest power of a sum that is multiplied out.
const EXPANDED: i128 = 4;

impl Graph {
    /// A function whose derivative by `symbol` is `root`, if it is found.
    pub(crate) fn antiderivative(&mut self, root: Id, symbol: Symbol) -> Option<Id> {
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
        let integrand = self.product(varying.iter().copied());
        let integral = self.substitute(&varying, integrand, symbol);
        let integral = integral.or_else(|| self.multiply_out(&varying, symbol))?;
        let constant = self.product(constant);
        Some(self.mul(constant, integral))
    }

    /// Tries the antiderivative of each factor, as a function of what is inside of it, in turn.
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

    /// Functions that are antiderivatives of base ^ exponent, but for a factor, by something.
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
        found.push(if exponent == -Rational::one() {
            let magnitude = self.function(Function::Abs, base);
            self.function(Function::Ln, magnitude)
        } else {
            self.pow(base, exponent + Rational::one())
        });
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

    /// (Σ term) ^ n · rest = Σ term · (Σ term) ^ (n − 1) · rest
    fn multiply_out(&mut self, factors: &[(Id, Rational)], symbol: Symbol) -> Option<Id> {
        let is_sum = |&(factor, exponent): &(Id, Rational)| {
            let expands = exponent.is_integer()
                && exponent.is_positive()
                && exponent <= Rational::from_integer(EXPANDED);
            expands && matches!(self.node(factor), Node::Sum(terms) if terms.len() > 1)
        };
        let position = factors.iter().position(is_sum)?;
        let mut rest = factors.to_vec();
        let Node::Sum(terms) = self.node(rest[position].0).clone() else { return None };
        rest[position].1 -= Rational::one();
        let rest = self.product(rest);
        self.integrate_terms(&terms, rest, symbol)
    }
}

/// The function whose derivative is `function`, but for the sign.
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
