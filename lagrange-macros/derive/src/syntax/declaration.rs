//! Attributes as the user wrote them.

use proc_macro2::TokenStream;

use super::expression::Expression;
use super::field::{Field, Lengths, Property, numbers};
use super::name::Name;
use super::structure::Structure;
use super::target::{Target, TargetIndex};

/// The struct and its attributes, before names are resolved.
pub(crate) struct Declaration {
    pub(crate) ident: syn::Ident,
    pub(crate) visibility: syn::Visibility,
    pub(crate) generics: syn::Generics,
    pub(crate) fields: Vec<Field>,
    pub(crate) coordinates: Vec<Coordinate>,
    /// True if the list of coordinates was read without an error.
    pub(crate) are_coordinates_read: bool,
    pub(crate) defines: Vec<Define>,
    pub(crate) functions: Vec<FunctionDeclaration>,
    pub(crate) frames: Vec<FrameDeclaration>,
    pub(crate) lagrangian: Option<Expression>,
    pub(crate) constraints: Vec<Constraint>,
    pub(crate) forces: Vec<Force>,
    pub(crate) powers: Vec<Power>,
    pub(crate) dissipation: Option<Expression>,
    pub(crate) observables: Vec<Named>,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) options: Options,
    /// Hash of the attributes and fields that determine the motion.
    pub(crate) digest: u32,
}

impl Declaration {
    /// Expressions that determine the motion.
    pub(crate) fn expressions(&self) -> impl Iterator<Item = &Expression> {
        let forces = self.forces.iter().map(|force| &force.value);
        let defines = self.defines.iter().map(|define| &define.body);
        self.lagrangian.iter().chain(&self.dissipation).chain(defines).chain(forces)
    }

    /// True if the number of coordinates is known when the program runs.
    pub(crate) fn has_open_lengths(&self) -> bool {
        self.coordinates.iter().any(|coordinate| !coordinate.open.is_empty())
    }
}

/// One entry of `#[coordinates(x, r: [3], corners: [4, 3], masses: [n, 3])]`.
#[derive(Clone, Debug)]
pub(crate) struct Coordinate {
    pub(crate) name: Name,
    /// Lengths that are known when the program runs, outermost first. Those of one element follow.
    pub(crate) open: Vec<Expression>,
    /// Array lengths, outermost first; empty for a number.
    pub(crate) lengths: Vec<usize>,
}

impl Coordinate {
    /// Number of scalar coordinates; of one element if there are elements whose number is known when the program runs.
    pub(crate) fn count(&self) -> usize {
        numbers(&self.lengths)
    }
}

/// `#[define(name = expression)]`
#[derive(Debug)]
pub(crate) struct Define {
    pub(crate) target: Target,
    /// Arguments of a function definition, `#[define(f(x) = …)]`.
    pub(crate) formals: Option<Vec<Name>>,
    pub(crate) body: Expression,
}

/// `#[frame(body in parent: translate(v), rotate_z(angle))]`
#[derive(Debug)]
pub(crate) struct FrameDeclaration {
    pub(crate) target: Target,
    /// Parent frame; `None` for the inertial frame.
    pub(crate) parent: Option<Expression>,
    /// Translations and rotations from the parent frame, each in the axes that result from the preceding steps.
    pub(crate) steps: Vec<Expression>,
    /// Number of definitions before the frame.
    pub(crate) definitions: usize,
}

/// `#[function(Omega(t): [3] = omega)]`
#[derive(Debug)]
pub(crate) struct FunctionDeclaration {
    pub(crate) name: Name,
    /// Formal arguments, each with its array lengths; empty for a number.
    pub(crate) formals: Vec<(Name, Vec<usize>)>,
    /// Array lengths of the result; empty for a number.
    pub(crate) lengths: Vec<usize>,
    /// Field that holds the function; by default the field with the name of the function.
    pub(crate) field: Name,
}

/// `#[constraint(name: left = right)]` or `#[constraint(name: left = right, when: field)]`
#[derive(Debug)]
pub(crate) struct Constraint {
    pub(crate) target: Target,
    pub(crate) left: Expression,
    pub(crate) right: Expression,
    /// True for the unit constraint that is implied by a frame rotated by a quaternion.
    pub(crate) is_implied: bool,
    /// Field that says whether the constraint holds; without one it always does. That of a contact or of friction has its
    /// name.
    pub(crate) when: Option<Name>,
    pub(crate) law: Law,
}

/// Law of impact of a contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum ImpactLaw {
    #[default]
    Newton,
    Poisson,
}

/// What holds where a constraint does not, and between its multiplier and its rate where it does.
#[derive(Debug)]
pub(crate) enum Law {
    /// The equation alone.
    Equation,
    /// `#[contact(name: left >= right, restitution: e)]`, whose gap is left − right.
    Contact {
        /// Coefficient of restitution; zero if it is not given.
        restitution: Option<Expression>,
        impact: ImpactLaw,
    },
    /// `friction(mu): velocity` or `friction(static: mu, kinetic: nu): velocity` of the contact before.
    Coulomb {
        /// Coefficient while the bodies stick; that of sliding if it is not given.
        limit: Option<Expression>,
        sliding: Expression,
    },
    /// `#[friction(name: velocity, limit: bound, sliding: force)]`
    Dry {
        /// Largest force while the bodies stick; the sliding force if it is not given.
        limit: Option<Expression>,
        sliding: Expression,
    },
}

/// `#[force(coordinate: expression)]`
#[derive(Debug)]
pub(crate) struct Force {
    pub(crate) target: Target,
    pub(crate) value: Expression,
}

/// `#[power(force, velocity)]` or `#[power(i in 0..3, force, velocity)]`
#[derive(Debug)]
pub(crate) struct Power {
    /// Summation indices. The power is summed over all their values.
    pub(crate) indices: Vec<TargetIndex>,
    pub(crate) force: Expression,
    pub(crate) velocity: Expression,
}

/// `#[observable(name = expression)]` or `#[conserved(name = expression)]`
#[derive(Debug)]
pub(crate) struct Named {
    pub(crate) target: Target,
    pub(crate) is_conserved: bool,
    pub(crate) value: Expression,
}

/// `#[parameter(a: [3])]`, `#[parameter(e: 0..1)]`, `#[parameter(I: symmetric)]` or `#[parameter(link: [6] {m, c: [3]})]`
#[derive(Debug)]
pub(crate) struct Parameter {
    pub(crate) name: Name,
    pub(crate) fact: Fact,
}

/// Fact that a `#[parameter(…)]` states about a field.
#[derive(Debug)]
pub(crate) enum Fact {
    Shape(Lengths),
    Range(Expression, Expression),
    Property(Property),
    Struct(Structure),
}

/// `#[lagrange(crate = path, scalar = T)]`
#[derive(Default)]
pub(crate) struct Options {
    pub(crate) runtime: Option<TokenStream>,
    pub(crate) scalar: Option<syn::Type>,
}
