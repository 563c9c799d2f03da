//! Marker traits for the structure of a system.

use super::lagrangian::Lagrangian;
use super::moving::System;

/// A system whose mass matrix M depends on the parameters alone.
///
/// M does not depend on the coordinates, the velocities or the time, so the momenta are p = M q̇ + a(q, t) and one
/// factorization of M serves a whole motion. A change of the parameters may change M.
///
/// `#[derive(Lagrangian)]` implements it where the derived entries of M are constant in symbols: masses in Cartesian
/// coordinates, or a pendulum in its angle, but not a double pendulum.
///
/// An implementation by hand promises that [`mass_matrix`](Lagrangian::mass_matrix) returns the same matrix, up to
/// round-off, for all states.
#[diagnostic::on_unimplemented(
    message = "the mass matrix of `{Self}` depends on the coordinates, the velocities or the time",
    label = "its mass matrix is not known to be constant",
    note = "`Verlet` needs a constant mass matrix; in its place take `Gauss::<1>` without constraints, `Lobatto::<2>` with holonomic ones, `DAlembert` with constraints on velocities: all are of order 2",
    note = "if the mass matrix is constant, but the derive macro cannot prove it, implement `ConstantMassMatrix` by hand"
)]
pub trait ConstantMassMatrix: Lagrangian {}

/// A system whose forces do not depend on the velocities.
///
/// The vector h of M q̈ = h + Fᵀλ is a function h(q, t). Damping, a magnetic field and a rotating frame add forces
/// that depend on the velocities. So does a mass matrix that depends on the coordinates, by the centrifugal and
/// Coriolis terms in h.
///
/// `#[derive(Lagrangian)]` implements it where the velocities vanish from the derived h in symbols. A part of L that is
/// linear in the velocities is allowed if it adds no such force, as a total time derivative does.
///
/// An implementation by hand promises that [`forcing`](Lagrangian::forcing) returns the same vector, up to round-off,
/// for all velocities at the same coordinates and time; for a [`System`] that is stated by its accelerations, that these do not
/// depend on the velocities.
#[diagnostic::on_unimplemented(
    message = "the forces on `{Self}` depend on the velocities",
    label = "its forces are not known to be free of velocities",
    note = "`Verlet` takes no damping, magnetic field, rotating frame or mass matrix that depends on the coordinates; in its place take `Gauss::<1>` without constraints, `Lobatto::<2>` with holonomic ones, `DAlembert` with constraints on velocities: all are of order 2",
    note = "if the forces do not depend on the velocities, but the derive macro cannot prove it, implement `VelocityFreeForces` by hand"
)]
pub trait VelocityFreeForces: System {}

/// A system whose constraints are all holonomic, Φ(q, t) = 0, or that has none.
///
/// `#[derive(Lagrangian)]` implements it if every constraint is written without velocities. A velocity constraint
/// does not count even if it is integrable: [`constraint_residual`](Lagrangian::constraint_residual) is zero for it,
/// so a method cannot enforce it on the coordinates.
///
/// An implementation by hand promises that every entry of [`CONSTRAINT_KINDS`](Lagrangian::CONSTRAINT_KINDS) is
/// [`Holonomic`](crate::ConstraintKind::Holonomic).
#[diagnostic::on_unimplemented(
    message = "`{Self}` has a constraint on velocities",
    label = "its constraints are not known to be holonomic",
    note = "`Verlet` and `Lobatto` take constraints on coordinates and time alone, Φ(q, t) = 0; in their place take `DAlembert`, or write an integrable constraint on velocities as its integral",
    note = "if the constraints of a manual implementation of `Lagrangian` are holonomic, implement `HolonomicConstraints` by hand"
)]
pub trait HolonomicConstraints: Lagrangian {}

/// A system without constraints.
///
/// `#[derive(Lagrangian)]` implements it if there is no `#[constraint(…)]`, and no coordinate that implies one, as a
/// unit quaternion does.
///
/// An implementation by hand promises that [`M`](System::M) is 0.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has constraints",
    label = "not known to be free of constraints",
    note = "`Gauss` takes no constraints, and a unit quaternion implies one; in its place take `Lobatto` with holonomic constraints, `DAlembert` with constraints on velocities",
    note = "if a manual implementation of `Lagrangian` has no constraints, implement `Unconstrained` by hand"
)]
pub trait Unconstrained: Lagrangian {}
