//! Contacts in steps of one length.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod abuse;
mod convergence;
mod law;
mod tower;
