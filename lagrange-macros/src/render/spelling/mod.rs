//! What differs between the ways to write formulas down: signs, letters, and what stands above and below what.
//!
//! A [`Notation`](super::notation::Notation) puts a formula together from these parts, so that all are written by the same rules.

mod latex;
mod mathml;
mod parts;
mod unicode;

pub(super) use latex::Latex;
pub(super) use mathml::MathMl;
pub(super) use parts::{Spelling, WIDE};
pub(super) use unicode::Unicode;
