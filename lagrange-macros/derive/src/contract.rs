//! Tables of the runtime traits that the derive implements. They determine the emitted methods, the stubs emitted
//! after an error, and the reserved names that an observable cannot have.

/// A method of a trait.
#[derive(Clone, Copy)]
pub(crate) struct Method {
    pub(crate) quantity: Quantity,
    pub(crate) name: &'static str,
    pub(crate) takes: &'static [Argument],
    pub(crate) gives: Gives,
    /// True if the method is generic over a number type that broadcasts scalars of the system, such as SIMD lanes.
    pub(crate) is_wide: bool,
}

/// Quantity that a method computes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Quantity {
    Lagrangian,
    Energy,
    EnergyRate,
    Momentum,
    MomentumRate,
    MassMatrix,
    CompletedMomentum,
    CompletedMomentumRate,
    CompletedMassMatrix,
    Compliance,
    Law,
    Forcing,
    Residual,
    Rate,
    Jacobian,
    JacobianRoundOff,
    Bias,
    Integral,
    ConstraintForce,
    InverseDynamics,
    Accelerations,
    Factor,
    Solve,
    ResidualMagnitude,
    RateMagnitude,
    Observable,
    Conserved,
    Parameters,
    SetParameter,
    Slopes,
    ResidualChange,
    ParameterSlopes,
    ResidualChangeByParameters,
    SeriesSlopes,
    SeriesRightHandSides,
    SeriesFactors,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Argument {
    System,
    MutableSystem,
    State,
    Solution,
    Accelerations,
    Multipliers,
    Direction,
    Factor,
    Slopes,
    ParameterSlopes,
    SeriesSlopes,
    Sums,
    Terms,
    Order,
    Forcing,
    Bias,
    Rates,
    Index,
    Value,
}

impl Argument {
    pub(crate) fn name(self) -> &'static str {
        match self {
            System => "&self",
            MutableSystem => "&mut self",
            State => "state",
            Solution => "solution",
            Self::Accelerations => "accelerations",
            Multipliers => "multipliers",
            Direction => "direction",
            Self::Factor => "factor",
            Self::Slopes | Self::ParameterSlopes | Self::SeriesSlopes => "slopes",
            Self::Sums => "sums",
            Self::Terms => "terms",
            Self::Order => "order",
            Forcing => "forcing",
            Bias => "bias",
            Rates => "rates",
            Index => "index",
            Value => "value",
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Gives {
    Number,
    Vector(Dimension),
    /// Rows and columns.
    Matrix(Dimension, Dimension),
    Solution,
    Factor,
    Slopes,
    ParameterSlopes,
    SeriesSlopes,
    /// Right-hand sides in place of h and γ for one Taylor order, and the parts of the coefficients of this
    /// order that are known before the accelerations.
    RightHandSides,
    /// Coefficients of one Taylor order of the left and right factors of each convolution sum.
    Factors,
    ResidualChange,
    /// `Option` of a number: `None` if there is none of that index.
    Optional,
    /// `bool`: true on success.
    Success,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Dimension {
    Coordinates,
    Constraints,
    Parameters,
}

use Argument::{
    Bias, Direction, Forcing, Index, Multipliers, MutableSystem, Rates, Solution, State, System, Value,
};
use Dimension::{Constraints, Coordinates, Parameters};
use Gives::{Matrix, Number, Optional, Vector};

const fn method(quantity: Quantity, name: &'static str, takes: &'static [Argument], gives: Gives) -> Method {
    Method { quantity, name, takes, gives, is_wide: false }
}

/// Method that is generic over the number type; see [`Method::is_wide`].
const fn wide(quantity: Quantity, name: &'static str, takes: &'static [Argument], gives: Gives) -> Method {
    Method { quantity, name, takes, gives, is_wide: true }
}

/// Method that takes only a state.
const fn of_state(quantity: Quantity, name: &'static str, gives: Gives) -> Method {
    method(quantity, name, &[System, State], gives)
}

/// Emitted methods of `Lagrangian`, in this order.
pub(crate) const LAGRANGIAN: [Method; 21] = [
    of_state(Quantity::Lagrangian, "lagrangian", Number),
    of_state(Quantity::Energy, "energy", Number),
    method(Quantity::EnergyRate, "energy_rate", &[System, State, Multipliers], Number),
    of_state(Quantity::Momentum, "momentum", Vector(Coordinates)),
    of_state(Quantity::MomentumRate, "momentum_rate", Vector(Coordinates)),
    of_state(Quantity::MassMatrix, "mass_matrix", Matrix(Coordinates, Coordinates)),
    of_state(Quantity::Forcing, "forcing", Vector(Coordinates)),
    of_state(Quantity::Residual, "constraint_residual", Vector(Constraints)),
    of_state(Quantity::Rate, "constraint_rate", Vector(Constraints)),
    of_state(Quantity::ResidualMagnitude, "residual_magnitude", Vector(Constraints)),
    of_state(Quantity::RateMagnitude, "rate_magnitude", Vector(Constraints)),
    of_state(Quantity::Jacobian, "constraint_jacobian", Matrix(Constraints, Coordinates)),
    of_state(Quantity::Bias, "constraint_bias", Vector(Constraints)),
    method(Quantity::Integral, "constraint_integral", &[System, Index, State], Optional),
    method(Quantity::ConstraintForce, "constraint_force", &[System, State, Multipliers], Vector(Coordinates)),
    method(
        Quantity::InverseDynamics,
        "inverse_dynamics",
        &[System, State, Argument::Accelerations, Multipliers],
        Vector(Coordinates),
    ),
    of_state(Quantity::Accelerations, "accelerations_unchecked", Gives::Solution),
    of_state(Quantity::Factor, "factor", Gives::Factor),
    wide(Quantity::Solve, "solve_with", &[System, Argument::Factor, Forcing, Bias], Gives::Solution),
    method(Quantity::Observable, "observable", &[System, Index, State, Solution], Optional),
    method(Quantity::Conserved, "conserved", &[System, Index, State], Optional),
];

/// Methods of `Lagrangian` that are emitted where constraints complete M.
pub(crate) const COMPLETED: [Method; 3] = [
    of_state(Quantity::CompletedMomentum, "completed_momentum", Vector(Coordinates)),
    of_state(Quantity::CompletedMomentumRate, "completed_momentum_rate", Vector(Coordinates)),
    of_state(Quantity::CompletedMassMatrix, "completed_mass_matrix", Matrix(Coordinates, Coordinates)),
];

/// Method of `Lagrangian` that is emitted where a field switches a constraint.
pub(crate) const SWITCHED: [Method; 1] =
    [method(Quantity::Compliance, "compliance", &[System], Vector(Constraints))];

/// Method of `Lagrangian` that is emitted where parameters may cancel a row of F.
pub(crate) const CANCELLING: [Method; 1] =
    [of_state(Quantity::JacobianRoundOff, "jacobian_round_off", Matrix(Constraints, Coordinates))];

/// Methods of `Contacts`.
pub(crate) const RESTITUTION: Method =
    method(Quantity::Law, "restitution", &[System, Index, State], Optional);
pub(crate) const FRICTION_LIMIT: Method =
    method(Quantity::Law, "friction_limit", &[System, Index, State], Optional);
pub(crate) const SLIDING_FRICTION: Method =
    method(Quantity::Law, "sliding_friction", &[System, Index, State], Optional);

/// Required methods of `StateDerivatives`.
pub(crate) const STATE_DERIVATIVES: [Method; 2] = [
    method(Quantity::Slopes, "residual_slopes", &[System, State, Solution], Gives::Slopes),
    wide(
        Quantity::ResidualChange,
        "residual_change_with",
        &[System, Argument::Slopes, Direction],
        Gives::ResidualChange,
    ),
];

/// Method of `StateDerivatives` that is emitted where bodies are differentiated by their tree.
pub(crate) const CHANGE_BESIDE_GRADIENTS: Method = wide(
    Quantity::ResidualChange,
    "residual_change_beside_gradients",
    &[System, Argument::Slopes, Direction],
    Gives::ResidualChange,
);

/// Required methods of `Linearized`.
pub(crate) const LINEARIZED: [Method; 4] = [
    method(Quantity::Parameters, "parameters", &[System], Vector(Parameters)),
    method(Quantity::SetParameter, "set_parameter", &[MutableSystem, Index, Value], Gives::Success),
    method(
        Quantity::ParameterSlopes,
        "residual_slopes_by_parameters",
        &[System, State, Solution],
        Gives::ParameterSlopes,
    ),
    wide(
        Quantity::ResidualChangeByParameters,
        "residual_change_by_parameters_with",
        &[System, Argument::ParameterSlopes, Rates],
        Gives::ResidualChange,
    ),
];

/// Emitted methods of `TaylorSeries`.
pub(crate) const TAYLOR_SERIES: [Method; 3] = [
    method(Quantity::SeriesSlopes, "series_slopes", &[System, State, Solution], Gives::SeriesSlopes),
    method(
        Quantity::SeriesRightHandSides,
        "series_right_hand_sides",
        &[System, Argument::SeriesSlopes, Argument::Sums, Argument::Order, Direction],
        Gives::RightHandSides,
    ),
    method(
        Quantity::SeriesFactors,
        "series_factors",
        &[
            System,
            Argument::SeriesSlopes,
            Argument::Terms,
            Argument::Order,
            Direction,
            Argument::Accelerations,
            Multipliers,
        ],
        Gives::Factors,
    ),
];

/// Associated constants of these traits.
const CONSTANTS: [&str; 22] = [
    "STATE_ARGUMENTS",
    "DEPENDS_ON_TIME",
    "QUATERNIONS",
    "HAS_CONTACTS",
    "HAS_FRICTION",
    "HAS_PLANAR_FRICTION",
    "ARGUMENTS",
    "NAME",
    "DIGEST",
    "SUPPLIED",
    "COORDINATES",
    "CONSTRAINTS",
    "CONSTRAINT_KINDS",
    "CONSTRAINT_CLASSES",
    "INTEGRALS",
    "MOMENTA_ARE_LINEAR",
    "OBSERVABLES",
    "FACTS",
    "EQUATIONS",
    "PARAMETERS",
    "ROOTS",
    "STEEP",
];

/// Methods with a default implementation in `Lagrangian`, `StateDerivatives`, `Linearized` or `TaylorSeries`, and all
/// methods of `Simulate`, `Hamiltonian`, `MotionDerivatives` and `PeriodicMotion`.
const PROVIDED: [&str; 55] = [
    "motion_gradients",
    "residual_change_beside_gradients",
    "residual_change_by",
    "inertial_parameters",
    "regressor",
    "complete_accelerations",
    "linearize_locally",
    "local_coordinates",
    "local_change",
    "locally_changed",
    "jacobian_round_off",
    "compliance",
    "slides",
    "completed_momentum",
    "completed_momentum_rate",
    "completed_mass_matrix",
    "visit_parameters",
    "visit_defects",
    "solve",
    "check_consistent",
    "make_consistent",
    "assemble",
    "make_consistent_holding",
    "state_from",
    "integrate",
    "motion",
    "motion_in_momenta",
    "integrate_hamiltonian",
    "sensitivity",
    "differentiable_event",
    "motion_with_derivatives",
    "impact_sensitivity",
    "push_forward",
    "sample",
    "event",
    "impact",
    "hamiltonian",
    "hamilton_equations",
    "legendre",
    "legendre_near",
    "phase_state",
    "residual_change",
    "state_jacobian",
    "residual_change_by_parameters",
    "jacobian",
    "jacobian_by",
    "inputs_for",
    "integrate_sensitivities",
    "lyapunov_spectrum",
    "linearize",
    "equilibrium",
    "series_functions",
    "monodromy",
    "monodromy_across",
    "periodic_orbit",
];

/// Inherent function of the struct, and methods of traits that other derives implement.
const OTHERS: [&str; 10] =
    ["equations", "clone", "clone_from", "fmt", "eq", "ne", "hash", "cmp", "partial_cmp", "default"];

/// True if every system already has an item of this name, so that no observable can have it.
pub(crate) fn is_reserved(name: &str) -> bool {
    let emitted = LAGRANGIAN.iter().chain(&STATE_DERIVATIVES).chain(&LINEARIZED).chain(&TAYLOR_SERIES);
    let is_method = emitted.into_iter().any(|method| method.name == name);
    is_method || CONSTANTS.contains(&name) || PROVIDED.contains(&name) || OTHERS.contains(&name)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::path::{Path, PathBuf};

    use quote::quote;
    use syn::{FnArg, Item, ItemTrait, Pat, TraitItem};

    use super::*;

    fn sources(folder: &Path) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).expect("the runtime beside this crate");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        paths.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] }).collect()
    }

    /// Traits of the runtime, by name.
    fn traits() -> BTreeMap<String, ItemTrait> {
        let runtime = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../lagrange-core/src");
        let files =
            sources(&runtime).into_iter().filter(|path| path.extension().is_some_and(|end| end == "rs"));
        let items = files.flat_map(|path| {
            let text = std::fs::read_to_string(path).expect("a source");
            syn::parse_file(&text).expect("Rust").items
        });
        let traits = items.filter_map(|item| match item {
            Item::Trait(item) => Some((item.ident.to_string(), item)),
            _ => None,
        });
        traits.collect()
    }

    /// Methods of a trait, by name: the names of the arguments, and whether there is a default implementation.
    fn methods(of: &ItemTrait) -> BTreeMap<String, (Vec<String>, bool)> {
        let methods = of.items.iter().filter_map(|item| {
            let TraitItem::Fn(method) = item else { return None };
            let arguments = method.sig.inputs.iter().map(|argument| match argument {
                FnArg::Receiver(receiver) => quote!(#receiver).to_string().replace("& ", "&"),
                FnArg::Typed(argument) => match &*argument.pat {
                    Pat::Ident(name) => name.ident.to_string(),
                    _ => String::new(),
                },
            });
            Some((method.sig.ident.to_string(), (arguments.collect(), method.default.is_some())))
        });
        methods.collect()
    }

    /// A pointer to a system would give the default of what it does not forward.
    #[test]
    fn pointers_forward_all_of_a_system() {
        let pointers =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../lagrange-core/src/system/pointers.rs");
        let pointers = std::fs::read_to_string(pointers).expect("a source");
        for item in &traits()["Lagrangian"].items {
            let named = match item {
                TraitItem::Fn(method) => format!("fn {}", method.sig.ident),
                TraitItem::Const(constant) => format!("const {}:", constant.ident),
                _ => continue,
            };
            let is_forwarded = |line: &str| {
                let line = line.trim_start();
                line.strip_prefix(&named)
                    .is_some_and(|rest| !rest.starts_with(|c: char| c == '_' || c.is_alphanumeric()))
            };
            assert!(pointers.lines().any(is_forwarded), "`{named}` is not forwarded");
        }
    }

    #[test]
    fn the_lists_are_those_of_the_runtime() {
        let traits = traits();
        let mut provided = Vec::new();
        let mut constants = Vec::new();
        for (name, emitted) in [
            ("Lagrangian", &LAGRANGIAN[..]),
            ("StateDerivatives", &STATE_DERIVATIVES[..]),
            ("Linearized", &LINEARIZED[..]),
            ("TaylorSeries", &TAYLOR_SERIES[..]),
        ] {
            let methods = methods(&traits[name]);
            for method in emitted {
                let arguments: Vec<String> =
                    method.takes.iter().map(|argument| argument.name().to_owned()).collect();
                assert_eq!(
                    methods.get(method.name).map(|found| &found.0),
                    Some(&arguments),
                    "{}",
                    method.name
                );
            }
            for (method, (_, is_provided)) in methods {
                let is_emitted = emitted.iter().any(|known| known.name == method);
                assert!(is_emitted || is_provided, "{name}::{method} is not implemented");
                provided.extend((!is_emitted).then_some(method));
            }
            constants.extend(traits[name].items.iter().filter_map(|item| match item {
                TraitItem::Const(constant) => Some(constant.ident.to_string()),
                _ => None,
            }));
        }
        for name in ["Simulate", "Hamiltonian", "MotionDerivatives", "PeriodicMotion"] {
            provided.extend(methods(&traits[name]).into_keys());
        }
        let sorted = |names: &[&str]| {
            let mut names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            names.sort();
            names
        };
        provided.sort();
        constants.sort();
        assert_eq!((provided, constants), (sorted(&PROVIDED), sorted(&CONSTANTS)));
    }
}
