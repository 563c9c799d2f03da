//! Accelerations and multipliers at a state: units, dependent constraints, elimination, consistent states.

mod assembly;
mod cancelled_gradients;
mod completion;
mod dependence;
mod elimination;
mod factor;
mod gradients;
mod scales;
mod switched_constraints;
mod undetermined;
