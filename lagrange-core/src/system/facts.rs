//! What the derive finds out about a system before it moves.

use super::evidence::Evidence;

/// A quantity that the motion conserves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Conserved {
    /// `p_phi` for the momentum of a cyclic coordinate `phi`, `energy`, or the name given in `#[conserved(…)]`.
    pub name: &'static str,
    /// How sure that is.
    pub evidence: Evidence,
}

/// Terms of the Lagrangian that together are d/dt f(q, t) of something, and so act on nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TotalDerivative {
    /// The terms as written, in the notation of `Type::equations()`.
    pub terms: &'static str,
    /// How sure that is.
    pub evidence: Evidence,
}

/// What the part A(q, t)·q̇ of the Lagrangian does that is linear in the velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LinearPart {
    /// There is none.
    Absent,
    /// ∂A_i/∂q_j = ∂A_j/∂q_i: it adds no force that depends on the velocities.
    Closed(Evidence),
    /// It adds gyroscopic forces, as a magnetic field or a rotating frame does; or the Lagrangian has parts of
    /// other degrees in the velocities than 0, 1 and 2.
    Open,
}

/// What the energy function E = p·q̇ − L consists of, and whether it is T + U.
///
/// By degree in the velocities L = L₂ + L₁ + L₀, and E = L₂ − L₀. The kinetic energy is such a sum too, T = T₂ + T₁ + T₀, whose T₁
/// and T₀ are zero unless positions move with time at given coordinates; then E = T₂ − T₀ + U, which is not T + U (Goldstein, Poole
/// and Safko, *Classical Mechanics*, 2.7). Where `kinetic(…)` is not written a Lagrangian does not tell T from U: m ω² r²/2 is the T₀ of a
/// bead on a wire that is turned at the rate ω, and −U of a spring that pushes. So E is said to be T + U only where T is known, and
/// not to be only where positions are seen to move.
///
/// ```
/// use lagrange_core::{prelude::*, facts::{EnergyForm, Evidence}};
///
/// /// A bead on a wire that is turned in a horizontal plane.
/// #[derive(Lagrangian)]
/// #[coordinates(r)]
/// #[define(x = r*cos(omega*t))]
/// #[define(y = r*sin(omega*t))]
/// #[lagrangian(m/2 * (der(x)^2 + der(y)^2))]
/// struct Turned { m: f64, omega: f64 }
///
/// assert_eq!(Turned::FACTS.energy_form, EnergyForm::Moving);
///
/// /// The same bead, as its Lagrangian comes out.
/// #[derive(Lagrangian)]
/// #[coordinates(r)]
/// #[lagrangian(m/2 * (r_dot^2 + omega^2 * r^2))]
/// struct Reduced { m: f64, omega: f64 }
///
/// // E = m (ṙ² − ω² r²)/2: T + U if U = −m ω² r²/2, and so not here, where U = 0.
/// assert_eq!(Reduced::FACTS.energy_form, EnergyForm::Even(Evidence::Proved));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EnergyForm {
    /// E is T + U: T is the sum of the bodies' `kinetic(…)`, which holds all velocities and is quadratic in them, and U = T − L.
    Sum(Evidence),
    /// E is L₂ − L₀ without an L₁: T + U if −L₀ is U, and if it holds kinetic energy, not.
    Even(Evidence),
    /// E is not T + U: L has the square of a velocity, by `der`, `velocity` or `kinetic`, that is not zero at rest, q̇ = 0.
    Moving,
    /// E is L₂ − L₀, while L₁ drops out of it and is not known to vanish: as of a charge in a magnetic field, or in a frame that turns.
    Quadratic,
    /// E is p·q̇ − L, and L is not quadratic in the velocities.
    General,
}

/// What the derive found out about a system: [`Lagrangian::FACTS`](crate::Lagrangian::FACTS).
///
/// What is not listed is false or could not be decided.
///
/// ```
/// use lagrange_core::{prelude::*, facts::{EnergyForm, Evidence}};
///
/// /// A planet around a fixed sun.
/// #[derive(Lagrangian)]
/// #[coordinates(r, phi)]
/// #[lagrangian(m/2 * (r_dot^2 + r^2 * phi_dot^2) + k/r)]
/// struct Planet { m: f64, k: f64 }
///
/// assert_eq!(Planet::FACTS.cyclic, ["phi"]);
/// assert!(Planet::FACTS.conserved.iter().map(|found| found.name).eq(["p_phi", "energy"]));
/// // T + U if −k/r is U.
/// assert_eq!(Planet::FACTS.energy_form, EnergyForm::Even(Evidence::Proved));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// The coordinates that occur in the Lagrangian, the forces and the constraints by their velocities only, if
    /// at all, and along which no force and no constraint acts.
    pub cyclic: &'static [&'static str],
    /// The conserved quantities, in the order of [`Lagrangian::conserved`](crate::Lagrangian::conserved): momenta,
    /// the energy, and those given in `#[conserved(…)]`.
    pub conserved: &'static [Conserved],
    /// Whether the energy function E = p·q̇ − L is conserved. A constraint with an inhomogeneous part does work
    /// even where no time appears in it.
    pub energy_is_conserved: Option<Evidence>,
    /// Whether E is T + U.
    pub energy_form: EnergyForm,
    /// Terms of the Lagrangian, as written, that are total time derivatives.
    pub total_derivatives: &'static [TotalDerivative],
    /// The part of the Lagrangian that is linear in the velocities.
    pub linear_part: LinearPart,
}

impl Facts {
    /// Of a system of which nothing is known.
    pub const NONE: Self = Self {
        cyclic: &[],
        conserved: &[],
        energy_is_conserved: None,
        energy_form: EnergyForm::General,
        total_derivatives: &[],
        linear_part: LinearPart::Open,
    };
}
