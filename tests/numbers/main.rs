//! One derive on every number type, and the forms that a struct may take.

// Greek coordinates beside Latin parameters.
#![allow(mixed_script_confusables)]

mod forms;
mod lanes_and_dual_numbers;
mod names;
mod places;
