//! What a motion leaves behind.

mod endings;
mod owned;
mod table;
mod written;
