//! Numerical methods without mechanics: factorizations, iterations and root finding, each once.

#[cfg(feature = "alloc")]
pub(crate) mod bare;
pub(crate) mod bracket;
#[cfg(feature = "alloc")]
pub(crate) mod francis;
pub(crate) mod ldl;
#[cfg(feature = "alloc")]
pub(crate) mod least_norm;
#[cfg(feature = "alloc")]
mod limits;
#[cfg(feature = "alloc")]
pub(crate) mod lu;
pub(crate) mod newton;
pub(crate) mod qr;
#[cfg(feature = "alloc")]
pub(crate) mod singular;
pub(crate) mod spread;
pub(crate) mod symmetric;
