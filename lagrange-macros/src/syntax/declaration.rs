//! What the user wrote, attribute by attribute.

use proc_macro2::TokenStream;

use super::expression::Expression;
use super::field::{Field, Property, numbers};
use super::name::Name;
use super::structure::Structure;
use super::target::{Target, TargetIndex};

/// The struct and its attributes as written.
pub(crate) struct Declaration {
    pub(crate) ident: syn::Ident,
    pub(crate) visibility: syn::Visibility,
    pub(crate) generics: syn::Generics,
    pub(crate) fields: Vec<Field>,
    pub(crate) coordinates: Vec<Coordinate>,
    /// Whether these are all.
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

/// `#[coordinates(x, r: [3], corners: [4, 3])]`, one entry.
#[derive(Clone, Debug)]
pub(crate) struct Coordinate {
    pub(crate) name: Name,
    /// From the outside in: none for a number.
    pub(crate) lengths: Vec<usize>,
}

impl Coordinate {
    /// How many numbers it is.
    pub(crate) fn count(&self) -> usize {
        numbers(&self.lengths)
    }
}

/// `#[define(name = expression)]`
#[derive(Debug)]
pub(crate) struct Define {
    pub(crate) target: Target,
    /// `#[define(f(x) = …)]`
    pub(crate) formals: Option<Vec<Name>>,
    pub(crate) body: Expression,
}

/// `#[frame(body in parent: translate(v), rotate_z(angle))]`
#[derive(Debug)]
pub(crate) struct FrameDeclaration {
    pub(crate) target: Target,
    /// The frame that it is in; the fixed one where none is named.
    pub(crate) parent: Option<Expression>,
    /// How it comes from there, each step in the axes that the steps before have led to.
    pub(crate) steps: Vec<Expression>,
    /// Number of definitions that precede it.
    pub(crate) definitions: usize,
}

/// `#[function(Omega(t): [3] = omega)]`
#[derive(Debug)]
pub(crate) struct FunctionDeclaration {
    pub(crate) name: Name,
    /// Each formal, with its lengths if it says any.
    pub(crate) formals: Vec<(Name, Vec<usize>)>,
    /// The lengths of the result: none where it is a number.
    pub(crate) lengths: Vec<usize>,
    /// The field; by default the one of the function's name.
    pub(crate) field: Name,
}

/// `#[constraint(name: left = right)]`
#[derive(Debug)]
pub(crate) struct Constraint {
    pub(crate) target: Target,
    pub(crate) left: Expression,
    pub(crate) right: Expression,
    /// True for the unit constraint of a quaternion that turns a frame, which the user did not write.
    pub(crate) is_implied: bool,
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
    /// For each of these, and in all.
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

/// What is said of a field.
#[derive(Debug)]
pub(crate) enum Fact {
    Shape(Vec<usize>),
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
