//! Derivatives of the equations of motion, as the derive macro writes them, and the Jacobians of the accelerations and
//! multipliers. What they are for is in [`linearized`](crate::linearized).

pub(crate) mod bodies;
mod contract;
pub(crate) mod jacobian;
mod state_derivatives;
pub(crate) mod tangent;

pub use bodies::MotionGradients;
pub use contract::Linearized;
pub use jacobian::Jacobian;
pub use state_derivatives::StateDerivatives;
