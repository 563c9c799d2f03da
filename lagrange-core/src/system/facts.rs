//! Facts about a system that the derive macro finds at compile time.

use super::evidence::Evidence;

/// A quantity that the motion conserves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Conserved {
    /// Name: `p_phi` for the momentum of a cyclic coordinate `phi`, `energy`, or the name given in
    /// `#[conserved(…)]`.
    pub name: &'static str,
    /// Evidence for the conservation.
    pub evidence: Evidence,
}

/// Terms of the Lagrangian whose sum is a total time derivative df(q, t)/dt, which does not affect the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TotalDerivative {
    /// The terms as written, in the notation of `Type::equations()`.
    pub terms: &'static str,
    /// Evidence that the terms are a total derivative.
    pub evidence: Evidence,
}

/// Effect of the part A(q, t)·q̇ of the Lagrangian that is linear in the velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LinearPart {
    /// The Lagrangian has no linear part.
    Absent,
    /// ∂A_i/∂q_j = ∂A_j/∂q_i: the linear part adds no force that depends on the velocities.
    Closed(Evidence),
    /// The linear part adds gyroscopic forces, as a magnetic field or a rotating frame does. Also used if the
    /// Lagrangian has parts of degrees other than 0, 1 and 2 in the velocities.
    Open,
}

/// Composition of the energy function E = p·q̇ − L: whether it is T + U.
///
/// Sorted by degree in the velocities, the Lagrangian is L = L₂ + L₁ + L₀, so that E = L₂ − L₀. The kinetic energy
/// splits likewise, T = T₂ + T₁ + T₀. T₁ and T₀ vanish unless positions depend on time at fixed coordinates. If they do, E = T₂ − T₀ + U,
/// which is not T + U (Goldstein, Poole and Safko, *Classical Mechanics*, 2.7).
///
/// Without `kinetic(…)` a Lagrangian does not distinguish T from U: m ω² r²/2 is T₀ of a bead on a wire that is
/// turned at the rate ω, and −U of a repelling spring. So the derive macro reports E = T + U only if T is
/// known, and E ≠ T + U only if positions visibly depend on time.
///
/// ```
/// use lagrange_core::{prelude::*, facts::{EnergyForm, Evidence}};
///
/// /// A bead on a wire that rotates in a horizontal plane at the rate ω.
/// #[derive(Lagrangian)]
/// #[coordinates(r)]
/// #[define(x = r*cos(omega*t))]
/// #[define(y = r*sin(omega*t))]
/// #[lagrangian(m/2 * (der(x)^2 + der(y)^2))]
/// struct Turned { m: f64, omega: f64 }
///
/// assert_eq!(Turned::FACTS.energy_form, EnergyForm::Moving);
///
/// /// The same bead, with its Lagrangian simplified by hand.
/// #[derive(Lagrangian)]
/// #[coordinates(r)]
/// #[lagrangian(m/2 * (r_dot^2 + omega^2 * r^2))]
/// struct Reduced { m: f64, omega: f64 }
///
/// // E = m (ṙ² − ω² r²)/2, which is T + U if U = −m ω² r²/2. Here U = 0, so it is not.
/// assert_eq!(Reduced::FACTS.energy_form, EnergyForm::Even(Evidence::Proved));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EnergyForm {
    /// E = T + U: T is the sum of the bodies' `kinetic(…)`, contains all velocities and is quadratic in them,
    /// and U = T − L.
    Sum(Evidence),
    /// E = L₂ − L₀ with L₁ = 0. It is T + U if −L₀ is U, but not if L₀ contains kinetic energy.
    Even(Evidence),
    /// E is not T + U: L contains the square of a velocity, from `der`, `velocity` or `kinetic`, that does not
    /// vanish at q̇ = 0.
    Moving,
    /// E = L₂ − L₀, while L₁ is not known to vanish and drops out of E: a charge in a magnetic field, or a
    /// rotating frame.
    Quadratic,
    /// E = p·q̇ − L, and L is not quadratic in the velocities.
    General,
}

/// Facts about a system that the derive macro found: [`Lagrangian::FACTS`](crate::Lagrangian::FACTS).
///
/// A fact that is not listed is false or could not be decided.
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
/// // E = T + U if −k/r is U.
/// assert_eq!(Planet::FACTS.energy_form, EnergyForm::Even(Evidence::Proved));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Facts {
    /// Cyclic coordinates: the Lagrangian contains at most their velocities, and no force or constraint acts along them.
    pub cyclic: &'static [&'static str],
    /// Conserved quantities, in the order of [`Lagrangian::conserved`](crate::Lagrangian::conserved): momenta,
    /// momentum and angular momentum of all vectors together, the energy, and those given in `#[conserved(…)]`.
    pub conserved: &'static [Conserved],
    /// Evidence that the energy function E = p·q̇ − L is conserved; `None` if it is not known to be. A
    /// constraint with an inhomogeneous part does work even if it does not contain the time.
    pub energy_is_conserved: Option<Evidence>,
    /// Composition of E: whether it is T + U.
    pub energy_form: EnergyForm,
    /// Terms of the Lagrangian, as written, whose sum is a total time derivative.
    pub total_derivatives: &'static [TotalDerivative],
    /// Effect of the part of the Lagrangian that is linear in the velocities.
    pub linear_part: LinearPart,
}

impl Facts {
    /// Facts of a system about which nothing is known.
    pub const NONE: Self = Self {
        cyclic: &[],
        conserved: &[],
        energy_is_conserved: None,
        energy_form: EnergyForm::General,
        total_derivatives: &[],
        linear_part: LinearPart::Open,
    };
}
