//! Motions that are steered, limited in time, and given broken input.

mod allocations;
mod faults;
mod saturation;
mod steered;
mod times;
