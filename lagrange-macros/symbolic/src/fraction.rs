//! Expressions as one fraction, shortened by equations that hold.

use num_traits::One;

use super::graph::{Graph, Id};
use super::polynomial::{ExactPolynomial, Generator, Polynomials, PowerProduct, divided};
use super::rational::{Rational, times};

impl Polynomials {
    /// Writes an expression without definitions as a fraction of polynomials without a common monomial; `None` if they are too long.
    /// Multiples of `zeros` are added to both where that leaves fewer terms.
    pub fn fraction(&mut self, graph: &mut Graph, root: Id, zeros: &[ExactPolynomial]) -> Option<Id> {
        let whole = self.of(graph, root)?;
        let cleared = self.cleared(&[whole, ExactPolynomial::number(Rational::one())])?;
        let shortened = |part: &ExactPolynomial| {
            zeros.iter().try_fold(part.clone(), |part, zero| self.shortened(part, zero))
        };
        let [above, below] = &cleared.iter().map(shortened).collect::<Option<Vec<_>>>()?[..] else {
            return None;
        };
        let parts = match self.quotient(above, below) {
            Some(quotient) => [quotient, ExactPolynomial::number(Rational::one())],
            None => without_common([above, below]),
        };
        let [above, below] = parts.map(|part| part.node(graph));
        Some(graph.div(above, below))
    }

    /// Adds multiples of a polynomial that is zero, as long as the number of terms shrinks.
    fn shortened(&self, mut part: ExactPolynomial, zero: &ExactPolynomial) -> Option<ExactPolynomial> {
        while let Some(shorter) = self.shorter(&part, zero) {
            part = shorter;
        }
        Some(part)
    }

    /// The polynomial with a multiple of `zero` added, in which a term is cancelled and there are fewer terms.
    fn shorter(&self, part: &ExactPolynomial, zero: &ExactPolynomial) -> Option<ExactPolynomial> {
        let pairs = part.0.iter().flat_map(|term| zero.0.iter().map(move |other| (term, other)));
        pairs.into_iter().find_map(|((monomial, &c), (other, &d))| {
            let factor = ExactPolynomial::term(divided(monomial, other)?, times(c, d.recip())?);
            let shorter = part.plus(&self.times(&factor, zero)?, -Rational::one())?;
            (shorter.0.len() < part.0.len()).then_some(shorter)
        })
    }
}

impl ExactPolynomial {
    /// The expression that the polynomial stands for.
    fn node(&self, graph: &mut Graph) -> Id {
        let power = |&(generator, exponent): &(Generator, u32)| {
            let power = |degree: u32| Rational::new(exponent.into(), degree.into());
            match generator {
                Generator::Node(base) => (base, power(1)),
                Generator::Root(base, degree) => (base, power(degree)),
                Generator::Reciprocal(base, degree) => (base, -power(degree)),
            }
        };
        let terms = self.0.iter().map(|(monomial, &c)| (graph.product(monomial.iter().map(power)), c));
        let terms: Vec<(Id, Rational)> = terms.collect();
        graph.sum(terms)
    }
}

/// Divides polynomials by the monomial that they have in common.
fn without_common(parts: [&ExactPolynomial; 2]) -> [ExactPolynomial; 2] {
    let mut monomials = parts.iter().flat_map(|part| part.0.keys());
    let first = monomials.next().cloned().unwrap_or_default();
    let common = monomials.fold(first, shared);
    parts.map(|part| {
        let terms = part.0.iter().filter_map(|(monomial, &c)| Some((divided(monomial, &common)?, c)));
        ExactPolynomial(terms.collect())
    })
}

/// Greatest common divisor of two monomials.
fn shared(one: PowerProduct, other: &PowerProduct) -> PowerProduct {
    let least = |(generator, exponent): (Generator, u32)| {
        let (_, other) = other.iter().find(|(known, _)| *known == generator)?;
        Some((generator, exponent.min(*other)))
    };
    one.into_iter().filter_map(least).collect()
}
