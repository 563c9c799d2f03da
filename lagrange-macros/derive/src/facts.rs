//! Facts about a system, under the names of `lagrange_core::facts` and `lagrange_core::structure`.

use std::fmt::{self, Display, Formatter};

use crate::mechanics::many::ManyEquations;
pub use crate::mechanics::{
    Classification, ConstraintKind, EnergyForm, Evidence, Integrability, Integrals, LinearPart, Marker,
};
use crate::mechanics::{ConservedKind, Derived};
use crate::render::Rendered;
use crate::resolve::Problem;

/// Facts about a system. A fact that is not listed is false or could not be decided.
///
/// `Display` writes one line for each fact that is known.
///
/// ```
/// use lagrange_derive::System;
/// use lagrange_derive::facts::{EnergyForm, Evidence, Marker};
///
/// let planet = System::parse(
///     "#[coordinates(r, phi)]
///      #[lagrangian(m/2 * (r_dot^2 + r^2 * phi_dot^2) + k/r)]
///      struct Planet { m: f64, k: f64 }",
/// )?;
/// let facts = planet.facts();
/// assert_eq!(facts.cyclic, ["phi"]);
/// assert_eq!(facts.energy_form, EnergyForm::Even(Evidence::Proved));
/// assert_eq!(facts.markers, [Marker::HolonomicConstraints, Marker::Unconstrained]);
/// assert_eq!(facts.to_string(), "\
/// cyclic: phi
/// conserved: p_phi (proved), energy (proved)
/// E = L₂ − L₀, L₁ = 0 (proved)
/// all constraints are holonomic
/// no constraints
/// ");
/// # Ok::<(), lagrange_derive::Refusal>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Facts {
    /// Cyclic coordinates: the Lagrangian contains at most their velocities, and no force or constraint acts along them.
    pub cyclic: Vec<String>,
    /// Conserved quantities: momenta, momentum and angular momentum of all vectors together, the energy, and those given in `#[conserved(…)]`.
    pub conserved: Vec<Conserved>,
    /// Evidence that the energy function E = p·q̇ − L is conserved; `None` if it is not known to be.
    pub energy_is_conserved: Option<Evidence>,
    /// Composition of E: whether it is T + U.
    pub energy_form: EnergyForm,
    /// Terms of the Lagrangian, as written, whose sum is a total time derivative.
    pub total_derivatives: Vec<TotalDerivative>,
    /// Effect of the part of the Lagrangian that is linear in the velocities.
    pub linear_part: LinearPart,
    /// Integrals of the velocity constraints as a set; `None` if their number could not be decided.
    pub integrals: Option<Integrals>,
    /// Marker traits that the system implements.
    pub markers: Vec<Marker>,
}

/// A quantity that the motion conserves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Conserved {
    /// Name: `p_phi` for the momentum of a coordinate `phi`, `momentum[0]` and `angular_momentum[0]` of all vectors together, `energy`,
    /// or the name given in `#[conserved(…)]`.
    pub name: String,
    /// Evidence for the conservation.
    pub evidence: Evidence,
}

/// Terms of the Lagrangian whose sum is a total time derivative df(q, t)/dt, which does not affect the motion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TotalDerivative {
    /// The terms as written, in the notation of [`Equations::text`](crate::Equations::text).
    pub terms: String,
    /// Evidence that the terms are a total derivative.
    pub evidence: Evidence,
}

impl Facts {
    pub(crate) fn new(problem: &Problem, derived: &Derived, rendered: &Rendered) -> Self {
        let found = &derived.facts;
        let energy = found.conserved.iter().find(|conserved| conserved.quantity == ConservedKind::Energy);
        let conserved = found.conserved.iter();
        let totals = rendered.total_derivatives.iter().zip(&found.total_derivatives);
        Self {
            cyclic: found.cyclic.iter().map(|&a| problem.coordinates[a].text.clone()).collect(),
            conserved: conserved
                .map(|found| Conserved { name: found.name.clone(), evidence: found.evidence })
                .collect(),
            energy_is_conserved: energy.map(|energy| energy.evidence),
            energy_form: found.energy_form,
            total_derivatives: totals
                .map(|(terms, total)| TotalDerivative { terms: terms.clone(), evidence: total.evidence })
                .collect(),
            linear_part: found.linear_part,
            integrals: derived.equations.integrability.integrals,
            markers: derived.markers.clone(),
        }
    }
}

impl Facts {
    /// Facts about a system whose number of bodies is known when the program runs.
    pub(crate) fn of_many(equations: &ManyEquations) -> Self {
        let proved = |name: &str| Conserved { name: name.to_owned(), evidence: Evidence::Proved };
        let vectors = equations.conserved.iter().map(|conserved| proved(conserved.symmetry.name()));
        let energy = equations.energy_is_conserved.then(|| proved("energy"));
        let mut markers = Vec::new();
        if equations.forces_are_free_of_velocities {
            markers.push(Marker::VelocityFreeForces);
        }
        Self {
            cyclic: Vec::new(),
            conserved: vectors.chain(energy).collect(),
            energy_is_conserved: equations.energy_is_conserved.then_some(Evidence::Proved),
            energy_form: match equations.is_even {
                true => EnergyForm::Even(Evidence::Proved),
                false => EnergyForm::General,
            },
            total_derivatives: Vec::new(),
            linear_part: if equations.is_even { LinearPart::Absent } else { LinearPart::Open },
            integrals: None,
            markers,
        }
    }
}

impl Display for Facts {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut list = |heading: &str, items: Vec<String>| match items.is_empty() {
            true => Ok(()),
            false => writeln!(f, "{heading}: {}", items.join(", ")),
        };
        list("cyclic", self.cyclic.clone())?;
        let conserved = self.conserved.iter();
        list(
            "conserved",
            conserved.map(|Conserved { name, evidence }| format!("{name} ({evidence})")).collect(),
        )?;
        let totals = self.total_derivatives.iter();
        list(
            "total time derivatives",
            totals.map(|TotalDerivative { terms, evidence }| format!("{terms} ({evidence})")).collect(),
        )?;
        writeln!(f, "{}", self.energy_form)?;
        if let LinearPart::Closed(_) | LinearPart::Open = self.linear_part {
            writeln!(f, "{}", self.linear_part)?;
        }
        if let Some(Integrals { count, of: of @ 1.., evidence }) = self.integrals {
            writeln!(f, "{count} of {of} velocity constraints integrable ({evidence})")?;
        }
        self.markers.iter().try_for_each(|marker| writeln!(f, "{marker}"))
    }
}

impl Display for Evidence {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Proved => f.write_str("proved"),
            Self::Held(0) => f.write_str("no random point was found at which it could be judged"),
            Self::Held(points) => write!(f, "as far as {points} random points show"),
        }
    }
}

impl Display for Integrability {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Holonomic => "holonomic",
            Self::Exact => "integrable",
            Self::IntegratingFactor => "integrable with a factor",
            Self::Together => "integrable together with the others",
            Self::Nonholonomic => "nonholonomic",
            Self::Undecided => "whether it can be integrated is not decided",
        })
    }
}

/// Formats verdict and evidence, as in `nonholonomic (as far as 8 random points show)`.
impl Display for Classification {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.integrability, self.evidence)
    }
}

impl Display for EnergyForm {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sum(evidence) => write!(f, "E = T + U ({evidence})"),
            Self::Even(evidence) => write!(f, "E = L₂ − L₀, L₁ = 0 ({evidence})"),
            Self::Moving => f.write_str("E = p·q̇ − L, not T + U: positions depend on the time"),
            Self::Quadratic => f.write_str("E = L₂ − L₀"),
            Self::General => f.write_str("E = p·q̇ − L"),
        }
    }
}

impl Display for LinearPart {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absent => f.write_str("L₁ = 0"),
            Self::Closed(evidence) => {
                write!(f, "L₁ adds no force that depends on the velocities ({evidence})")
            }
            Self::Open => f.write_str("L₁ adds gyroscopic forces, as far as is known"),
        }
    }
}

impl Display for Marker {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::ConstantMassMatrix => "the mass matrix is constant",
            Self::VelocityFreeForces => "the forces do not depend on the velocities",
            Self::HolonomicConstraints => "all constraints are holonomic",
            Self::Unconstrained => "no constraints",
        })
    }
}
