//! Derivatives of the motion by the initial state, parameters and time: Jacobians, sensitivities, equilibria,
//! linearization.

pub(crate) mod argument;
mod discrete;
pub(crate) mod equilibrium;
pub(crate) mod inverse;
mod limits;
pub(crate) mod linearization;
pub(crate) mod lyapunov;
#[cfg(any(feature = "std", feature = "libm"))]
mod radau;
mod selected;
mod sensitivity;
mod variation;

pub use crate::derivatives::jacobian::{Jacobian, PartialDerivatives};
pub use crate::derivatives::{Linearized, MotionGradients, StateDerivatives};
pub(crate) use crate::numerics::singular::Singular;
pub use discrete::DiscreteTime;
pub use equilibrium::Equilibrium;
pub use inverse::{BaseParameters, InverseDynamics, Regressor};
pub(crate) use linearization::eigenvalues;
pub use linearization::{Linearization, LocalCoordinates, Stability};
pub use lyapunov::LyapunovSpectrum;
#[cfg(any(feature = "std", feature = "libm"))]
pub use radau::{Collocation, Radau, RadauMemory, RadauStages};
pub use selected::SelectedJacobian;
pub(crate) use selected::jacobian_by;
pub use sensitivity::{
    DifferentiableEvent, DualSample, MotionDerivatives, OverDuals, SampledSensitivity, StateSensitivity,
    TrajectorySensitivity,
};
pub use variation::DifferentiableMethod;
