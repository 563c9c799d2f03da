//! The Lagrangian L + Σ σ_a c_a²/2, where c_a = F_a q̇ + b_a are the constraints that complete M.
//!
//! It has the motions and the multipliers of L: what the square adds to the equations of motion has c_a or its rate as a
//! factor, and both are zero along a motion.

use num_traits::One;

use crate::mechanics::constraints::Constraints;
use crate::mechanics::euler_lagrange::Momenta;
use crate::symbolic::{Graph, Id, Rational};
use crate::variables::{Variable, symbols};

/// Momenta, their rates ∂L/∂q + Q, and the mass matrix of the completed Lagrangian where c_a = 0.
#[derive(Debug)]
pub(crate) struct Completed {
    pub(crate) momentum: Vec<Id>,
    pub(crate) rate: Vec<Id>,
    pub(crate) mass: Vec<Vec<Id>>,
}

impl Completed {
    /// Adds the squares of the constraints `completing`, each with its σ. `None` if there are none.
    pub(in crate::mechanics) fn of(
        graph: &mut Graph,
        (momenta, mass): (&Momenta, &[Vec<Id>]),
        constraints: &Constraints,
        completing: &[(usize, Id)],
    ) -> Option<Self> {
        if completing.is_empty() {
            return None;
        }
        let n = mass.len();
        let mut squares = Id::ZERO;
        let mut mass = mass.to_vec();
        for &(a, weight) in completing {
            let square = graph.square(constraints.rate[a]);
            let weighted = graph.mul(weight, square);
            squares = graph.sum([(squares, Rational::one()), (weighted, Rational::new(1, 2))]);
            add_product(graph, &mut mass, weight, &constraints.jacobian[a]);
        }
        let both = [symbols(n, Variable::Coordinate), symbols(n, Variable::Velocity)].concat();
        let mut gradient = graph.gradient(squares, &both);
        let of_momenta = gradient.split_off(n);
        let mut sums = |terms: &[Id], more: &[Id]| -> Vec<Id> {
            terms.iter().zip(more).map(|(&term, &more)| graph.add(term, more)).collect()
        };
        let (momentum, rate) = (sums(&momenta.momentum, &of_momenta), sums(&momenta.rate, &gradient));
        Some(Self { momentum, rate, mass })
    }
}

/// Adds σ FᵀF of one row F.
fn add_product(graph: &mut Graph, mass: &mut [Vec<Id>], weight: Id, row: &[Id]) {
    for (i, entries) in mass.iter_mut().enumerate() {
        let weighted = graph.mul(weight, row[i]);
        for (entry, &other) in entries.iter_mut().zip(row) {
            let product = graph.mul(weighted, other);
            *entry = graph.add(*entry, product);
        }
    }
}
