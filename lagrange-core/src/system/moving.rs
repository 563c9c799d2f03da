//! The trait [`System`]: what moves, as its accelerations.

use crate::number::Scalar;
use crate::vector::{Length, StaticLength, ViewOf};

/// A system that moves: the number of its coordinates, and their accelerations.
///
/// `#[derive(Lagrangian)]` implements it, also for [any number of bodies](crate::language#any-number-of-bodies). An implementation by
/// hand states a system whose accelerations are computed by functions of its own. Such a system is integrated by `Dop853`, `Dopri5` and other
/// [pairs](crate::motion::Pair), by `RungeKutta4`, and, if it has the marker
/// [`VelocityFreeForces`](crate::structure::VelocityFreeForces), by `Verlet` and its compositions, with events, samples, quantities,
/// controllers and progress. [Ensembles](crate::Ensemble) of it are integrated one by one; their members may have different numbers of
/// coordinates. It has no energy, and its coordinates are called `q[0]`, `q[1]`, … in
/// messages, lookup and tables; [`ManyBodies`](crate::ManyBodies) have an energy and names. Constraints are the business of its accelerations. Steps allocate nothing; dense output of
/// a run-time length allocates once for each step in which it is evaluated.
///
/// ```
/// use lagrange_core::motion::AccelerationField;
/// use lagrange_core::nalgebra::{Const, DVector, Dyn};
/// use lagrange_core::{System, generic, prelude::*};
///
/// /// A chain of equal masses and springs between two walls.
/// struct Chain { masses: usize, k: f64 }
///
/// impl System for Chain {
///     type Scalar = f64;
///     type Length = Dyn;
///     type M = Const<0>;
///     type Field = AccelerationField;
///
///     fn length(&self) -> Dyn {
///         Dyn(self.masses)
///     }
///
///     fn accelerations(&self, _t: f64, q: &[f64], _v: &[f64], a: &mut [f64]) {
///         let at = |i: usize| q.get(i).copied().unwrap_or(0.0);
///         for (i, a) in a.iter_mut().enumerate() {
///             *a = self.k * (at(i.wrapping_sub(1)) - 2.0 * q[i] + at(i + 1));
///         }
///     }
/// }
///
/// // The middle one of three masses is plucked. Its motion is the mean of cos ωt of the first mode and of the third.
/// let chain = Chain { masses: 3, k: 2.0 };
/// let start = generic::State { t: 0.0, q: DVector::from_vec(vec![0.0, 1.0, 0.0]), v: DVector::zeros(3) };
/// let path = chain.integrate(start, 5.0, Dop853::default())?;
/// let [first, third] = [2.0_f64.sqrt(), -2.0_f64.sqrt()].map(|x| (2.0 * (2.0 - x)).sqrt());
/// let middle = ((first * 5.0).cos() + (third * 5.0).cos()) / 2.0;
/// assert!((path.end().state().q[1] - middle).abs() < 1e-7);
/// # Ok::<(), Error>(())
/// ```
///
/// A constant length is a `Const<N>`, and its slices are arrays, `q: &[f64; N]`: steps of few coordinates are then faster, and states
/// are `Copy`. Above a thousand coordinates take a run-time length: arrays are on the stack.
pub trait System {
    /// Number type of the parameters and the state.
    type Scalar: Scalar;

    /// Number of the generalized coordinates, the length of q: [`Const<2>`](nalgebra::Const) for two,
    /// [`Dyn`](nalgebra::Dyn) for a number known when the program runs.
    type Length: Length;

    /// Number of the multipliers λ, one for each scalar constraint. A system that is stated by its accelerations has none:
    /// [`Const<0>`](nalgebra::Const).
    type M: StaticLength;

    /// Equations of motion: [`AccelerationField`](crate::motion::AccelerationField) if they are stated by
    /// [`accelerations`](Self::accelerations) alone.
    type Field;

    /// Number of the generalized coordinates.
    fn length(&self) -> Self::Length;

    /// Writes the generalized accelerations q̈ at the time `t`, the coordinates `q` and the velocities `v` to `a`, all of the length
    /// [`length`](Self::length). Before the call `a` may hold anything: write every entry, and do not add
    /// to one. An entry that is NaN ends the motion.
    fn accelerations(
        &self,
        t: Self::Scalar,
        q: &ViewOf<Self::Scalar, Self::Length>,
        v: &ViewOf<Self::Scalar, Self::Length>,
        a: &mut ViewOf<Self::Scalar, Self::Length>,
    );
}
