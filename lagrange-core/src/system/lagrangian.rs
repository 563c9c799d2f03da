//! The trait that generated code implements and all computations use.

use core::fmt::Debug;

use super::defect::Defect;
use super::equations::{Equations, equations};
use super::facts::Facts;
use super::integrability::{Classification, Integrals};
use super::moving::System;
use super::state::{Solution, SolutionOf, StateOf};
use crate::names::Entry;
use crate::number::{Broadcast, Scalar};
use crate::solution::vector_field::LagrangianVectorField;
use crate::vector::{Array, Matrix, StaticLength, Vector, matrix, zeros};

/// Form in which a constraint is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ConstraintKind {
    /// Φ(q, t) = 0: enforced on the coordinates and on the velocities.
    Holonomic,
    /// F(q, t) q̇ + b(q, t) = 0: enforced on the velocities.
    Velocity,
}

/// A mechanical system with `N` generalized coordinates and `M` scalar constraints.
///
/// A function for any system takes an `L: Lagrangian`, and its states are [`StateOf<L>`](crate::StateOf):
///
/// ```
/// # use lagrange_core::prelude::*;
/// use lagrange_core::StateOf;
///
/// /// Time between the first two passages of the first coordinate through zero, upwards.
/// fn period<L: Lagrangian<Scalar = f64>>(system: &L, start: StateOf<L>) -> Result<f64, Error> {
///     let mut motion = Motion::new(system, start, Dop853::with_tolerance(1e-12))?;
///     let mut passage = system.event("passage", |sample| sample.state().q[0]).rising();
///     let mut times = [0.0; 2];
///     for (time, crossing) in times.iter_mut().zip(motion.crossings(100.0, &mut [&mut passage])) {
///         *time = crossing?.state.t;
///     }
///     Ok(times[1] - times[0])
/// }
/// # #[derive(Lagrangian)]
/// # #[coordinates(x)]
/// # #[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
/// # struct Spring { m: f64, k: f64 }
///
/// let period = period(&Spring { m: 1.0, k: 4.0 }, State::at_rest([0.1]))?;
/// assert!((period - core::f64::consts::PI).abs() < 1e-10);
/// # Ok::<(), Error>(())
/// ```
///
/// `#[derive(Lagrangian)]` implements this trait. Its formulas are those of d/dt(∂L/∂q̇) = ∂L/∂q + Q + Fᵀλ
/// (Milton (8.7), (8.13)) with the constraints Φ = lhs − rhs as written. References, `Box`, `Rc` and `Arc`
/// forward the trait to the system that they point to.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no equations of motion",
    label = "not a Lagrangian system",
    note = "put `#[derive(Lagrangian)]`, `#[coordinates(…)]` and `#[lagrangian(…)]` on the struct",
    note = "a trajectory is a motion that is over: `.event(…)` and the other settings stand before `.to(…)`"
)]
pub trait Lagrangian: System<Length = <Self as Lagrangian>::N, Field = LagrangianVectorField> {
    /// Number of the generalized coordinates, the length of q: [`Const<2>`](nalgebra::Const) for two.
    type N: StaticLength;

    /// Factorization of the matrix of the equations of motion at a state, without heap data.
    type Factor: Copy + Debug + Send + Sync;

    /// Name of the struct.
    const NAME: &'static str;
    /// Names of the generalized coordinates, `N` of them.
    const COORDINATES: &'static [&'static str];
    /// Names of the constraints, `M` of them.
    const CONSTRAINTS: &'static [&'static str];
    /// Form of each constraint as written: holonomic, or in the velocities.
    const CONSTRAINT_KINDS: &'static [ConstraintKind];
    /// Integrability of each constraint; empty for a manual implementation.
    const CONSTRAINT_CLASSES: &'static [Classification] = &[];
    /// Number of integrals of the velocity constraints; `None` if it could not be decided.
    const INTEGRALS: Option<Integrals> = None;
    /// True for a system with [contacts](crate::contact), whose motions go
    /// [across them](crate::MotionBuilder::with_contacts).
    const HAS_CONTACTS: bool = false;
    /// True if the force of friction is a multiple of a multiplier, by `#[contact(…, friction(mu): velocity)]`.
    const HAS_FRICTION: bool = false;
    /// True if some friction acts along two velocities v: its derivatives grow as 1/|v| towards rest.
    const HAS_PLANAR_FRICTION: bool = false;
    /// True if the time occurs in the equations of motion, whatever the values of the parameters. A manual implementation must say so.
    const DEPENDS_ON_TIME: bool = false;
    /// Index of the first of the four coordinates (w, x, y, z) of each quaternion that turns a frame, by
    /// `#[frame(…: rotate(q))]`; its length 1 is a constraint.
    const QUATERNIONS: &'static [usize] = &[];
    /// True if the momenta are linear in the velocities, p = M(q, t) q̇ + a(q, t), so that one linear solve
    /// inverts the Legendre transform.
    const MOMENTA_ARE_LINEAR: bool = false;
    /// Names of the observables.
    const OBSERVABLES: &'static [&'static str];

    /// Hash of the struct and of the attributes that determine its motion; 0 for a manual implementation.
    const DIGEST: u32 = 0;
    /// Names of the user-supplied functions (`#[function(…)]`).
    const SUPPLIED: &'static [&'static str] = &[];

    /// Facts found by the derive macro: conserved quantities, cyclic coordinates, the form of the energy.
    const FACTS: Facts;

    /// Readable equations of motion; empty for a manual implementation.
    const EQUATIONS: Equations = equations([[""; 3]; 3]);

    /// Calls `visit` with the name and value of every parameter: each number that the expressions name, in the order of the
    /// fields. Numbers inside a user-supplied function are not included.
    #[allow(unused_variables)]
    fn visit_parameters(&self, visit: &mut dyn FnMut(&'static str, Self::Scalar)) {}

    /// Calls `visit` with the name of each parameter matrix declared symmetric or a rotation, and its deviation
    /// from that property.
    #[allow(unused_variables)]
    fn visit_defects(&self, visit: &mut dyn FnMut(&'static str, Defect<Self::Scalar>)) {}

    /// Lagrangian L(t, q, q̇).
    fn lagrangian(&self, state: &StateOf<Self>) -> Self::Scalar;

    /// Energy function E = p·q̇ − L (Milton (8.17)).
    fn energy(&self, state: &StateOf<Self>) -> Self::Scalar;

    /// Rate of the energy along the motion with these multipliers, dE/dt = −∂L/∂t + Q·q̇ − Σ_α λ_α b_α: a Lagrangian that
    /// changes with time, forces with dissipation and sliding friction, and constraints F q̇ + b = 0 that move. Zero if E is
    /// conserved.
    fn energy_rate(&self, state: &StateOf<Self>, multipliers: &Vector<Self::Scalar, Self::M>)
    -> Self::Scalar;

    /// Generalized momenta p = ∂L/∂q̇.
    fn momentum(&self, state: &StateOf<Self>) -> Vector<Self::Scalar, Self::N>;

    /// ∂L/∂q + Q, the rate of the momenta without constraints; the force of constraint Fᵀλ adds to it.
    fn momentum_rate(&self, state: &StateOf<Self>) -> Vector<Self::Scalar, Self::N>;

    /// Mass matrix M = ∂p/∂q̇ (symmetric).
    fn mass_matrix(&self, state: &StateOf<Self>) -> Matrix<Self::Scalar, Self::N, Self::N>;

    /// Momenta ∂L̄/∂q̇ of the completed Lagrangian L̄ = L + Σ_a σ_a (F_a q̇ + b_a)²/2, whose mass matrix is regular where
    /// constraints complete a singular M: the length of a unit quaternion has no inertia. L̄ has the motions and the
    /// multipliers of L, and where velocities satisfy the constraints, its momenta. The derive macro chooses the
    /// constraints a and their weights σ_a; where M is regular there are none.
    fn completed_momentum(&self, state: &StateOf<Self>) -> Vector<Self::Scalar, Self::N> {
        self.momentum(state)
    }

    /// ∂L̄/∂q + Q with the completed Lagrangian of [`completed_momentum`](Self::completed_momentum).
    fn completed_momentum_rate(&self, state: &StateOf<Self>) -> Vector<Self::Scalar, Self::N> {
        self.momentum_rate(state)
    }

    /// M + Σ_a σ_a F_aᵀF_a, the mass matrix of the completed Lagrangian of
    /// [`completed_momentum`](Self::completed_momentum) where velocities satisfy the constraints.
    fn completed_mass_matrix(&self, state: &StateOf<Self>) -> Matrix<Self::Scalar, Self::N, Self::N> {
        self.mass_matrix(state)
    }

    /// Bounds of the rounding errors of [`constraint_jacobian`](Self::constraint_jacobian), in units of ε, for each
    /// constraint whose gradient some values of the parameters cancel at every pose; zeros for the others. (To first order,
    /// each operation adds its result: Higham, *Accuracy and Stability of Numerical Algorithms*, 3.3.)
    ///
    /// Parameters count as correct to round-off of themselves, and supplied functions as exact: a matrix entry that was
    /// computed as the round-off of zero cannot be told from a small one.
    #[allow(unused_variables)]
    fn jacobian_round_off(&self, state: &StateOf<Self>) -> Matrix<Self::Scalar, Self::M, Self::N> {
        matrix(Array::filled(Array::filled(Self::Scalar::constant(0.0))))
    }

    /// 1 for each constraint that its field switches off, `#[constraint(…, when: field)]`, and for friction that does not
    /// stick, else 0: the diagonal of c in F q̈ + γ + c λ = 0. While a constraint is off, its Φ, F, b and γ are zero, and so is
    /// its λ; that of friction which slides is its force.
    fn compliance(&self) -> Vector<Self::Scalar, Self::M> {
        zeros()
    }

    /// Index of the first constraint whose friction slides with a force μ λ, proportional to the multiplier of its contact;
    /// `None` if there is none. Such a force is no part of Fᵀλ, and c has an entry μ beside its diagonal.
    fn slides(&self) -> Option<usize> {
        None
    }

    /// h = ∂L/∂q + Q − (dp/dt at q̈ = 0), so M q̈ = h without constraints.
    fn forcing(&self, state: &StateOf<Self>) -> Vector<Self::Scalar, Self::N>;

    /// Φ(q, t) of the holonomic constraints; zero for velocity constraints.
    fn constraint_residual(&self, state: &StateOf<Self>) -> Vector<Self::Scalar, Self::M>;

    /// A function I(q, t) whose rate of change is the velocity constraint `index`, as written or times a
    /// factor. `None` if there is none or none was found.
    #[allow(unused_variables)]
    fn constraint_integral(&self, index: usize, state: &StateOf<Self>) -> Option<Self::Scalar> {
        None
    }

    /// F q̇ + b: the rate of change of a holonomic constraint, or the residual of a velocity constraint.
    fn constraint_rate(&self, state: &StateOf<Self>) -> Vector<Self::Scalar, Self::M>;

    /// Σ_i |F_αi q_i| of the holonomic constraints, zero for velocity constraints. It estimates the size of the
    /// terms of Φ; ε times it is their round-off.
    fn residual_magnitude(&self, state: &StateOf<Self>) -> Vector<Self::Scalar, Self::M>;

    /// Σ_i |F_αi q̇_i| of all constraints, the size of the terms of F q̇ + b.
    fn rate_magnitude(&self, state: &StateOf<Self>) -> Vector<Self::Scalar, Self::M>;

    /// Constraint Jacobian F: ∂Φ/∂q of a holonomic constraint, or the coefficients of q̇ in a velocity
    /// constraint.
    fn constraint_jacobian(&self, state: &StateOf<Self>) -> Matrix<Self::Scalar, Self::M, Self::N>;

    /// γ in the acceleration constraint F q̈ + γ = 0.
    fn constraint_bias(&self, state: &StateOf<Self>) -> Vector<Self::Scalar, Self::M>;

    /// Generalized constraint force Fᵀλ, with the force of friction that slides.
    fn constraint_force(
        &self,
        state: &StateOf<Self>,
        multipliers: &Vector<Self::Scalar, Self::M>,
    ) -> Vector<Self::Scalar, Self::N>;

    /// Inverse dynamics: returns M q̈ − h − Fᵀλ, the generalized forces needed beside those of the system to
    /// produce these accelerations with these multipliers. The generated code evaluates d/dt(∂L/∂q̇) − ∂L/∂q −
    /// Q − Fᵀλ without forming M; for a chain of links the cost is linear in their number.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// # #[derive(Lagrangian)]
    /// # #[coordinates(theta)]
    /// # #[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
    /// # struct Pendulum { m: f64, l: f64, g: f64 }
    /// let pendulum = Pendulum { m: 1.0, l: 2.0, g: 9.81 };
    /// // Torque for θ̈ = 3 at rest in the lowest position: m l² θ̈.
    /// let torque = pendulum.inverse_dynamics(&State::at_rest([0.0]), &[3.0].into(), &[].into());
    /// assert_eq!(torque[0], 12.0);
    /// ```
    fn inverse_dynamics(
        &self,
        state: &StateOf<Self>,
        accelerations: &Vector<Self::Scalar, Self::N>,
        multipliers: &Vector<Self::Scalar, Self::M>,
    ) -> Vector<Self::Scalar, Self::N>;

    /// Accelerations and multipliers by the generated elimination alone. The result is NaN if it is unreliable:
    /// if the smallest pivot, [`Solution::pivot`], leaves less than two thirds of the digits. The code has no
    /// branches, so it runs on SIMD lanes and dual numbers; each lane is NaN independently.
    /// [`solve`](crate::Simulate::solve) checks the result: it falls back to a general solver or returns an
    /// error.
    fn accelerations_unchecked(&self, state: &StateOf<Self>) -> SolutionOf<Self>;

    /// Factorization of the matrix of the equations of motion at a state, block rows (M, −Fᵀ) and (F, 0).
    /// [`solve_with`](Self::solve_with) reuses it for any right-hand sides.
    fn factor(&self, state: &StateOf<Self>) -> Self::Factor;

    /// Solves M x − Fᵀλ = `forcing`, F x = −`bias` with a factorization at a state. With h and γ of that state
    /// as right-hand sides, x and λ are the accelerations and multipliers; other right-hand sides give
    /// corrections or impacts. Unreliable results are NaN, as in
    /// [`accelerations_unchecked`](Self::accelerations_unchecked).
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// # #[derive(Lagrangian)]
    /// # #[coordinates(x, y)]
    /// # #[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
    /// # #[constraint(rod: 1/2 * (x^2 + y^2 - l^2) = 0)]
    /// # struct Pendulum { m: f64, g: f64, l: f64 }
    /// let pendulum = Pendulum { m: 2.0, g: 9.81, l: 1.0 };
    /// let state = State::at_rest([0.6, -0.8]);
    /// let factor = pendulum.factor(&state);
    /// // An impulse of 1 N s along x: M(v⁺ − v⁻) = (1, 0) + FᵀΛ, F v⁺ = 0.
    /// let after = pendulum.solve_with(&factor, &[1.0, 0.0].into(), &[0.0].into());
    /// assert!((after.accelerations[0] - 0.32).abs() < 1e-15 && (after.accelerations[1] - 0.24).abs() < 1e-15);
    /// assert!((after.multipliers[0] + 0.6).abs() < 1e-15);
    /// ```
    ///
    /// Several right-hand sides can be solved at once, on [`Lanes`](crate::Lanes) over an `f64`.
    fn solve_with<S: Broadcast<Self::Scalar>>(
        &self,
        factor: &Self::Factor,
        forcing: &Vector<S, Self::N>,
        bias: &Vector<S, Self::M>,
    ) -> Solution<S, Self::N, Self::M>;

    /// Value of the observable [`OBSERVABLES`](Self::OBSERVABLES)`[index]`; `None` beyond the last.
    fn observable(
        &self,
        index: usize,
        state: &StateOf<Self>,
        solution: &SolutionOf<Self>,
    ) -> Option<Self::Scalar>;

    /// Value of the conserved quantity [`FACTS`](Self::FACTS)`.conserved[index]`; `None` beyond the last.
    fn conserved(&self, index: usize, state: &StateOf<Self>) -> Option<Self::Scalar>;
}

/// Checks at compile time that a manual implementation names all coordinates and constraints, in a program
/// that uses the names.
pub(crate) const fn check_names<L: Lagrangian>() {
    assert!(L::COORDINATES.len() == <L::N>::COUNT, "`COORDINATES` must have `N` names");
    assert!(L::CONSTRAINTS.len() == <L::M>::COUNT, "`CONSTRAINTS` must have `M` names");
    assert!(L::CONSTRAINT_KINDS.len() == <L::M>::COUNT, "`CONSTRAINT_KINDS` must have `M` entries");
}

/// True if some constraints hold the velocities alone.
pub(crate) fn has_velocity_constraints<L: Lagrangian>() -> bool {
    L::CONSTRAINT_KINDS.contains(&ConstraintKind::Velocity)
}

/// Returns the entry at `index` of (q, q̇).
pub(crate) fn entry<L: Lagrangian>(index: usize) -> Entry {
    const { check_names::<L>() };
    let name = L::COORDINATES[index % <L::N>::COUNT];
    if index < <L::N>::COUNT { Entry::Coordinate(name) } else { Entry::Velocity(name) }
}

/// Asserts, at compile time, that no motion passes through contacts.
pub(crate) const fn check_contacts(has_contacts: bool) {
    assert!(
        !has_contacts,
        "this system has contacts, or dry friction as of joints: move it by `motion(start).with_contacts().to(end)`, so that they open and close, stick and slide, step by step by `motion(start).with_contacts().begin()` in the place of a `Motion`, an ensemble by `integrate_with_contacts`; derivatives across contacts are `path.sensitivity(&[…], method)`, with the path that this motion returns"
    );
}

/// Asserts, at compile time, that no force is a multiple of a multiplier.
pub(crate) const fn check_friction(has_friction: bool) {
    assert!(
        !has_friction,
        "the contacts of this system have friction, which takes energy: move it by `Dop853`, `Taylor`, `Radau` or another method that solves for accelerations"
    );
}

#[cfg(test)]
mod tests {
    use super::check_names;
    use crate::fixtures::Mechanism;

    #[test]
    fn names_are_as_many_as_coordinates_and_constraints() {
        check_names::<Mechanism<5, 5, 2>>();
        check_names::<Mechanism<1, 0, 0>>();
    }

    #[test]
    #[should_panic(expected = "`COORDINATES` must have `N` names")]
    fn too_few_names_of_coordinates_are_noticed() {
        check_names::<Mechanism<6, 0, 0>>();
    }

    #[test]
    #[should_panic(expected = "`CONSTRAINTS` must have `M` names")]
    fn too_few_names_of_constraints_are_noticed() {
        check_names::<Mechanism<5, 6, 0>>();
    }
}
