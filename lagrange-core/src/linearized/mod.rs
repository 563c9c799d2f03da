//! Derivatives of the motion by the initial state, parameters and time: Jacobians, sensitivities, equilibria,
//! linearization.

#[cfg(feature = "alloc")]
mod argument;
pub(crate) mod bodies;
mod contract;
#[cfg(feature = "alloc")]
mod discrete;
#[cfg(feature = "alloc")]
mod equilibrium;
#[cfg(feature = "alloc")]
mod inverse;
mod jacobian;
#[cfg(feature = "alloc")]
mod linearization;
#[cfg(feature = "alloc")]
mod lyapunov;
#[cfg(any(feature = "std", feature = "libm"))]
mod radau;
#[cfg(feature = "alloc")]
mod sensitivity;
#[cfg(feature = "alloc")]
mod singular;
mod state_derivatives;
mod tangent;
#[cfg(feature = "alloc")]
mod variation;

#[cfg(feature = "parquet")]
pub(crate) use argument::check_parameters;
#[cfg(feature = "alloc")]
pub(crate) use argument::set_parameter;
pub use bodies::MotionGradients;
pub use contract::Linearized;
#[cfg(feature = "alloc")]
pub use discrete::DiscreteTime;
#[cfg(feature = "alloc")]
pub use equilibrium::Equilibrium;
#[cfg(feature = "alloc")]
pub use inverse::{BaseParameters, InverseDynamics, Regressor};
#[cfg(feature = "alloc")]
pub use jacobian::SelectedJacobian;
pub use jacobian::{Jacobian, PartialDerivatives};
#[cfg(feature = "alloc")]
pub(crate) use linearization::eigenvalues;
#[cfg(feature = "alloc")]
pub use linearization::{Linearization, LocalCoordinates, Stability};
#[cfg(feature = "alloc")]
pub use lyapunov::LyapunovSpectrum;
#[cfg(any(feature = "std", feature = "libm"))]
pub use radau::{Collocation, Radau, RadauMemory, RadauStages};
#[cfg(feature = "alloc")]
pub use sensitivity::{
    DifferentiableEvent, DualSample, MotionDerivatives, OverDuals, SampledSensitivity, StateSensitivity,
    TrajectorySensitivity,
};
#[cfg(feature = "alloc")]
pub(crate) use singular::Singular;
pub use state_derivatives::StateDerivatives;
#[cfg(feature = "alloc")]
pub use variation::DifferentiableMethod;
