//! What a motion leaves behind.

mod audit;
mod endings;
mod owned;
mod table;
mod written;
