//! A formula as it is to be read: names, fractions, powers. It comes from what the user wrote or from the
//! graph, and goes to a [`Notation`](super::notation::Notation).

use num_traits::{One, Signed};

use super::supplied;
use crate::resolve::{Element, Problem};
use crate::symbolic::{Graph, Id, Node, Rational};
use crate::syntax::{Expression, Kind, Operator, Sign};
use crate::variables::Variable;

#[derive(Clone, PartialEq, Debug)]
pub(super) enum Formula {
    Number(Rational),
    Pi,
    /// A name with dots above it and indices behind it.
    Name {
        base: String,
        dots: usize,
        indices: Vec<Self>,
    },
    /// An entry of what is no name.
    Entry(Box<Self>, Box<Self>),
    /// An index that runs from the first to before the last.
    Running {
        index: String,
        from: Box<Self>,
        to: Box<Self>,
    },
    /// λ with the constraint's name.
    Multiplier(String),
    Negative(Box<Self>),
    Sum(Vec<Self>),
    /// Numerators over denominators.
    Product(Vec<Self>, Vec<Self>),
    Power(Box<Self>, Box<Self>),
    Root(Box<Self>),
    Call(String, Vec<Self>),
    /// Σ over an index.
    SumOver {
        index: String,
        from: Box<Self>,
        to: Box<Self>,
        body: Box<Self>,
    },
    Vector(Vec<Self>),
    /// A derivative of a function of one argument, and where it is taken.
    Derivative {
        function: Box<Self>,
        order: usize,
        argument: Box<Self>,
    },
    /// A partial derivative, and where it is taken unless that is clear.
    Partial {
        function: Box<Self>,
        by: Vec<Self>,
        arguments: Vec<Self>,
    },
}

impl Formula {
    /// `r_dot[2]`, given the flat name of a coordinate and the number of dots.
    pub(super) fn labelled(text: &str, dots: usize) -> Self {
        let mut parts = text.split('[');
        let base = parts.next().unwrap_or_default().to_owned();
        let indices = parts.map(|part| Self::index(part.trim_end_matches(']'))).collect();
        Self::Name { base, dots, indices }
    }

    fn index(text: &str) -> Self {
        match text.parse::<i128>() {
            Ok(number) => Self::Number(Rational::from_integer(number)),
            Err(_) => Self::Name { base: text.to_owned(), dots: 0, indices: Vec::new() },
        }
    }

    /// The sum of the parts, as one list of terms.
    pub(super) fn sum(parts: Vec<Self>) -> Self {
        let mut terms: Vec<Self> = Vec::new();
        for part in parts {
            match part {
                Self::Sum(inner) => terms.extend(inner),
                part => terms.push(part),
            }
        }
        match terms.len() {
            0 => Self::Number(Rational::from_integer(0)),
            1 => terms.remove(0),
            _ => Self::Sum(terms),
        }
    }

    /// Whether a minus sign stands in front of it.
    pub(super) fn is_negative(&self) -> bool {
        match self {
            Self::Number(value) => value.is_negative(),
            Self::Negative(_) => true,
            _ => false,
        }
    }

    /// Whether it is subtracted, and what.
    pub(super) fn sign_and_magnitude(&self) -> (bool, Self) {
        if self.is_negative() { (true, self.clone().negated()) } else { (false, self.clone()) }
    }

    fn negated(self) -> Self {
        match self {
            Self::Negative(inner) => *inner,
            Self::Number(value) => Self::Number(-value),
            other => Self::Negative(Box::new(other)),
        }
    }
}

/// What the user wrote, as a formula.
pub(super) fn written(expression: &Expression, problem: &Problem) -> Formula {
    let inner = |part: &Expression| written(part, problem);
    match &expression.kind {
        Kind::Number(value) => Formula::Number(*value),
        Kind::Name(name) if name.text == "pi" => Formula::Pi,
        Kind::Name(name) => named(&name.text, problem),
        Kind::Index(base, index) => indexed(inner(base), index, problem),
        Kind::Call(name, arguments) => call(&name.text, arguments.iter().map(inner).collect()),
        Kind::SumOver(sum) => Formula::SumOver {
            index: sum.index.text.clone(),
            from: Box::new(inner(&sum.from)),
            to: Box::new(inner(&sum.to)),
            body: Box::new(inner(&sum.body)),
        },
        Kind::Negative(part) => inner(part).negated(),
        Kind::Sum(terms) => Formula::Sum(
            terms
                .iter()
                .map(|(sign, term)| if *sign == Sign::Minus { inner(term).negated() } else { inner(term) })
                .collect(),
        ),
        Kind::Product(factors) => written_product(factors, problem),
        Kind::Power(base, exponent) => Formula::Power(Box::new(inner(base)), Box::new(inner(exponent))),
        Kind::Vector(items) => Formula::Vector(items.iter().map(inner).collect()),
    }
}

/// A leading `m/2` is read as ½ m: numbers gather in front.
fn written_product(factors: &[(Operator, Expression)], problem: &Problem) -> Formula {
    let (mut above, mut below, mut number) = (Vec::new(), Vec::new(), Rational::one());
    for (operator, factor) in factors {
        match (&factor.kind, operator) {
            (Kind::Number(value), Operator::Times) => number *= value,
            (Kind::Number(value), Operator::Over) if !num_traits::Zero::is_zero(value) => number /= value,
            (_, operator) => {
                let (is_negative, magnitude) = written(factor, problem).sign_and_magnitude();
                number = if is_negative { -number } else { number };
                if *operator == Operator::Times { above.push(magnitude) } else { below.push(magnitude) }
            }
        }
    }
    product(number, above, below)
}

fn product(number: Rational, mut above: Vec<Formula>, below: Vec<Formula>) -> Formula {
    let magnitude = number.abs();
    if !magnitude.is_one() || above.is_empty() {
        above.insert(0, Formula::Number(magnitude));
    }
    let formula = match (above.len(), below.is_empty()) {
        (1, true) => above.remove(0),
        _ => Formula::Product(above, below),
    };
    if number.is_negative() { formula.negated() } else { formula }
}

fn indexed(base: Formula, index: &Expression, problem: &Problem) -> Formula {
    let index = written(index, problem);
    match base {
        Formula::Name { base, dots, mut indices } => {
            indices.push(index);
            Formula::Name { base, dots, indices }
        }
        other => Formula::Entry(Box::new(other), Box::new(index)),
    }
}

/// `x_dot` is x with a dot if x is a coordinate.
fn named(text: &str, problem: &Problem) -> Formula {
    let is_coordinate = |name: &str| {
        problem
            .coordinates
            .iter()
            .any(|label| label.text == name || label.text.starts_with(&format!("{name}[")))
    };
    for (suffix, combining, dots) in [("_dot", '\u{307}', 1), ("_ddot", '\u{308}', 2)] {
        let dotted = |base: &str| crate::syntax::normal_form(&format!("{base}{combining}")) == text;
        let base =
            text.strip_suffix(suffix).filter(|base| is_coordinate(base)).map(str::to_owned).or_else(|| {
                problem.coordinates.iter().map(|label| label.text.clone()).find(|base| dotted(base))
            });
        if let Some(base) = base {
            return Formula::Name { base, dots, indices: Vec::new() };
        }
    }
    Formula::Name { base: text.to_owned(), dots: 0, indices: Vec::new() }
}

fn call(name: &str, mut arguments: Vec<Formula>) -> Formula {
    match (name, arguments.len()) {
        ("sqrt", 1) => Formula::Root(Box::new(arguments.remove(0))),
        _ => Formula::Call(name.to_owned(), arguments),
    }
}

/// A node of the graph, as a formula. Definitions appear by name.
pub(super) fn derived(id: Id, graph: &Graph, problem: &Problem) -> Formula {
    match graph.node(id) {
        Node::Number(value) => Formula::Number(value.abs()).signed(value.is_negative()),
        Node::Pi => Formula::Pi,
        Node::Symbol(symbol) => variable(Variable::of(*symbol), problem),
        Node::Sum(terms) => {
            let mut terms: Vec<_> =
                terms.iter().map(|&(term, c)| derived_term(term, c, graph, problem)).collect();
            terms.sort_by_key(Formula::is_negative);
            if terms.len() == 1 { terms.remove(0) } else { Formula::Sum(terms) }
        }
        Node::Product(_) => derived_term(id, Rational::one(), graph, problem),
        Node::Function(function, x) => {
            Formula::Call(function.name().to_owned(), vec![derived(*x, graph, problem)])
        }
        Node::External(external) => supplied::call(external, graph, problem),
        Node::Atan2(y, x) => {
            Formula::Call("atan2".to_owned(), vec![derived(*y, graph, problem), derived(*x, graph, problem)])
        }
        Node::Power(base, exponent) => Formula::Power(
            Box::new(derived(*base, graph, problem)),
            Box::new(derived(*exponent, graph, problem)),
        ),
        Node::Defined(inner) => match problem.names.get(&id) {
            Some(name) => Formula::labelled(name, 0),
            None => derived(*inner, graph, problem),
        },
    }
}

impl Formula {
    pub(super) fn signed(self, negative: bool) -> Self {
        if negative { self.negated() } else { self }
    }
}

/// coefficient · term
fn derived_term(term: Id, coefficient: Rational, graph: &Graph, problem: &Problem) -> Formula {
    let Node::Product(factors) = graph.node(term) else {
        let above = if term == Id::ONE { Vec::new() } else { vec![derived(term, graph, problem)] };
        return product(coefficient, above, Vec::new());
    };
    let mut factors: Vec<_> = factors.to_vec();
    factors.sort_by_key(|&(factor, _)| reading_order(factor, graph));
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for (factor, exponent) in factors {
        let power = power(derived(factor, graph, problem), exponent.abs());
        if exponent.is_negative() { below.push(power) } else { above.push(power) }
    }
    product(coefficient, above, below)
}

fn power(base: Formula, exponent: Rational) -> Formula {
    if exponent.is_one() {
        return base;
    }
    if exponent == Rational::new_raw(1, 2) {
        return Formula::Root(Box::new(base));
    }
    Formula::Power(Box::new(base), Box::new(Formula::Number(exponent)))
}

/// Parameters come first, then multipliers, definitions, coordinates, functions, velocities, accelerations.
fn reading_order(factor: Id, graph: &Graph) -> (u8, u32) {
    match graph.node(factor) {
        Node::Symbol(symbol) => match Variable::of(*symbol) {
            Variable::Parameter(_) => (0, symbol.index),
            Variable::Multiplier(_) => (1, symbol.index),
            Variable::Time => (3, 0),
            Variable::Coordinate(_) => (4, symbol.index),
            Variable::Velocity(_) => (7, symbol.index),
            Variable::Acceleration(_) | Variable::Change(_) => (8, symbol.index),
        },
        Node::Pi => (0, 0),
        Node::Defined(_) => (2, factor.index() as u32),
        Node::Function(..) => (5, factor.index() as u32),
        _ => (6, factor.index() as u32),
    }
}

fn variable(variable: Variable, problem: &Problem) -> Formula {
    match variable {
        Variable::Time => Formula::labelled("t", 0),
        Variable::Coordinate(i) => Formula::labelled(&problem.coordinates[i].text, 0),
        Variable::Velocity(i) => Formula::labelled(&problem.coordinates[i].text, 1),
        Variable::Acceleration(i) => Formula::labelled(&problem.coordinates[i].text, 2),
        Variable::Multiplier(a) => Formula::Multiplier(problem.constraints[a].0.text.clone()),
        Variable::Change(i) => Formula::labelled(&format!("delta[{i}]"), 0),
        Variable::Parameter(k) => {
            let entry = problem.parameters.entries[k];
            let base = problem.parameters.fields[entry.field].name.text.clone();
            let indices = match entry.element {
                Element::All => Vec::new(),
                Element::Item(i) => vec![i],
                Element::RowItem(i, j) | Element::Cell(i, j) => vec![i, j],
            };
            let number = |i: usize| Formula::Number(Rational::from_integer(i as i128));
            Formula::Name { base, dots: 0, indices: indices.into_iter().map(number).collect() }
        }
    }
}
