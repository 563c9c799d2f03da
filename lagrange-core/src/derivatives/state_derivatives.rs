//! Trait for derivatives of the equations of motion by the time and the state.

use core::fmt::Debug;

use nalgebra::Const;

use super::MotionGradients;
use super::jacobian::{self, Jacobian};
use crate::error::Error;
use crate::number::{Broadcast, Real, Wide};
use crate::system::pointers::forward;
use crate::system::{Direction, Lagrangian, ResidualChange, Solution, SolutionOf, State, StateOf};

/// A system whose equations of motion can be differentiated by the time and the state, as implicit methods and
/// sensitivities need.
///
/// `#[derive(Lagrangian)]` implements it together with [`Linearized`](crate::Linearized), which adds derivatives by the `P`
/// parameters. The method for stiff systems, [`Radau`](crate::linearized::Radau), requires this trait: `impl<L: StateDerivatives> Method<L> for …`.
#[diagnostic::on_unimplemented(
    message = "the derivatives of the equations of motion of `{Self}` are not known",
    label = "no `StateDerivatives`",
    note = "`#[derive(Lagrangian)]` gives it to every system whose functions (`#[function(…)]`) have one derivative more than the equations of motion need",
    note = "`Radau` needs the derivatives; `Dop853`, `Dopri5` and `RungeKutta4` do not"
)]
pub trait StateDerivatives: Lagrangian {
    /// Plain numbers from which the derivatives of the residual along all directions are computed.
    type Slopes: Copy + Debug;

    /// What the equations of motion depend on, in ascending order: 0 is the time, 1 … N are coordinates, N + 1 … 2N
    /// velocities. Derivatives by the others, as by the place of a free body, are zero. `None` if it is not known.
    ///
    /// ```
    /// use lagrange_core::{StateDerivatives, prelude::*};
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(theta, phi)]
    /// #[lagrangian((theta_dot^2 + sin(theta)^2 * phi_dot^2)/2 + g*cos(theta))]
    /// struct Pendulum { g: f64 }
    ///
    /// // θ, θ̇ and φ̇, not φ.
    /// assert_eq!(Pendulum::STATE_ARGUMENTS, Some(&[1, 3, 4][..]));
    /// ```
    const STATE_ARGUMENTS: Option<&'static [usize]> = None;

    /// Computes the numbers from which the derivatives of the residual along all directions in time and state follow.
    /// Accelerations and multipliers are held at those of `solution`.
    fn residual_slopes(&self, state: &StateOf<Self>, solution: &SolutionOf<Self>) -> Self::Slopes;

    /// Derivative of the residual along a direction, from the [`residual_slopes`](Self::residual_slopes) of a state; on
    /// [`Lanes`](crate::Lanes), along several directions at once.
    fn residual_change_with<S: Broadcast<Self::Scalar>>(
        &self,
        slopes: &Self::Slopes,
        direction: &Direction<S, Self::N>,
    ) -> ResidualChange<S, Self::N, Self::M>;

    /// Derivatives of the inertial forces and the weights of trees of rigid bodies, as part of the slopes; `None` if there
    /// are none apart from the rest.
    fn motion_gradients(slopes: &Self::Slopes) -> Option<&MotionGradients<Self::Scalar, Self::N>> {
        let _ = slopes;
        None
    }

    /// [`residual_change_with`](Self::residual_change_with) without [`motion_gradients`](Self::motion_gradients).
    fn residual_change_beside_gradients<S: Broadcast<Self::Scalar>>(
        &self,
        slopes: &Self::Slopes,
        direction: &Direction<S, Self::N>,
    ) -> ResidualChange<S, Self::N, Self::M> {
        self.residual_change_with(slopes, direction)
    }

    /// Derivatives of the residual by several arguments at once, one argument for each component of `W`: 0 is the time, 1 … N are
    /// the coordinates, N + 1 … 2N the velocities. Components beyond the last argument are zero.
    fn residual_change_by<W: Wide<Self::Scalar>>(
        &self,
        slopes: &Self::Slopes,
        arguments: impl Iterator<Item = usize> + Clone,
    ) -> ResidualChange<W, Self::N, Self::M> {
        let direction = Direction::of_arguments::<Self::Scalar>(arguments.clone());
        let mut change = self.residual_change_beside_gradients(slopes, &direction);
        if let Some(gradients) = Self::motion_gradients(slopes) {
            gradients.add_columns(arguments, &mut change.motion);
        }
        change
    }

    /// Derivative of the residual along one direction in time and state. Accelerations and multipliers are held at
    /// those of `solution`.
    fn residual_change(
        &self,
        state: &StateOf<Self>,
        solution: &SolutionOf<Self>,
        direction: &Direction<Self::Scalar, Self::N>,
    ) -> ResidualChange<Self::Scalar, Self::N, Self::M> {
        self.residual_change_with(&self.residual_slopes(state, solution), direction)
    }

    /// Accelerations and multipliers at a state, with their derivatives by the time, coordinates and velocities,
    /// without parameters.
    ///
    /// ```
    /// use lagrange_core::{StateDerivatives, prelude::*};
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(x)]
    /// #[lagrangian(x_dot^2/2 - k/2 * x^2)]
    /// struct Spring { k: f64 }
    ///
    /// let jacobian = Spring { k: 4.0 }.state_jacobian(&State::at_rest([0.3]))?;
    /// assert_eq!(jacobian.accelerations.q[(0, 0)], -4.0);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// The errors of [`solve`](crate::Simulate::solve); [`Error::DerivativeNotFinite`].
    fn state_jacobian(
        &self,
        state: &StateOf<Self>,
    ) -> Result<Jacobian<Self::Scalar, Self::N, Self::M, Const<0>>, Error>
    where
        Self: Lagrangian<Scalar: Real> + Sized,
    {
        jacobian::state_jacobian(self, state)
    }
}

/// A system behind a reference or a smart pointer has the derivatives of that system.
macro_rules! derivatives_behind {
    ($($pointer:ty),*) => {$(
        #[diagnostic::do_not_recommend]
        impl<L: StateDerivatives> StateDerivatives for $pointer {
            type Slopes = L::Slopes;
            const STATE_ARGUMENTS: Option<&'static [usize]> = L::STATE_ARGUMENTS;

            fn motion_gradients(
                slopes: &Self::Slopes,
            ) -> Option<&MotionGradients<Self::Scalar, L::N>> {
                L::motion_gradients(slopes)
            }

            forward! { @methods
                fn residual_slopes(
                    state: &State<Self::Scalar, L::N>,
                    solution: &Solution<Self::Scalar, L::N, L::M>
                ) -> Self::Slopes;
                fn residual_change_with<S>(
                    slopes: &Self::Slopes,
                    direction: &Direction<S, L::N>
                ) -> ResidualChange<S, L::N, L::M>;
                fn residual_change_beside_gradients<S>(
                    slopes: &Self::Slopes,
                    direction: &Direction<S, L::N>
                ) -> ResidualChange<S, L::N, L::M>;
            }
        }
    )*};
}

derivatives_behind!(&L);
#[cfg(feature = "alloc")]
derivatives_behind!(alloc::boxed::Box<L>, alloc::rc::Rc<L>);
#[cfg(all(feature = "alloc", target_has_atomic = "ptr"))]
derivatives_behind!(alloc::sync::Arc<L>);
