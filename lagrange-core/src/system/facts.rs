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

/// What the derive found out about a system: [`Lagrangian::FACTS`](crate::Lagrangian::FACTS).
///
/// What is not listed is false or could not be decided.
///
/// ```
/// use lagrange_core::{Evidence, prelude::*};
///
/// /// A planet around a fixed sun.
/// #[derive(Lagrangian)]
/// #[coordinates(r, phi)]
/// #[lagrangian(m/2 * (r_dot^2 + r^2 * phi_dot^2) + k/r)]
/// struct Planet { m: f64, k: f64 }
///
/// assert_eq!(Planet::FACTS.cyclic, ["phi"]);
/// assert!(Planet::FACTS.conserved.iter().map(|found| found.name).eq(["p_phi", "energy"]));
/// assert_eq!(Planet::FACTS.energy_is_t_plus_u, Some(Evidence::Proved));
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
    /// Whether E is T + U, with T the part of L that is quadratic in the velocities and −U the rest, which is free
    /// of them.
    pub energy_is_t_plus_u: Option<Evidence>,
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
        energy_is_t_plus_u: None,
        total_derivatives: &[],
        linear_part: LinearPart::Open,
    };
}
