//! What the derive takes: the outermost of what is right.

mod deep;
mod forms;
mod numbers;
mod unit_struct;
mod unused_fields;
