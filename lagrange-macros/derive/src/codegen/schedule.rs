//! Converts the graph to a sequence of binary operations, without common subexpressions.

use indexmap::IndexSet;
use num_traits::{One, Signed, ToPrimitive};
use rustc_hash::FxHashMap;

use super::count::Count;
use super::operation::{Call, CallKind, Operation, Register};
use crate::symbolic::{Function, Graph, Id, Node, Rational, Scaled, to_f64};

/// Result of folding an operation: an existing register, or a simpler operation.
enum Folded {
    To(Register),
    Into(Operation),
}

/// Operations in the order of evaluation.
#[derive(Clone, Default)]
pub(super) struct Schedule {
    pub(super) operations: Vec<Operation>,
    pub(super) calls: IndexSet<Call>,
    known: FxHashMap<Operation, Register>,
    registers: FxHashMap<Id, Register>,
    /// Registers of named definitions. The emitted locals have these names.
    pub(super) definitions: Vec<(Register, Id)>,
}

impl Schedule {
    /// Schedules the operations that `roots` depend on.
    pub(super) fn new(graph: &Graph, roots: &[Id]) -> Self {
        let mut schedule = Self::default();
        for id in graph.reachable(roots) {
            if schedule.is_needed_whole(graph, id, roots) {
                let register = schedule.node(graph, id);
                schedule.registers.insert(id, register);
            }
        }
        schedule
    }

    /// False for numbers that are not roots. They become registers only where they are used, since many only scale a
    /// term or are an exponent.
    fn is_needed_whole(&self, graph: &Graph, id: Id, roots: &[Id]) -> bool {
        graph.as_number(id).is_none() || roots.contains(&id)
    }

    /// Returns the operands, including the arguments of a call.
    pub(super) fn operands(&self, operation: Operation) -> impl Iterator<Item = Register> {
        let call = match operation {
            Operation::Result { call, .. } => Some(&self.calls[call as usize]),
            _ => None,
        };
        operation.operands().chain(call.into_iter().flat_map(|call| call.arguments.iter().copied()))
    }

    pub(super) fn register(&self, root: Id) -> Register {
        self.registers[&root]
    }

    /// Returns how often each result is used; zero for operations that do not contribute to the roots.
    pub(super) fn uses(&self, roots: &[Register]) -> Vec<usize> {
        let mut uses = vec![0; self.operations.len()];
        for &root in roots {
            uses[root.index()] += 1;
        }
        for (index, operation) in self.operations.iter().enumerate().rev() {
            if uses[index] > 0 {
                self.operands(*operation).for_each(|operand| uses[operand.index()] += 1);
            }
        }
        uses
    }

    pub(super) fn count(&self, roots: &[Register]) -> Count {
        let uses = self.uses(roots);
        let mut count = Count::default();
        for (operation, _) in self.operations.iter().zip(uses).filter(|(_, uses)| *uses > 0) {
            match operation {
                Operation::Constant(_) | Operation::Input(_) => {}
                Operation::Function(Function::Abs | Function::Ramp | Function::Step, _) => {
                    count.arithmetic += 1;
                }
                Operation::Function(..) | Operation::Atan2(..) | Operation::Power(..) => count.functions += 1,
                Operation::Result { .. } => count.calls += 1,
                Operation::MultiplyAdd(..) | Operation::SubtractProduct(..) => count.arithmetic += 2,
                _ => count.arithmetic += 1,
            }
        }
        count
    }

    /// Returns the register of an operation if the schedule contains it.
    pub(super) fn find(&self, operation: Operation) -> Option<Register> {
        self.known.get(&operation).copied()
    }

    pub(super) fn push(&mut self, operation: Operation) -> Register {
        let operation = match self.folded(operation) {
            Folded::To(register) => return register,
            Folded::Into(operation) => operation.canonical(),
        };
        let next = Register::at(self.operations.len());
        let register = *self.known.entry(operation).or_insert(next);
        if register == next {
            self.operations.push(operation);
        }
        register
    }

    /// Folds operations on constants, and factors of 1. Keeps 0 x, which is NaN if x is infinite or NaN.
    fn folded(&self, operation: Operation) -> Folded {
        let value = |register: Register| match self.operations[register.index()] {
            Operation::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        };
        // Infinity and NaN have no literal.
        let constant = |value: f64| match value.is_finite() {
            true => Folded::Into(Operation::Constant(value.to_bits())),
            false => Folded::Into(operation),
        };
        let values = operation.operands().map(value).collect::<Vec<_>>();
        match (operation, &values[..]) {
            (Operation::Negate(_), [Some(x)]) => constant(-x),
            (Operation::SquareRoot(_), [Some(x)]) => constant(x.sqrt()),
            (Operation::Add(..), [Some(x), Some(y)]) => constant(x + y),
            (Operation::Subtract(..), [Some(x), Some(y)]) => constant(x - y),
            (Operation::Multiply(..), [Some(x), Some(y)]) => constant(x * y),
            (Operation::Divide(..), [Some(x), Some(y)]) => constant(x / y),
            (Operation::Multiply(x, _) | Operation::Divide(x, _), [_, Some(1.0)]) => Folded::To(x),
            (Operation::Multiply(_, y), [Some(1.0), _]) => Folded::To(y),
            _ => Folded::Into(operation),
        }
    }

    pub(super) fn is_constant(&self, register: Register) -> bool {
        matches!(self.operations[register.index()], Operation::Constant(_))
    }

    pub(super) fn constant(&mut self, value: f64) -> Register {
        self.push(Operation::Constant(value.to_bits()))
    }

    fn number(&mut self, value: Rational) -> Register {
        self.constant(to_f64(value))
    }

    fn node(&mut self, graph: &Graph, id: Id) -> Register {
        match graph.node(id) {
            Node::Number(value) => self.number(*value),
            Node::Pi => self.constant(std::f64::consts::PI),
            Node::Symbol(symbol) => self.push(Operation::Input(*symbol)),
            Node::Sum(terms) => self.sum(graph, terms),
            Node::Product(factors) => self.product(graph, factors, Rational::one()),
            Node::Function(function, x) => {
                let x = self.register_of(graph, *x);
                self.push(Operation::Function(*function, x))
            }
            Node::Atan2(y, x) => {
                let (y, x) = (self.register_of(graph, *y), self.register_of(graph, *x));
                self.push(Operation::Atan2(y, x))
            }
            Node::Power(base, exponent) => {
                let (base, exponent) = (self.register_of(graph, *base), self.register_of(graph, *exponent));
                self.push(Operation::Power(base, exponent))
            }
            Node::External(external) => {
                let arguments = external.arguments.iter().map(|&x| self.register_of(graph, x)).collect();
                let (function, derivatives) = (external.function, external.derivatives.clone());
                let kind = if external.is_along { CallKind::Along } else { CallKind::Partial };
                let (call, _) = self.calls.insert_full(Call { function, derivatives, arguments, kind });
                self.push(Operation::Result { call: call as u32, output: external.output })
            }
            Node::Defined(inner) => {
                let register = self.register_of(graph, *inner);
                self.definitions.push((register, id));
                register
            }
        }
    }

    fn register_of(&mut self, graph: &Graph, id: Id) -> Register {
        match graph.as_number(id) {
            Some(value) => self.number(value),
            None => self.registers[&id],
        }
    }

    /// Sum with coefficients. Equal coefficients are factored out; otherwise each term is scaled.
    fn sum(&mut self, graph: &Graph, terms: &[(Id, Rational)]) -> Register {
        let scale = terms[0].1.abs();
        let alike = !scale.is_one() && terms.len() > 1 && terms.iter().all(|(_, c)| c.abs() == scale);
        let inner = if alike { scale } else { Rational::one() };
        // Start with a positive term to avoid a negation.
        let first = terms.iter().position(|(_, c)| c.is_positive());
        let mut total =
            self.term(graph, terms[first.unwrap_or(0)].0, terms[first.unwrap_or(0)].1.abs() / inner);
        for (position, &(term, c)) in terms.iter().enumerate() {
            if position == first.unwrap_or(0) {
                continue;
            }
            let part = self.term(graph, term, c.abs() / inner);
            let subtract = c.is_negative() && first.is_some();
            total = self.push(if subtract {
                Operation::Subtract(total, part)
            } else {
                Operation::Add(total, part)
            });
        }
        if alike {
            let scale = self.number(scale);
            total = self.push(Operation::Multiply(scale, total));
        }
        if first.is_none() { self.push(Operation::Negate(total)) } else { total }
    }

    /// coefficient · term, for a positive coefficient
    fn term(&mut self, graph: &Graph, term: Id, coefficient: Rational) -> Register {
        if term == Id::ONE {
            return self.number(coefficient);
        }
        if coefficient.is_one() {
            return self.register_of(graph, term);
        }
        if let Node::Product(factors) = graph.node(term)
            && (factors.iter().all(|(_, exponent)| exponent.is_negative())
                || graph.power_of_ten(factors) != 0)
        {
            return self.product(graph, factors, coefficient);
        }
        let x = self.register_of(graph, term);
        let coefficient = self.number(coefficient);
        self.push(Operation::Multiply(coefficient, x))
    }

    /// Quotient of the factors with positive and negative exponents; `scale` multiplies the numerator.
    fn product(&mut self, graph: &Graph, factors: &[(Id, Rational)], scale: Rational) -> Register {
        let scale = Scaled { fraction: scale, exponent: graph.power_of_ten(factors) };
        let factors = factors.iter().filter(|factor| !graph.is_power_of_ten(**factor));
        let is_one = scale == Rational::one().into();
        let mut numerator = (!is_one).then(|| self.constant(scale.to_f64()));
        let mut denominator = None;
        for &(factor, exponent) in factors {
            let base = self.register_of(graph, factor);
            let part = self.power(base, exponent.abs());
            let side = if exponent.is_negative() { &mut denominator } else { &mut numerator };
            *side = Some(match *side {
                Some(product) => self.push(Operation::Multiply(product, part)),
                None => part,
            });
        }
        match (numerator, denominator) {
            (Some(numerator), None) => numerator,
            (Some(numerator), Some(denominator)) => self.push(Operation::Divide(numerator, denominator)),
            (None, Some(denominator)) => {
                let one = self.constant(1.0);
                self.push(Operation::Divide(one, denominator))
            }
            (None, None) => self.constant(1.0),
        }
    }

    /// Positive power, by repeated squaring if the exponent is a small integer or half-integer.
    fn power(&mut self, base: Register, exponent: Rational) -> Register {
        let (numerator, denominator) = (exponent.numer().to_u32(), *exponent.denom());
        match (numerator, denominator) {
            (Some(n @ 1..=1024), 1) => self.whole_power(base, n),
            (Some(n @ 1..=1023), 2) => {
                let root = self.push(Operation::SquareRoot(base));
                if n == 1 {
                    return root;
                }
                let whole = self.whole_power(base, n / 2);
                self.push(Operation::Multiply(whole, root))
            }
            _ => {
                let exponent = self.number(exponent);
                self.push(Operation::Power(base, exponent))
            }
        }
    }

    fn whole_power(&mut self, base: Register, exponent: u32) -> Register {
        if exponent == 1 {
            return base;
        }
        let half = self.whole_power(base, exponent / 2);
        let square = self.push(Operation::Multiply(half, half));
        if exponent % 2 == 1 { self.push(Operation::Multiply(square, base)) } else { square }
    }
}
