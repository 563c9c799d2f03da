//! What a motion leaves behind.

mod owned;
