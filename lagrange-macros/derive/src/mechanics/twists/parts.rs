//! Sums of generalized forces conjugate to each velocity.

use super::components::Twists;
use crate::resolve::Triple;
use crate::symbolic::{Graph, Id, Rational};

/// For each velocity, the generalized force conjugate to it, as a sum of terms.
pub(super) struct TwistParts(pub(super) Vec<Vec<(Id, Rational)>>);

impl TwistParts {
    pub(super) fn add(&mut self, number: usize, part: Id, sign: i128) {
        if part != Id::ZERO {
            self.0[number].push((part, Rational::from_integer(sign)));
        }
    }

    pub(super) fn sums(self, graph: &mut Graph) -> Vec<Id> {
        self.0.into_iter().map(|terms| graph.sum(terms)).collect()
    }
}

impl Twists<'_> {
    pub(super) fn nothing(&self) -> TwistParts {
        TwistParts(vec![Vec::new(); self.velocities.nodes.len()])
    }

    /// Adds `weight` times the component `axis` of `vector` × ξ, where the displacement ξ has the rate `of`:
    /// each component of ξ contributes to the force conjugate to its rate.
    pub(super) fn across(
        &self,
        graph: &mut Graph,
        weight: Id,
        (axis, vector): (usize, Triple),
        of: Triple,
        parts: &mut TwistParts,
    ) {
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        for (from, to, sign) in [(b, c, 1), (c, b, -1)] {
            if let Some(&number) = self.numbers.get(&of[to]) {
                let part = graph.mul(weight, vector[from]);
                parts.add(number, part, sign);
            }
        }
    }

    /// Adds one product for each component of a displacement with the rate `of`, to the force conjugate to
    /// that component.
    pub(super) fn along(
        &self,
        graph: &mut Graph,
        products: [(Id, Id); 3],
        of: Triple,
        parts: &mut TwistParts,
    ) {
        for ((x, y), node) in products.into_iter().zip(of) {
            if let Some(&number) = self.numbers.get(&node) {
                let part = graph.mul(x, y);
                parts.add(number, part, 1);
            }
        }
    }
}
