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

#[cfg(feature = "alloc")]
pub(crate) use self::tangent::WideOf;
#[cfg(feature = "alloc")]
pub(crate) use self::{argument::set_parameter, linearization::eigenvalues, singular::Singular};
#[cfg(feature = "alloc")]
pub use self::{
    discrete::DiscreteTime,
    equilibrium::Equilibrium,
    inverse::{BaseParameters, InverseDynamics, Regressor},
    jacobian::SelectedJacobian,
    linearization::{Linearization, LocalCoordinates, Stability},
    lyapunov::LyapunovSpectrum,
    sensitivity::{
        DifferentiableEvent, DualSample, MotionDerivatives, OverDuals, SampledSensitivity, StateSensitivity,
        TrajectorySensitivity,
    },
    variation::DifferentiableMethod,
};
#[cfg(feature = "parquet")]
pub(crate) use argument::check_parameters;
pub use bodies::MotionGradients;
pub use contract::Linearized;
pub use jacobian::{Jacobian, PartialDerivatives};
#[cfg(any(feature = "std", feature = "libm"))]
pub use radau::{Collocation, Radau, RadauMemory, RadauStages};
pub use state_derivatives::StateDerivatives;
