//! Orbits that close: the monodromy matrix and its multipliers, periodic orbits, and families of them.
//!
//! [`PeriodicMotion`] is the way in, a trait of every [`Linearized`] system over `f64` or `f32`.

mod arc;
mod bifurcation;
mod branch_point;
mod conditions;
mod correction;
mod cubic;
mod diagnosis;
mod digits;
mod error;
mod family;
mod form;
mod frame;
mod limits;
mod location;
mod monodromy;
mod multipliers;
mod orbit;
mod search;
mod segment;
mod shot;
mod table;
mod tracing;

pub use bifurcation::{Bifurcation, BifurcationKind};
pub use error::OrbitError;
pub use family::FamilySearch;
pub use monodromy::Monodromy;
pub use orbit::PeriodicOrbit;
pub use search::OrbitSearch;
pub use table::{Family, FamilyEnding, LostBifurcation};

use crate::StateOf;
use crate::error::Error;
use crate::linearized::{DifferentiableMethod, Linearized, MotionDerivatives, StateSensitivity};
use crate::number::Real;
use crate::system::lookup;

/// Monodromy matrices and periodic orbits of every [`Linearized`] system over `f64` or `f32`.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// #[derive(Clone, Lagrangian)]
/// #[coordinates(x, y)]
/// #[lagrangian((x_dot^2 + y_dot^2)/2 + 1/sqrt(x^2 + y^2))]
/// struct Planet;
///
/// // Once around an ellipse.
/// let start = State::new([0.5, 0.0], [0.0, 3.0_f64.sqrt()]);
/// let around = Planet.monodromy(&start, std::f64::consts::TAU, Dop853::with_tolerance(1e-13))?;
/// assert_eq!(around.matrix().shape(), (4, 4));
/// assert!(around.symplectic_error() < 1e-12);
/// # Ok::<(), Error>(())
/// ```
pub trait PeriodicMotion: Linearized<Scalar: Real> + Sized {
    /// Monodromy matrix ∂(q, q̇)/∂(q, q̇) of the motion from a state to the time `end`. Methods are those of
    /// [`integrate_sensitivities`](Linearized::integrate_sensitivities).
    ///
    /// # Errors
    /// Those of [`integrate_sensitivities`](Linearized::integrate_sensitivities), and of
    /// [`linearize`](Linearized::linearize) at the start, which must satisfy the constraints.
    fn monodromy<D: DifferentiableMethod<Self>>(
        &self,
        start: &StateOf<Self>,
        end: Self::Scalar,
        method: D,
    ) -> Result<Monodromy<Self::Scalar>, Error> {
        let names = lookup::entries::<Self>();
        let names: alloc::vec::Vec<&str> = names.iter().map(|name| &**name).collect();
        let motion = self.integrate_sensitivities(*start, end, method, &names)?;
        monodromy::across(self, start, motion.derivatives_at_end()?)
    }

    /// Monodromy matrix of a motion across events, resets and impacts, from its derivatives at the end. The derivatives are those of
    /// [`motion_with_derivatives`](MotionDerivatives::motion_with_derivatives) or of a
    /// [`Trajectory`](crate::Trajectory::sensitivity) by all coordinates and velocities.
    ///
    /// Where the motion ends at an event, the matrix is that of the map from the start to the event (Poincaré's map).
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(y)]
    /// #[lagrangian(y_dot^2/2 - g*y)]
    /// struct Flying { g: f64 }
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(y)]
    /// #[lagrangian(y_dot^2/2 - g*y)]
    /// #[constraint(floor: y = 0)]
    /// struct Touching { g: f64 }
    ///
    /// // A ball that bounces without loss, from the top to the top.
    /// let (ball, floor) = (Flying { g: 9.81 }, Touching { g: 9.81 });
    /// let top = State::at_rest([1.0]);
    /// let lands = ball.differentiable_event("lands", |sample| sample.coordinate("y")).falling().terminal();
    /// let start = ball.sensitivity(&top, &["y", "y_dot"])?;
    /// let fall = ball.motion_with_derivatives(&start).event(lands).towards(10.0)?;
    /// let bounce = floor.impact_sensitivity(fall.derivatives_at_end()?, "floor", ("e", 1.0))?;
    /// let period = 2.0 * bounce.state.t;
    /// let rise = ball.motion_with_derivatives(&bounce).to(period)?;
    /// let around = ball.monodromy_across(&top, rise.derivatives_at_end()?)?;
    /// assert!(around.symplectic_error() < 1e-9);
    /// // A higher bounce takes longer: after one period it is later by 4 δy √(1/2gh).
    /// assert!((around.matrix()[(1, 0)] - 9.81 * 2.0 * (0.5_f64 / 9.81).sqrt()).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::UnknownName`] if the derivatives lack an entry of the state; those of [`linearize`](Linearized::linearize) at the
    /// start.
    fn monodromy_across(
        &self,
        start: &StateOf<Self>,
        end: &StateSensitivity<Self::Scalar, Self::N>,
    ) -> Result<Monodromy<Self::Scalar>, Error> {
        monodromy::across(self, start, end)
    }

    /// Starts the settings of a search for a periodic orbit near a state: what is known of its period, its symmetry, its energy, and
    /// by which method and in how many segments it is computed. [`find`](OrbitSearch::find) searches.
    ///
    /// ```
    /// use lagrange_core::prelude::*;
    ///
    /// #[derive(Clone, Lagrangian)]
    /// #[coordinates(theta)]
    /// #[lagrangian(theta_dot^2/2 + cos(theta))]
    /// struct Pendulum;
    ///
    /// // Released at 1 rad; its period is 4 K(sin ½).
    /// let guess = State::at_rest([1.0]);
    /// let swing = Pendulum.periodic_orbit(&guess).period_near(6.6).energy(-(1.0_f64.cos())).find()?;
    /// assert!((swing.period - 6.699_975_664_370_453).abs() < 1e-11);
    /// assert!(swing.error < 1e-11);
    /// # Ok::<(), Error>(())
    /// ```
    fn periodic_orbit(&self, guess: &StateOf<Self>) -> OrbitSearch<Self>
    where
        Self: Clone,
    {
        OrbitSearch::new(self, guess)
    }
}

impl<L: MotionDerivatives> PeriodicMotion for L {}
