//! What can be written in the attributes, and how it is read.

mod accepted;
mod any_number;
mod frames;
mod functions;
mod long_functions;
mod members;
mod pictures;
mod shapes;
mod tables;

// Expressions that take long to derive, and long motions.
#[cfg(feature = "thorough")]
mod deep;
#[cfg(feature = "thorough")]
mod tabulated;
