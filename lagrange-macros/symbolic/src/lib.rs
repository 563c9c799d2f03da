//! Symbolic mathematics without mechanics, for `lagrange-derive`: a hash-consed graph of expressions, with derivatives
//! and values.
//!
//! Nodes are only ever added, operands before the nodes that use them. A loop in order of [`Id`] therefore visits leaves
//! first, and no algorithm needs recursion.

#![allow(
    missing_docs,
    clippy::len_without_is_empty,
    reason = "made for one user, `lagrange-derive`: documented is what its names do not say"
)]

mod antiderivative;
mod combined;
mod differentiate;
mod elimination;
mod evaluate;
mod fraction;
mod graph;
mod monomials;
mod nested;
mod polynomial;
mod random;
mod rational;
mod rebuild;
mod round_off;
mod rounded;
mod sample;
mod scaled;
mod simplify;
mod wave;
mod wide;
mod zero;

pub use differentiate::{Forward, MOST_PARTIALS};
pub use elimination::{rank, solve};
pub use evaluate::Approximate;
pub use graph::{External, Fault, Function, Graph, Id, Node, Symbol};
pub use monomials::{Atom, Monomial, Polynomial, common};
pub use polynomial::{ExactPolynomial, Polynomials};
pub use random::{drawn, random};
pub use rational::{Rational, plus, power, square_root, times};
pub use round_off::RoundOff;
pub use sample::Sample;
pub use scaled::{Scaled, finite_decimal, parse_decimal};
pub use simplify::Parity;
pub use wave::superposition;
pub use wide::to_f64;
pub use zero::Verdict;
