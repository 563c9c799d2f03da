//! Derivatives on the graph: forward mode along a direction, reverse mode for gradients (Griewank and Walther,
//! *Evaluating Derivatives*, chapter 3).

use num_traits::One;
use rustc_hash::FxHashMap;

use super::graph::{External, Fault, Function, Graph, Id, Node, Symbol};
use super::rational::{Rational, plus};

/// Derivative along one direction in the space of symbols. The rates of all visited nodes are cached, so that one
/// value serves all roots.
#[derive(Debug)]
pub struct Forward {
    seeds: FxHashMap<Symbol, Id>,
    known: Vec<Option<Id>>,
    keeps_sums: bool,
}

/// Most arguments of a supplied function whose derivatives along a direction are written out as sums of partial
/// derivatives. The Jacobian of a longer function has more than a thousand entries, which take rustc seconds.
pub const MOST_PARTIALS: usize = 32;

impl Forward {
    /// Direction in which the given symbols change at the given rates, and all others are constant.
    pub fn along(seeds: impl IntoIterator<Item = (Symbol, Id)>) -> Self {
        Self { seeds: seeds.into_iter().collect(), known: Vec::new(), keeps_sums: false }
    }

    /// Leaves the derivative of a supplied function of more than [`MOST_PARTIALS`] arguments a single node.
    pub fn keeping_sums(self) -> Self {
        Self { keeps_sums: true, ..self }
    }

    /// Adds the rates of symbols that no node contained so far.
    pub fn also(&mut self, seeds: impl IntoIterator<Item = (Symbol, Id)>) {
        self.seeds.extend(seeds);
    }

    /// Sets the rates of some nodes, regardless of their operands.
    pub fn through(mut self, graph: &Graph, rates: impl IntoIterator<Item = (Id, Id)>) -> Self {
        self.known.resize(graph.len(), None);
        for (node, rate) in rates {
            self.known[node.index()] = Some(rate);
        }
        self
    }

    /// Derivative of `root` along the direction.
    pub fn of(&mut self, graph: &mut Graph, root: Id) -> Id {
        self.known.resize(graph.len(), None);
        let mut pending = vec![root];
        while let Some(&id) = pending.last() {
            if self.known[id.index()].is_some() {
                pending.pop();
                continue;
            }
            let before = pending.len();
            graph.operands(id, |operand| {
                if self.known[operand.index()].is_none() {
                    pending.push(operand);
                }
            });
            if pending.len() == before {
                self.known[id.index()] = Some(self.step(graph, id));
                pending.pop();
            }
        }
        self.known[root.index()].unwrap_or(Id::ZERO)
    }

    fn rate(&self, id: Id) -> Id {
        self.known[id.index()].unwrap_or(Id::ZERO)
    }

    /// Rate of a node, from the known rates of its operands.
    fn step(&self, graph: &mut Graph, id: Id) -> Id {
        match graph.node(id) {
            Node::Number(_) | Node::Pi => Id::ZERO,
            Node::Symbol(symbol) => self.seeds.get(symbol).copied().unwrap_or(Id::ZERO),
            Node::Sum(terms) => {
                let rates: Vec<_> = terms.iter().map(|&(term, c)| (self.rate(term), c)).collect();
                graph.sum(rates)
            }
            Node::Defined(inner) => graph.defined(self.rate(*inner)),
            Node::External(external) if self.keeps_sums && external.arguments.len() > MOST_PARTIALS => {
                let direction = external.arguments.iter().map(|&x| self.rate(x)).collect();
                let external = (**external).clone();
                graph.along(external, direction)
            }
            _ => self.chain_rule(graph, id),
        }
    }

    /// Σ ∂/∂operand · rate of operand
    fn chain_rule(&self, graph: &mut Graph, id: Id) -> Id {
        let mut operands = graph.distinct_operands(id);
        operands.retain(|&operand| self.rate(operand) != Id::ZERO);
        let terms: Vec<Id> =
            operands.into_iter().map(|operand| graph.partial(id, operand, self.rate(operand))).collect();
        graph.total(terms)
    }
}

impl Graph {
    /// ∂`root`/∂symbol for each of `symbols`, in one sweep from the root down.
    pub fn gradient(&mut self, root: Id, symbols: &[Symbol]) -> Vec<Id> {
        let variables: Vec<Id> = symbols.iter().map(|&symbol| self.symbol(symbol)).collect();
        self.gradient_to(root, &variables)
    }

    /// Gradient with respect to nodes of any kind: each is an independent variable, regardless of its operands.
    pub fn gradient_to(&mut self, root: Id, variables: &[Id]) -> Vec<Id> {
        self.pulled_back(&[(Id::ONE, root)], variables)
    }

    /// Σ weight · ∂root/∂variable, for pairs (weight, root). The weights are not differentiated.
    pub fn pulled_back(&mut self, roots: &[(Id, Id)], variables: &[Id]) -> Vec<Id> {
        let mut found: FxHashMap<Id, Id> = variables.iter().map(|&variable| (variable, Id::ZERO)).collect();
        let mut adjoints: FxHashMap<Id, Vec<(Id, Rational)>> = FxHashMap::default();
        for &(weight, root) in roots {
            adjoints.entry(root).or_default().push((weight, Rational::one()));
        }
        let roots: Vec<Id> = roots.iter().map(|(_, root)| *root).collect();
        for id in self.reachable_to(&roots, variables).into_iter().rev() {
            let Some(parts) = adjoints.remove(&id) else { continue };
            let adjoint = self.sum(parts);
            match found.get_mut(&id) {
                Some(slope) => *slope = adjoint,
                None if adjoint == Id::ZERO => {}
                None => self.pass_down(id, adjoint, &mut adjoints),
            }
        }
        variables.iter().map(|variable| found[variable]).collect()
    }

    fn pass_down(&mut self, id: Id, adjoint: Id, adjoints: &mut FxHashMap<Id, Vec<(Id, Rational)>>) {
        match self.node(id) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => {}
            Node::Sum(terms) => {
                for &(term, coefficient) in terms {
                    adjoints.entry(term).or_default().push((adjoint, coefficient));
                }
            }
            // The adjoint of a definition becomes a definition, too: it is a partial sum, like the forces on the links
            // of a chain.
            &Node::Defined(inner) => {
                let adjoint = self.defined(adjoint);
                adjoints.entry(inner).or_default().push((adjoint, Rational::one()));
            }
            _ => {
                for operand in self.distinct_operands(id) {
                    let part = self.partial(id, operand, adjoint);
                    adjoints.entry(operand).or_default().push((part, Rational::one()));
                }
            }
        }
    }

    /// Distinct nonconstant operands of a product, a power or a function: one for xˣ.
    pub(super) fn distinct_operands(&self, id: Id) -> Vec<Id> {
        let mut operands = Vec::new();
        self.operands(id, |operand| operands.push(operand));
        operands.retain(|&operand| self.as_number(operand).is_none());
        operands.sort_unstable();
        operands.dedup();
        operands
    }

    /// `weight` · ∂`id`/∂`operand`, for a product, a power or a function.
    pub(super) fn partial(&mut self, id: Id, operand: Id, weight: Id) -> Id {
        match *self.node(id) {
            Node::Product(_) => self.factor_partial(id, operand, weight),
            Node::Function(function, x) => {
                let slope = self.slope(function, x, id);
                self.mul(weight, slope)
            }
            Node::Atan2(y, x) => self.angle_partial(y, x, operand, weight),
            Node::Power(base, exponent) => self.power_partial(id, base, exponent, operand, weight),
            Node::External(_) => self.external_partial(id, operand, weight),
            _ => weight,
        }
    }

    /// d(xᵉ …) = e xᵉ⁻¹ … dx. The form e (xᵉ …)/x would be undefined at x = 0.
    fn factor_partial(&mut self, id: Id, operand: Id, weight: Id) -> Id {
        let Node::Product(factors) = self.node(id) else { return weight };
        let mut factors = factors.to_vec();
        let mut slope = Rational::one();
        if let Some((_, exponent)) = factors.iter_mut().find(|(factor, _)| *factor == operand) {
            slope = *exponent;
            match plus(slope, -Rational::one()) {
                Some(lower) => *exponent = lower,
                None => return self.fail(Fault::Overflow),
            }
        }
        factors.push((weight, Rational::one()));
        let part = self.product(factors);
        self.sum([(part, slope)])
    }

    /// Derivative of a supplied function along a direction.
    fn along(&mut self, external: External, direction: Vec<Id>) -> Id {
        if direction.iter().all(|&rate| rate == Id::ZERO) {
            return Id::ZERO;
        }
        let arguments = [&external.arguments[..], &direction].concat().into();
        self.external(External { arguments, is_along: true, ..external })
    }

    /// Σ ∂f/∂x_i over all positions i of the operand among the arguments. A derivative along v is linear in v.
    fn external_partial(&mut self, id: Id, operand: Id, weight: Id) -> Id {
        let Node::External(external) = self.node(id).clone() else { return weight };
        let inputs = external.inputs();
        let mut slope = Id::ZERO;
        for (position, _) in external.arguments.iter().enumerate().filter(|&(_, &x)| x == operand) {
            let is_argument = position < inputs;
            let derivatives = [&external.derivatives[..], &[(position % inputs) as u32]].concat().into();
            let kept = if is_argument { external.arguments.len() } else { inputs };
            let part = self.external(External {
                derivatives,
                arguments: external.arguments[..kept].into(),
                is_along: external.is_along && is_argument,
                ..*external
            });
            slope = self.add(slope, part);
        }
        self.mul(weight, slope)
    }

    /// d atan2(y, x) = (x dy − y dx) / (x² + y²).
    fn angle_partial(&mut self, y: Id, x: Id, operand: Id, weight: Id) -> Id {
        let one = Rational::one();
        let (x2, y2) = (self.square(x), self.square(y));
        let radius2 = self.add(x2, y2);
        let mut arm = Id::ZERO;
        if operand == y {
            arm = self.add(arm, x);
        }
        if operand == x {
            arm = self.sub(arm, y);
        }
        self.product([(weight, one), (arm, one), (radius2, -one)])
    }

    /// d bᵉ = e bᵉ⁻¹ db + bᵉ ln b de. The form e bᵉ/b would be undefined at b = 0.
    fn power_partial(&mut self, id: Id, base: Id, exponent: Id, operand: Id, weight: Id) -> Id {
        let mut slope = Id::ZERO;
        if operand == base {
            let lower = self.sub(exponent, Id::ONE);
            let power = self.power(base, lower);
            slope = self.mul(exponent, power);
        }
        if operand == exponent {
            let logarithm = self.function(Function::Ln, base);
            let part = self.mul(id, logarithm);
            slope = self.add(slope, part);
        }
        self.mul(weight, slope)
    }

    /// Derivative of `function` at `x`, where `id` is the node `function(x)`.
    fn slope(&mut self, function: Function, x: Id, id: Id) -> Id {
        let one = Rational::one();
        let half = Rational::new_raw(1, 2);
        match function {
            Function::Sin => self.function(Function::Cos, x),
            Function::Cos => {
                let sine = self.function(Function::Sin, x);
                self.neg(sine)
            }
            Function::Tan => self.one_and_square(one, id),
            Function::Tanh => self.one_and_square(-one, id),
            Function::Asin | Function::Acos => {
                let rest = self.one_and_square(-one, x);
                let slope = self.pow(rest, -half);
                if function == Function::Acos { self.neg(slope) } else { slope }
            }
            Function::Atan => {
                let rest = self.one_and_square(one, x);
                self.pow(rest, -one)
            }
            Function::Sinh => self.function(Function::Cosh, x),
            Function::Cosh => self.function(Function::Sinh, x),
            Function::Exp => id,
            Function::Ln => self.pow(x, -one),
            Function::Abs => self.div(x, id),
            Function::Ramp => self.function(Function::Step, x),
            Function::Step => Id::ZERO,
        }
    }

    /// 1 + coefficient · x²
    fn one_and_square(&mut self, coefficient: Rational, x: Id) -> Id {
        let square = self.square(x);
        self.sum([(Id::ONE, Rational::one()), (square, coefficient)])
    }
}
