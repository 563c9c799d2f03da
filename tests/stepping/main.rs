//! Contacts in steps of one length.

// What helps tests may panic as they do.
#![allow(clippy::unwrap_used)]

mod convergence;
mod tower;
