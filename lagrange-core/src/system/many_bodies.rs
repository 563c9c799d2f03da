//! The trait [`ManyBodies`]: systems whose number of bodies is known when the program runs.

use alloc::vec::Vec;
use core::fmt;

use nalgebra::{Const, DVector, Dyn};

use super::moving::System;
use super::state::State;
use crate::error::Error;
use crate::number::{Real, Scalar};
use crate::solution::consistent::Consistent;
use crate::solution::many_body_field::ManyBodyField;
use crate::solution::many_constraints::{self, ConstraintRows, Correction};
use crate::solution::system_checks::SystemChecks;

/// A system of any number of bodies, as `#[derive(Lagrangian)]` emits it where the length of a coordinate has a name
/// ([the language](crate::language#any-number-of-bodies)).
///
/// It moves as every [`System`] of a run-time length, and has names of coordinates, momenta and an energy:
///
/// ```
/// use lagrange_core::prelude::*;
///
/// /// Masses on springs of stiffness `k`, each to its own wall.
/// #[derive(Lagrangian)]
/// #[coordinates(x: [n])]
/// #[parameter(m: [n])]
/// #[lagrangian(sum(i in 0..n, m[i]*x_dot[i]^2/2 - k*x[i]^2/2))]
/// struct Springs { m: Vec<f64>, k: f64 }
///
/// let springs = Springs { m: vec![1.0, 4.0], k: 4.0 };
/// let start = springs.state([1.0, 1.0], [0.0, 0.5]);
/// assert_eq!(springs.energy(&start), 4.5);
/// assert_eq!(springs.momenta(&start).as_slice(), [0.0, 2.0]);
/// const { assert!(Springs::ENERGY_IS_CONSERVED) };
/// # Ok::<(), Error>(())
/// ```
///
/// The same by hand, which is not needed often:
///
/// ```
/// use core::fmt;
/// use lagrange_core::motion::ManyBodyField;
/// use lagrange_core::nalgebra::{Const, DVector, Dyn};
/// use lagrange_core::{ManyBodies, System, generic, prelude::*};
///
/// type State = generic::State<f64, Dyn>;
///
/// /// Masses on springs of stiffness `k`, each to its own wall.
/// struct Springs { m: Vec<f64>, k: f64 }
///
/// impl System for Springs {
///     type Scalar = f64;
///     type Length = Dyn;
///     type M = Const<0>;
///     type Field = ManyBodyField;
///
///     fn length(&self) -> Dyn {
///         Dyn(self.m.len())
///     }
///
///     fn accelerations(&self, _t: f64, q: &[f64], _v: &[f64], a: &mut [f64]) {
///         (0..q.len()).for_each(|i| a[i] = -self.k * q[i] / self.m[i]);
///     }
/// }
///
/// impl ManyBodies for Springs {
///     const ENERGY_IS_CONSERVED: bool = true;
///     const DIGEST: u32 = 0;
///
///     fn write_name(&self, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result {
///         write!(to, "x[{coordinate}]")
///     }
///
///     fn check(&self) -> Result<(), Error> {
///         Ok(())
///     }
///
///     fn visit_numbers(&self, visit: &mut dyn FnMut(f64)) {
///         self.m.iter().chain([&self.k]).for_each(|x| visit(*x));
///     }
///
///     fn lagrangian(&self, state: &State) -> f64 {
///         self.momenta(state).dot(&state.v) / 2.0 - self.k * state.q.norm_squared() / 2.0
///     }
///
///     fn energy(&self, state: &State) -> f64 {
///         self.momenta(state).dot(&state.v) / 2.0 + self.k * state.q.norm_squared() / 2.0
///     }
///
///     fn momenta(&self, state: &State) -> DVector<f64> {
///         DVector::from_fn(self.m.len(), |i, _| self.m[i] * state.v[i])
///     }
/// }
///
/// let springs = Springs { m: vec![1.0, 4.0], k: 4.0 };
/// let start = State { t: 0.0, q: DVector::from_vec(vec![1.0, 1.0]), v: DVector::zeros(2) };
/// let path = springs.integrate(start, 3.0, Dop853::default())?;
/// assert!((path.end().coordinate("x[1]")? - 3.0_f64.cos()).abs() < 1e-7);
/// assert!((path.end().energy() - 4.0).abs() < 1e-7);
/// assert!(path.csv(10).energy().to_string().starts_with("t,x[0],x[1],x_dot[0],x_dot[1],energy\n"));
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no system of any number of bodies",
    note = "put `#[derive(Lagrangian)]` on the struct, with an array of coordinates whose length is a field: `#[coordinates(r: [n, 3])]`"
)]
pub trait ManyBodies: System<Length = Dyn, M = Const<0>, Field = ManyBodyField> {
    /// True if the energy is conserved, as the derivation proved.
    const ENERGY_IS_CONSERVED: bool;

    /// True if the system has [constraints](Self::constraints).
    const HAS_CONSTRAINTS: bool = false;

    /// Hash of the struct and of the attributes that determine its motion; 0 for a manual implementation.
    const DIGEST: u32;

    /// Writes the name of a coordinate: `r[3][1]`.
    ///
    /// # Errors
    /// Those of `to`.
    fn write_name(&self, coordinate: usize, to: &mut dyn fmt::Write) -> fmt::Result;

    /// Checks the lengths of the fields, and indices in tables, when a motion starts and after each change of the system.
    ///
    /// # Errors
    /// [`Error::FieldLength`], [`Error::FieldIndex`] and [`Error::ElementMissing`].
    fn check(&self) -> Result<(), Error>;

    /// Calls `visit` with the numbers of all fields, for the fingerprints of [ensembles](crate::ensemble).
    fn visit_numbers(&self, visit: &mut dyn FnMut(Self::Scalar));

    /// Lagrangian L(t, q, q̇).
    fn lagrangian(&self, state: &State<Self::Scalar, Dyn>) -> Self::Scalar;

    /// Energy function E = p·q̇ − L.
    fn energy(&self, state: &State<Self::Scalar, Dyn>) -> Self::Scalar;

    /// Generalized momenta p = ∂L/∂q̇.
    fn momenta(&self, state: &State<Self::Scalar, Dyn>) -> DVector<Self::Scalar>;

    /// Writes the accelerations without the forces of constraints, as [`accelerations`](System::accelerations) writes those with them.
    /// Without constraints they are the same.
    fn free_accelerations(
        &self,
        t: Self::Scalar,
        q: &[Self::Scalar],
        v: &[Self::Scalar],
        a: &mut [Self::Scalar],
    ) where
        Self: Sized,
    {
        self.accelerations(t, q, v, a);
    }

    /// Divides a vector of forces by the mass matrix. A system without constraints needs no such method.
    fn divide_by_masses(
        &self,
        _t: Self::Scalar,
        _q: &[Self::Scalar],
        _v: &[Self::Scalar],
        _forces: &mut [Self::Scalar],
    ) {
    }

    /// States the constraints at a state, row by row. Without this method there are none.
    fn constraints(
        &self,
        _t: Self::Scalar,
        _q: &[Self::Scalar],
        _v: &[Self::Scalar],
        _rows: &mut ConstraintRows<Self::Scalar>,
    ) {
    }

    /// Adds M⁻¹ Fᵀ λ to `x`, so that it satisfies the constraints at a state, and writes the multipliers. Returns the smallest ratio of a
    /// pivot of F M⁻¹ Fᵀ to its diagonal entry: how many digits are left.
    ///
    /// This method serves any constraints; generated code overrides it where they are between neighbours along an array.
    fn correct(
        &self,
        at: (Self::Scalar, &[Self::Scalar], &[Self::Scalar]),
        target: Correction,
        results: (&mut [Self::Scalar], &mut Vec<Self::Scalar>),
    ) -> Self::Scalar
    where
        Self: Sized,
    {
        many_constraints::correct(self, at, target, results)
    }

    /// Writes the name of a constraint: `rod[3]`.
    ///
    /// # Errors
    /// Those of `to`.
    fn write_constraint_name(&self, _constraint: usize, _to: &mut dyn fmt::Write) -> fmt::Result {
        Ok(())
    }

    /// Multipliers λ of the constraints at a state that satisfies them, in the order of the attributes and, for each, of its elements.
    ///
    /// # Errors
    /// [`Error::Dependent`], [`Error::NoGradient`] and [`Error::EquationsNotFinite`]; [`Error::StateLength`] and those of
    /// [`check`](Self::check); [`Error::StateNotFinite`].
    fn multipliers(&self, state: &State<Self::Scalar, Dyn>) -> Result<DVector<Self::Scalar>, Error>
    where
        Self: Sized,
        Self::Scalar: Real,
    {
        <ManyBodyField as SystemChecks<Self>>::check_entries(self, state)?;
        many_constraints::multipliers(self, state)
    }

    /// Projects a state onto the constraints by Newton's method: the coordinates onto those that are holonomic, then the velocities onto
    /// all. Each correction is the least in the metric of the mass matrix. Returns the state and its displacement.
    ///
    /// # Errors
    /// [`Error::NotProjected`], and those of [`multipliers`](Self::multipliers).
    fn project(&self, state: &State<Self::Scalar, Dyn>) -> Result<Consistent<Self::Scalar, Dyn>, Error>
    where
        Self: Sized,
        Self::Scalar: Real,
    {
        <ManyBodyField as SystemChecks<Self>>::check_entries(self, state)?;
        many_constraints::make_consistent(self, state)
    }

    /// State at t = 0 with these coordinates and velocities, in the order of their names: `r[0][0]`, `r[0][1]`, …. Their numbers are
    /// compared with the [length](System::length) of the system when a motion starts.
    fn state(
        &self,
        q: impl IntoIterator<Item = Self::Scalar>,
        v: impl IntoIterator<Item = Self::Scalar>,
    ) -> State<Self::Scalar, Dyn>
    where
        Self: Sized,
    {
        let vector = |entries: &mut dyn Iterator<Item = Self::Scalar>| DVector::from_vec(entries.collect());
        let [q, v] = [vector(&mut q.into_iter()), vector(&mut v.into_iter())];
        State { t: Self::Scalar::constant(0.0), q, v }
    }

    /// State at t = 0 with these coordinates, at rest.
    fn at_rest(&self, q: impl IntoIterator<Item = Self::Scalar>) -> State<Self::Scalar, Dyn>
    where
        Self: Sized,
    {
        let q = DVector::from_vec(q.into_iter().collect());
        State {
            t: Self::Scalar::constant(0.0),
            v: DVector::from_element(q.len(), Self::Scalar::constant(0.0)),
            q,
        }
    }
}
