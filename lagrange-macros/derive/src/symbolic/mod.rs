//! Symbolic mathematics without mechanics: a hash-consed graph of expressions, with derivatives and values.
//!
//! This module is independent of tokens and Lagrangians. Nodes are only ever added, operands before the nodes that use
//! them. A loop in order of [`Id`] therefore visits leaves first, and no algorithm needs recursion.

mod antiderivative;
mod combined;
mod differentiate;
mod elimination;
mod evaluate;
mod graph;
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
#[cfg(test)]
mod tests;
mod wave;
mod wide;
mod zero;

pub(crate) use differentiate::Forward;
pub(crate) use elimination::{rank, solve};
pub(crate) use evaluate::Approximate;
pub(crate) use graph::{External, Fault, Function, Graph, Id, Node, Symbol};
pub(crate) use polynomial::{ExactPolynomial, Polynomials};
pub(crate) use random::{drawn, random};
pub(crate) use rational::{Rational, plus, power, square_root, times};
pub(crate) use round_off::RoundOff;
pub(crate) use sample::Sample;
pub(crate) use scaled::{Scaled, finite_decimal, parse_decimal};
pub(crate) use simplify::Parity;
#[cfg(test)]
pub(crate) use tests::{double::Double, tree::apply};
#[cfg(test)]
pub(crate) use wave::superposition;
pub(crate) use wide::to_f64;
pub(crate) use zero::Verdict;
