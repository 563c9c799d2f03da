//! Contacts in steps of one length.

mod abuse;
mod frames;
mod grips;
mod holds;
mod landing;
mod law;

#[cfg(feature = "thorough")]
mod convergence;
#[cfg(feature = "thorough")]
mod law_between_bodies;
mod stiff;
#[cfg(feature = "thorough")]
mod tower;
