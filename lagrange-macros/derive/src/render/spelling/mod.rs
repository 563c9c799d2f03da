//! Spellings: the signs, letters, fractions and scripts of each output format.
//!
//! A [`Notation`](super::notation::Notation) composes formulas from these parts, so that all formats follow the same
//! rules.

mod latex;
mod mathml;
mod parts;
mod unicode;

pub(super) use latex::Latex;
pub(super) use mathml::MathMl;
pub(super) use parts::{Spelling, WIDE};
pub(super) use unicode::Unicode;
