//! Contacts in steps of one length.

mod abuse;
mod law;

#[cfg(feature = "thorough")]
mod convergence;
#[cfg(feature = "thorough")]
mod law_between_bodies;
#[cfg(feature = "thorough")]
mod tower;
