//! Expression graph with hash-consing: equal expressions are one node.

use indexmap::IndexSet;
use num_traits::{One, Zero};
use rustc_hash::FxBuildHasher;

use super::rational::{self, Rational};
use super::rounded::Roundings;
use super::scaled::Scaled;

/// Index of a node in its [`Graph`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Id(pub(super) u32);

impl Id {
    /// The number 0.
    pub const ZERO: Self = Self(0);
    /// The number 1.
    pub const ONE: Self = Self(1);

    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A free variable. The caller defines the meaning of `family` and `index`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Symbol {
    pub family: u8,
    pub index: u32,
}

/// Functions of one argument. Powers and roots are not functions, but exponents of factors in a product.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Abs,
    /// max(x, 0), from which `max` and `min` are built.
    Ramp,
    /// Derivative of `Ramp`: 0 for x < 0, 1 for x > 0.
    Step,
}

impl Function {
    /// Every function, with its name in expressions, formulas and emitted code. The last two cannot be called in
    /// expressions.
    const NAMES: [(&'static str, Self); 14] = [
        ("sin", Self::Sin),
        ("cos", Self::Cos),
        ("tan", Self::Tan),
        ("asin", Self::Asin),
        ("acos", Self::Acos),
        ("atan", Self::Atan),
        ("sinh", Self::Sinh),
        ("cosh", Self::Cosh),
        ("tanh", Self::Tanh),
        ("exp", Self::Exp),
        ("ln", Self::Ln),
        ("abs", Self::Abs),
        ("ramp", Self::Ramp),
        ("step", Self::Step),
    ];

    /// Functions that expressions may call: all but `ramp` and `step`.
    pub fn callable() -> impl Iterator<Item = (&'static str, Self)> {
        Self::NAMES.into_iter().filter(|(_, function)| !matches!(function, Self::Ramp | Self::Step))
    }

    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].0
    }

    pub fn named(name: &str) -> Option<Self> {
        Self::callable().find(|(known, _)| *known == name).map(|(_, function)| function)
    }
}

/// An operation on earlier nodes.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    Number(Rational),
    Pi,
    Symbol(Symbol),
    /// Σ coefficient · term, sorted by term, each term once; a constant is a multiple of [`Id::ONE`].
    Sum(Box<[(Id, Rational)]>),
    /// Π factor ^ exponent, sorted by factor, each factor once. A factor is a number in two cases only: as the base of
    /// a root, or as a power of 10 that does not fit into 128 bits together with the coefficient.
    Product(Box<[(Id, Rational)]>),
    Function(Function, Id),
    /// Angle of the point (x, y), stored as (y, x).
    Atan2(Id, Id),
    /// (base, exponent), where the exponent is not a number.
    Power(Id, Id),
    /// A named intermediate, equal to the expression it holds. Simplification does not cross its boundary, so that
    /// recursive definitions keep their partial sums.
    Defined(Id),
    /// A function supplied by the user, unknown to the graph, or a partial derivative of it.
    External(Box<External>),
}

/// ∂^k f_o(x₀, x₁, …)/∂x_i ∂x_j … for the function `function` and its result `output`, or the derivative of it along a
/// direction v, Σ v_i ∂/∂x_i.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct External {
    pub function: u32,
    pub output: u32,
    /// Positions i ≤ j ≤ … of the arguments of differentiation.
    pub derivatives: Box<[u32]>,
    /// The arguments x, followed by the direction v if there is one.
    pub arguments: Box<[Id]>,
    pub is_along: bool,
}

impl External {
    /// Number of the arguments, without those of the direction.
    pub fn inputs(&self) -> usize {
        if self.is_along { self.arguments.len() / 2 } else { self.arguments.len() }
    }

    /// Number of derivatives taken, partial or along a direction.
    pub fn order(&self) -> usize {
        self.derivatives.len() + usize::from(self.is_along)
    }
}

/// Failure of exact arithmetic. The first fault stays until it is [taken](Graph::take_fault).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fault {
    /// A number beyond the range of `f64`, or an exponent with too many digits.
    Overflow,
    /// Division by an expression that is identically zero.
    DivisionByZero,
    /// More than [`Graph::LIMIT`] nodes.
    TooLarge,
}

/// An arena of expressions.
#[derive(Debug)]
pub struct Graph {
    nodes: IndexSet<Node, FxBuildHasher>,
    /// Node of the number 10, once a product has a power of it as a factor.
    pub(super) ten: Option<Id>,
    /// Rounding errors of constants with more digits than an exact fraction can hold.
    pub(super) roundings: Roundings,
    fault: Option<Fault>,
}

impl Default for Graph {
    fn default() -> Self {
        let mut graph =
            Self { nodes: IndexSet::default(), ten: None, roundings: Roundings::default(), fault: None };
        graph.number(Rational::zero());
        graph.number(Rational::one());
        graph
    }
}

impl Graph {
    /// Largest number of nodes: larger graphs come from runaway definitions.
    pub const LIMIT: usize = 1 << 20;

    pub fn node(&self, id: Id) -> &Node {
        &self.nodes[id.index()]
    }

    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    pub fn number(&mut self, value: Rational) -> Id {
        if rational::fits(&value) { self.intern(Node::Number(value)) } else { self.fail(Fault::Overflow) }
    }

    pub fn integer(&mut self, value: i128) -> Id {
        self.number(Rational::from_integer(value))
    }

    pub fn symbol(&mut self, symbol: Symbol) -> Id {
        self.intern(Node::Symbol(symbol))
    }

    pub fn pi(&mut self) -> Id {
        self.intern(Node::Pi)
    }

    /// Value of a node that is a rational number of any magnitude; `None` otherwise.
    pub fn as_scaled(&self, id: Id) -> Option<Scaled> {
        let (term, fraction) = match self.node(id) {
            Node::Number(value) => return Some((*value).into()),
            Node::Sum(terms) if terms.len() == 1 => terms[0],
            _ => (id, Rational::one()),
        };
        match self.node(term) {
            Node::Product(factors) if factors.len() == 1 && self.is_power_of_ten(factors[0]) => {
                Some(Scaled { fraction, exponent: self.power_of_ten(factors) })
            }
            _ => None,
        }
    }

    /// Exponent of 10 in a product, or 0.
    pub fn power_of_ten(&self, factors: &[(Id, Rational)]) -> i32 {
        let ten = factors.iter().find(|factor| self.is_power_of_ten(**factor));
        ten.and_then(|(_, exponent)| i32::try_from(exponent.to_integer()).ok()).unwrap_or(0)
    }

    /// True if a factor is an integer power of 10.
    pub fn is_power_of_ten(&self, (factor, exponent): (Id, Rational)) -> bool {
        Some(factor) == self.ten && exponent.is_integer()
    }

    /// Value of a node that is an exact number; `None` otherwise.
    pub fn as_number(&self, id: Id) -> Option<Rational> {
        match self.node(id) {
            Node::Number(value) => Some(*value),
            _ => None,
        }
    }

    /// Makes `inner` a definition, unless it has no operands or is a definition already.
    pub fn defined(&mut self, inner: Id) -> Id {
        match self.node(inner) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Defined(_) => inner,
            _ if self.as_scaled(inner).is_some() => inner,
            _ => self.intern(Node::Defined(inner)),
        }
    }

    pub fn take_fault(&mut self) -> Option<Fault> {
        self.fault.take()
    }

    /// Records a fault. The returned placeholder is never used.
    pub(super) fn fail(&mut self, fault: Fault) -> Id {
        self.fault.get_or_insert(fault);
        Id::ZERO
    }

    pub(super) fn intern(&mut self, node: Node) -> Id {
        if self.nodes.len() >= Self::LIMIT && !self.nodes.contains(&node) {
            return self.fail(Fault::TooLarge);
        }
        let (index, _) = self.nodes.insert_full(node);
        Id(index as u32)
    }

    /// Calls `visit` with every operand of `id`.
    pub fn operands(&self, id: Id, mut visit: impl FnMut(Id)) {
        match self.node(id) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => {}
            Node::Sum(parts) | Node::Product(parts) => parts.iter().for_each(|&(part, _)| visit(part)),
            Node::Function(_, x) | Node::Defined(x) => visit(*x),
            Node::External(external) => external.arguments.iter().for_each(|&x| visit(x)),
            Node::Atan2(x, y) | Node::Power(x, y) => {
                visit(*x);
                visit(*y);
            }
        }
    }

    /// Factors of `id`, without numbers and exponents.
    pub fn factors(&self, id: Id) -> Vec<Id> {
        match self.node(id) {
            Node::Number(_) => Vec::new(),
            Node::Sum(terms) if terms.len() == 1 => self.factors(terms[0].0),
            Node::Product(factors) => factors.iter().map(|&(factor, _)| factor).collect(),
            _ => vec![id],
        }
    }

    /// All nodes, operands before the nodes that use them.
    pub fn ids(&self) -> impl Iterator<Item = Id> + use<> {
        (0..self.len() as u32).map(Id)
    }

    /// All nodes below `roots`, operands before the nodes that use them.
    pub fn reachable(&self, roots: &[Id]) -> Vec<Id> {
        self.reachable_to(roots, &[])
    }

    /// All nodes below `roots`, but not those below `leaves`.
    pub(super) fn reachable_to(&self, roots: &[Id], leaves: &[Id]) -> Vec<Id> {
        let mut seen = vec![false; self.len()];
        let mut is_leaf = vec![false; self.len()];
        leaves.iter().for_each(|leaf| is_leaf[leaf.index()] = true);
        let mut pending = roots.to_vec();
        let mut found = Vec::new();
        while let Some(id) = pending.pop() {
            if !std::mem::replace(&mut seen[id.index()], true) {
                found.push(id);
                if !is_leaf[id.index()] {
                    self.operands(id, |operand| pending.push(operand));
                }
            }
        }
        found.sort_unstable();
        found
    }

    /// Argument of the first [`Function::Ramp`] or [`Function::Step`] in `root`.
    pub fn kink(&self, root: Id) -> Option<Id> {
        self.reachable(&[root]).into_iter().find_map(|id| match self.node(id) {
            Node::Function(Function::Ramp | Function::Step, argument) => Some(*argument),
            _ => None,
        })
    }

    /// True if one of `roots` has a kink: values at random points say nothing about the other side of it.
    pub fn is_piecewise(&self, roots: &[Id]) -> bool {
        self.reachable(roots).into_iter().any(|id| match self.node(id) {
            Node::Function(Function::Abs | Function::Ramp | Function::Step, _) => true,
            // √(x²) is |x|.
            Node::Product(factors) => {
                factors.iter().any(|(base, exponent)| exponent.denom() % 2 == 0 && self.is_square(*base))
            }
            _ => false,
        })
    }

    /// True if the expression is a number times a square.
    fn is_square(&self, id: Id) -> bool {
        match self.node(id) {
            Node::Sum(terms) => terms.len() == 1 && self.is_square(terms[0].0),
            Node::Product(factors) => factors.iter().all(|(_, e)| e.is_integer() && e.numer() % 2 == 0),
            _ => false,
        }
    }

    /// True if one of `roots` contains a user-supplied function.
    pub fn has_external(&self, roots: &[Id]) -> bool {
        self.reachable(roots).iter().any(|id| matches!(self.node(*id), Node::External(_)))
    }

    /// Free variables of `roots`, each once.
    pub fn symbols(&self, roots: &[Id]) -> impl Iterator<Item = Symbol> {
        self.reachable(roots).into_iter().filter_map(|id| match self.node(id) {
            Node::Symbol(symbol) => Some(*symbol),
            _ => None,
        })
    }
}
