//! The expression graph: equal expressions are one node.

use indexmap::IndexSet;
use num_traits::{One, Zero};
use rustc_hash::FxBuildHasher;

use super::rational::{self, Rational};
use super::rounded::Roundings;
use super::scaled::Scaled;

/// A node of one [`Graph`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(crate) struct Id(pub(super) u32);

impl Id {
    /// The number 0.
    pub(crate) const ZERO: Self = Self(0);
    /// The number 1.
    pub(crate) const ONE: Self = Self(1);

    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// A free variable. What `family` and `index` stand for is the caller's business.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(crate) struct Symbol {
    pub(crate) family: u8,
    pub(crate) index: u32,
}

/// Functions of one argument. Powers and roots are factors of a product instead.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(crate) enum Function {
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
    /// The larger of the argument and 0, which `max` and `min` are made of.
    Ramp,
    /// Its slope: 0 below zero, 1 above it.
    Step,
}

impl Function {
    /// Every function with the name it has in expressions, in formulas and in emitted code; the last two are in no expression.
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

    /// Those that expressions may call.
    pub(crate) fn callable() -> impl Iterator<Item = (&'static str, Self)> {
        Self::NAMES.into_iter().filter(|(_, function)| !matches!(function, Self::Ramp | Self::Step))
    }

    pub(crate) fn name(self) -> &'static str {
        Self::NAMES[self as usize].0
    }

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::callable().find(|(known, _)| *known == name).map(|(_, function)| function)
    }
}

/// One expression over earlier ones.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Node {
    Number(Rational),
    Pi,
    Symbol(Symbol),
    /// Σ coefficient · term, sorted by term, no term twice; a constant is a multiple of [`Id::ONE`].
    Sum(Box<[(Id, Rational)]>),
    /// Π factor ^ exponent, sorted by factor, no factor twice; never a number but for its roots and for a power of 10
    /// that with the coefficient before it does not fit into 128 bits.
    Product(Box<[(Id, Rational)]>),
    Function(Function, Id),
    /// The angle of the point (second, first).
    Atan2(Id, Id),
    /// A power whose exponent is not a number.
    Power(Id, Id),
    /// A named intermediate: equal to what it holds, but nothing is collected or flattened through it, so
    /// that recursive definitions keep their partial sums.
    Defined(Id),
    /// A function of which nothing is known here, or a partial derivative of it.
    External(Box<External>),
}

/// ∂^k f_o(x₀, x₁, …)/∂x_i ∂x_j … for the function `function` and its result `output`.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(crate) struct External {
    pub(crate) function: u32,
    pub(crate) output: u32,
    /// The positions i ≤ j ≤ … of the arguments differentiated by.
    pub(crate) derivatives: Box<[u32]>,
    pub(crate) arguments: Box<[Id]>,
}

/// What exact arithmetic could not do. The first one stays until it is [taken](Graph::take_fault).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Fault {
    /// A number beyond the range of `f64`, or an exponent of too many digits.
    Overflow,
    /// Division by what is identically zero.
    DivisionByZero,
    /// More than [`Graph::LIMIT`] nodes.
    TooLarge,
}

/// An arena of expressions.
#[derive(Debug)]
pub(crate) struct Graph {
    nodes: IndexSet<Node, FxBuildHasher>,
    /// The number 10, once a power of it stands in a product.
    pub(super) ten: Option<Id>,
    /// Rounding errors of constants with more digits than an exact fraction holds.
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
    /// The number of nodes past which expressions are taken for runaway definitions.
    pub(crate) const LIMIT: usize = 1 << 20;

    pub(crate) fn node(&self, id: Id) -> &Node {
        &self.nodes[id.index()]
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    pub(crate) fn number(&mut self, value: Rational) -> Id {
        if rational::fits(&value) { self.intern(Node::Number(value)) } else { self.fail(Fault::Overflow) }
    }

    pub(crate) fn integer(&mut self, value: i128) -> Id {
        self.number(Rational::from_integer(value))
    }

    pub(crate) fn symbol(&mut self, symbol: Symbol) -> Id {
        self.intern(Node::Symbol(symbol))
    }

    pub(crate) fn pi(&mut self) -> Id {
        self.intern(Node::Pi)
    }

    /// The value of a node that is a number of any size.
    pub(crate) fn as_scaled(&self, id: Id) -> Option<Scaled> {
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

    /// The exponent of 10 in a product.
    pub(crate) fn power_of_ten(&self, factors: &[(Id, Rational)]) -> i32 {
        let ten = factors.iter().find(|factor| self.is_power_of_ten(**factor));
        ten.and_then(|(_, exponent)| i32::try_from(exponent.to_integer()).ok()).unwrap_or(0)
    }

    /// Whether a factor is 10 to a whole power.
    pub(crate) fn is_power_of_ten(&self, (factor, exponent): (Id, Rational)) -> bool {
        Some(factor) == self.ten && exponent.is_integer()
    }

    /// The value of a node that is a number.
    pub(crate) fn as_number(&self, id: Id) -> Option<Rational> {
        match self.node(id) {
            Node::Number(value) => Some(*value),
            _ => None,
        }
    }

    /// A boundary around `inner`; what has no parts needs none.
    pub(crate) fn defined(&mut self, inner: Id) -> Id {
        match self.node(inner) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Defined(_) => inner,
            _ if self.as_scaled(inner).is_some() => inner,
            _ => self.intern(Node::Defined(inner)),
        }
    }

    pub(crate) fn take_fault(&mut self) -> Option<Fault> {
        self.fault.take()
    }

    /// Notes a fault; the value that stands in for the result is never used.
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
    pub(crate) fn operands(&self, id: Id, mut visit: impl FnMut(Id)) {
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

    /// What is multiplied in `id`, without numbers and exponents.
    pub(crate) fn factors(&self, id: Id) -> Vec<Id> {
        match self.node(id) {
            Node::Number(_) => Vec::new(),
            Node::Sum(terms) if terms.len() == 1 => self.factors(terms[0].0),
            Node::Product(factors) => factors.iter().map(|&(factor, _)| factor).collect(),
            _ => vec![id],
        }
    }

    /// Every node, operands before what uses them.
    pub(crate) fn ids(&self) -> impl Iterator<Item = Id> + use<> {
        (0..self.len() as u32).map(Id)
    }

    /// All nodes that `roots` are made of, operands before what uses them.
    pub(crate) fn reachable(&self, roots: &[Id]) -> Vec<Id> {
        self.reachable_to(roots, &[])
    }

    /// The same down to `leaves`, whatever those are made of.
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

    /// The first argument of [`Function::Ramp`] in `root`, also where its slope alone is there.
    pub(crate) fn kink(&self, root: Id) -> Option<Id> {
        self.reachable(&[root]).into_iter().find_map(|id| match self.node(id) {
            Node::Function(Function::Ramp | Function::Step, argument) => Some(*argument),
            _ => None,
        })
    }

    /// Whether a function of which nothing is known is in one of `roots`.
    pub(crate) fn has_external(&self, roots: &[Id]) -> bool {
        self.reachable(roots).iter().any(|id| matches!(self.node(*id), Node::External(_)))
    }

    /// The free variables of `root`, each once.
    pub(crate) fn symbols(&self, roots: &[Id]) -> impl Iterator<Item = Symbol> {
        self.reachable(roots).into_iter().filter_map(|id| match self.node(id) {
            Node::Symbol(symbol) => Some(*symbol),
            _ => None,
        })
    }
}
