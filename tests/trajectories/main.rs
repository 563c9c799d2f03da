//! What a motion leaves behind.

mod audit;
mod endings;
mod owned;
mod pointers;
mod table;
mod written;
