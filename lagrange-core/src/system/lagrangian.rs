//! The contract between generated code and everything that uses it.

use nalgebra::{SMatrix, SVector};

use super::facts::Facts;
use super::integrability::{Classification, Integrals};
use super::state::{Solution, State};
use crate::number::Scalar;

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
    note = "put `#[derive(Lagrangian)]`, `#[coordinates(…)]` and `#[lagrangian(…)]` on the struct"
)]
pub trait Lagrangian<const N: usize, const M: usize> {
    /// The number type of the parameters and the state.
    type Scalar: Scalar;

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
    /// Names of the observables.
    const OBSERVABLES: &'static [&'static str];

    /// What the derive found out: conserved quantities, cyclic coordinates, what the energy is.
    const FACTS: Facts;

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

    /// Accelerations and multipliers at once, without a decision: on SIMD lanes nothing can branch, so a system
    /// that the elimination cannot solve shows in [`Solution::pivot`]. [`solve`](crate::Simulate::solve) checks it
    /// and falls back to the general solve.
    fn accelerations(&self, state: &State<Self::Scalar, N>) -> Solution<Self::Scalar, N, M>;

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
