//! Numerical methods without mechanics: factorizations, iterations and root finding, each once.

pub(crate) mod bracket;
pub(crate) mod ldl;
pub(crate) mod newton;
pub(crate) mod qr;
pub(crate) mod spread;
pub(crate) mod symmetric;
