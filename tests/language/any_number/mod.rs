//! Numbers of bodies that are known when the program runs, each system beside the same one with its number written out.

mod checks;
mod constraints;
mod recursions;
mod sums_in_sums;
mod written_out;
