//! The contract between generated code and everything that uses it.

use core::fmt::Debug;

use nalgebra::{SMatrix, SVector};

use super::defect::Defect;
use super::equations::{Equations, equations};
use super::facts::Facts;
use super::integrability::{Classification, Integrals};
use super::state::{Solution, State};
use crate::number::{Broadcast, Scalar};

/// How a constraint was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ConstraintKind {
    /// Φ(q, t) = 0: enforced on the coordinates and on the velocities.
    Holonomic,
    /// F(q, t) q̇ + b(q, t) = 0: enforced on the velocities.
    Velocity,
}

/// A mechanical system with `N` generalized coordinates and `M` scalar constraints.
///
/// `#[derive(Lagrangian)]` implements it; the formulas are those of d/dt(∂L/∂q̇) = ∂L/∂q + Q + Fᵀλ
/// (Milton (8.7), (8.13)) with the constraints Φ = lhs − rhs as written. A system behind a reference, or in a `Box`, an
/// `Rc` or an `Arc`, is that system.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no equations of motion",
    label = "not a Lagrangian system",
    note = "put `#[derive(Lagrangian)]`, `#[coordinates(…)]` and `#[lagrangian(…)]` on the struct",
    note = "a trajectory is a motion that is over: `.event(…)` and the other settings stand before `.to(…)`"
)]
pub trait Lagrangian<const N: usize, const M: usize> {
    /// The number type of the parameters and the state.
    type Scalar: Scalar;

    /// Factorization of the matrix of the equations of motion at a state; plain numbers.
    type Factor: Copy + Debug;

    /// The name of the struct.
    const NAME: &'static str;
    /// Names of the generalized coordinates.
    const COORDINATES: [&'static str; N];
    /// Names of the constraints.
    const CONSTRAINTS: [&'static str; M];
    /// What each constraint acts on.
    const CONSTRAINT_KINDS: [ConstraintKind; M];
    /// Whether each constraint is integrable.
    const CONSTRAINT_CLASSES: [Classification; M] = [Classification::UNDECIDED; M];
    /// How many of the velocity constraints can be integrated together; `None` where it could not be decided.
    const INTEGRALS: Option<Integrals> = None;
    /// Whether the momenta are linear in the velocities, p = M(q, t) q̇ + a(q, t), so that one solve inverts them.
    const MOMENTA_ARE_LINEAR: bool = false;
    /// Names of the observables.
    const OBSERVABLES: &'static [&'static str];

    /// Hash of the struct and of the attributes that its motion follows from; 0 of a system that is not derived.
    const DIGEST: u32 = 0;
    /// Names of the functions that are supplied (`#[function(…)]`).
    const SUPPLIED: &'static [&'static str] = &[];

    /// What the derive found out: conserved quantities, cyclic coordinates, what the energy is.
    const FACTS: Facts;

    /// The system and its equations of motion, to be read; empty for one that is not derived.
    const EQUATIONS: Equations = equations([[""; 3]; 3]);

    /// Shows every parameter: each number that the expressions name, in the order of the fields. What a function of the user
    /// holds is not among them.
    #[allow(unused_variables)]
    fn visit_parameters(&self, visit: &mut dyn FnMut(Self::Scalar)) {}

    /// Shows each matrix among the parameters that is said to be symmetric or a rotation, and how far it is from that.
    #[allow(unused_variables)]
    fn visit_defects(&self, visit: &mut dyn FnMut(&'static str, Defect<Self::Scalar>)) {}

    /// L(t, q, q̇).
    fn lagrangian(&self, state: &State<Self::Scalar, N>) -> Self::Scalar;

    /// The energy function E = p·q̇ − L (Milton (8.17)); its rate is −∂L/∂t + Q·q̇ − Σ_α λ_α b_α.
    fn energy(&self, state: &State<Self::Scalar, N>) -> Self::Scalar;

    /// Generalized momenta p = ∂L/∂q̇.
    fn momentum(&self, state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, N>;

    /// ∂L/∂q + Q: the rate of the momenta without constraints, whose force Fᵀλ adds to it.
    fn momentum_rate(&self, state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, N>;

    /// Mass matrix M = ∂p/∂q̇ (symmetric).
    fn mass_matrix(&self, state: &State<Self::Scalar, N>) -> SMatrix<Self::Scalar, N, N>;

    /// h = ∂L/∂q + Q − (dp/dt where q̈ = 0): what M q̈ equals without constraints.
    fn forcing(&self, state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, N>;

    /// Φ(q, t) of the holonomic constraints; zero for those written with velocities.
    fn constraint_residual(&self, state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, M>;

    /// A function I(q, t) whose rate of change is the velocity constraint `index`, as written or times a factor;
    /// `None` where there is none or none was found.
    #[allow(unused_variables)]
    fn constraint_integral(&self, index: usize, state: &State<Self::Scalar, N>) -> Option<Self::Scalar> {
        None
    }

    /// F q̇ + b: the rate of change of a holonomic constraint, the residual of a velocity constraint.
    fn constraint_rate(&self, state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, M>;

    /// Σ_i |F_αi q_i| of the holonomic constraints, zero for those written with velocities: about the size of the terms
    /// that Φ is the difference of, a part ε of which is round-off.
    fn residual_magnitude(&self, state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, M>;

    /// Σ_i |F_αi q̇_i| of all constraints: the size of the terms of F q̇ + b.
    fn rate_magnitude(&self, state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, M>;

    /// Constraint Jacobian F: ∂Φ/∂q of a holonomic constraint, the coefficients of q̇ of a velocity constraint.
    fn constraint_jacobian(&self, state: &State<Self::Scalar, N>) -> SMatrix<Self::Scalar, M, N>;

    /// γ, so that F q̈ + γ = 0.
    fn constraint_bias(&self, state: &State<Self::Scalar, N>) -> SVector<Self::Scalar, M>;

    /// The generalized constraint force Fᵀλ.
    fn constraint_force(
        &self,
        state: &State<Self::Scalar, N>,
        multipliers: &SVector<Self::Scalar, M>,
    ) -> SVector<Self::Scalar, N>;

    /// M q̈ − h − Fᵀλ: the generalized forces that have to act beside those of the system, so that it has these
    /// accelerations with these multipliers (inverse dynamics). It is emitted as d/dt(∂L/∂q̇) − ∂L/∂q − Q − Fᵀλ, without M:
    /// for a chain of links it costs as much as their number.
    ///
    /// ```
    /// # use lagrange_core::prelude::*;
    /// # #[derive(Lagrangian)]
    /// # #[coordinates(theta)]
    /// # #[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
    /// # struct Pendulum { m: f64, l: f64, g: f64 }
    /// let pendulum = Pendulum { m: 1.0, l: 2.0, g: 9.81 };
    /// // The torque for θ̈ = 3 where it hangs at rest: m l² θ̈.
    /// let torque = pendulum.inverse_dynamics(&State::at_rest([0.0]), &[3.0].into(), &[].into());
    /// assert_eq!(torque[0], 12.0);
    /// ```
    fn inverse_dynamics(
        &self,
        state: &State<Self::Scalar, N>,
        accelerations: &SVector<Self::Scalar, N>,
        multipliers: &SVector<Self::Scalar, M>,
    ) -> SVector<Self::Scalar, N>;

    /// Accelerations and multipliers by the emitted elimination alone, NaN where that cannot vouch for them: where its
    /// smallest pivot, [`Solution::pivot`], leaves less than two thirds of the digits. Nothing branches, so that it runs on
    /// SIMD lanes and dual numbers; lanes are NaN one by one. [`solve`](crate::Simulate::solve) is the checked one: it goes
    /// on to the general solve there, or says what is wrong.
    fn accelerations_unchecked(&self, state: &State<Self::Scalar, N>) -> Solution<Self::Scalar, N, M>;

    /// The matrix of the equations of motion at a state, −Fᵀ beside M and F below, factored once for any right-hand sides:
    /// [`solve_with`](Self::solve_with).
    fn factor(&self, state: &State<Self::Scalar, N>) -> Self::Factor;

    /// x and λ of M x − Fᵀλ = `forcing`, F x = −`bias`, by the factor of a state: accelerations and multipliers where these
    /// are h and γ of that state, corrections or impacts where they are something else. Like
    /// [`accelerations_unchecked`](Self::accelerations_unchecked) it gives NaN where it cannot vouch for numbers.
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
    /// // A blow of 1 N s along x: M(v⁺ − v⁻) = (1, 0) + FᵀΛ, F v⁺ = 0.
    /// let after = pendulum.solve_with(&factor, &[1.0, 0.0].into(), &[0.0].into());
    /// assert!((after.accelerations[0] - 0.32).abs() < 1e-15 && (after.accelerations[1] - 0.24).abs() < 1e-15);
    /// assert!((after.multipliers[0] + 0.6).abs() < 1e-15);
    /// ```
    ///
    /// Right-hand sides may be several at once, on [`Lanes`](crate::Lanes) over an `f64`.
    fn solve_with<S: Broadcast<Self::Scalar>>(
        &self,
        factor: &Self::Factor,
        forcing: &SVector<S, N>,
        bias: &SVector<S, M>,
    ) -> Solution<S, N, M>;

    /// The observable [`OBSERVABLES`](Self::OBSERVABLES)`[index]`; `None` beyond the last.
    fn observable(
        &self,
        index: usize,
        state: &State<Self::Scalar, N>,
        solution: &Solution<Self::Scalar, N, M>,
    ) -> Option<Self::Scalar>;

    /// The value of the conserved quantity [`FACTS`](Self::FACTS)`.conserved[index]`; `None` beyond the last.
    fn conserved(&self, index: usize, state: &State<Self::Scalar, N>) -> Option<Self::Scalar>;
}
