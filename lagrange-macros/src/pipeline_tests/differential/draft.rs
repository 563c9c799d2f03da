//! A system at random: every matrix M definite, every function where it is smooth.

use super::language::{Names, Term};
use crate::rounds::Random;
use crate::symbolic::Function;

/// A system as it is drawn.
#[derive(Default)]
pub(super) struct Draft {
    /// Names and how many numbers they are of.
    coordinates: Vec<(String, usize)>,
    pub(super) count: usize,
    parameters: usize,
    /// A value, or a function of one argument.
    definitions: Vec<(Term, bool)>,
    pub(super) lagrangian: Vec<Term>,
    pub(super) dissipation: Option<Term>,
    pub(super) forces: Vec<(usize, Term)>,
    /// Whether it constrains velocities.
    pub(super) constraints: Vec<(Term, bool)>,
}

impl Names for Draft {
    fn coordinate(&self, i: usize, suffix: &str) -> String {
        let mut rest = i;
        for (name, length) in &self.coordinates {
            match length {
                1 if rest == 0 => return format!("{name}{suffix}"),
                _ if rest < *length => return format!("{name}{suffix}[{rest}]"),
                _ => rest -= length,
            }
        }
        unreachable!("there is no coordinate {i}")
    }

    fn definition(&self, i: usize) -> &Term {
        &self.definitions[i].0
    }
}

impl Draft {
    pub(super) fn source(&self) -> String {
        let coordinates = self.coordinates.iter().map(|(name, length)| match length {
            1 => name.clone(),
            _ => format!("{name}: [{length}]"),
        });
        let mut attributes = vec![format!("coordinates({})", coordinates.collect::<Vec<_>>().join(", "))];
        for (k, (term, is_function)) in self.definitions.iter().enumerate() {
            let argument = if *is_function { "(s)" } else { "" };
            attributes.push(format!("define(d{k}{argument} = {})", term.text(self)));
        }
        let terms: Vec<String> = self.lagrangian.iter().map(|term| term.text(self)).collect();
        attributes.push(format!("lagrangian({})", terms.join(" + ")));
        attributes.extend(self.dissipation.iter().map(|term| format!("dissipation({})", term.text(self))));
        for (i, term) in &self.forces {
            attributes.push(format!("force({}: {})", self.coordinate(*i, ""), term.text(self)));
        }
        for (k, (term, _)) in self.constraints.iter().enumerate() {
            attributes.push(format!("constraint(c{k}: {} = 0)", term.text(self)));
        }
        let attributes: String = attributes.iter().map(|text| format!("#[{text}]\n")).collect();
        let fields: Vec<String> = (0..self.parameters).map(|k| format!("p{k}: f64")).collect();
        format!("{attributes}struct Random {{ {} }}", fields.join(", "))
    }

    pub(super) fn new(random: &mut Random) -> Self {
        let mut draft = Self { parameters: 2 + random.below(3), ..Self::default() };
        for k in 0..1 + random.below(2) {
            let length = 1 + random.below(3);
            draft.coordinates.push((format!("q{k}"), length));
            draft.count += length;
        }
        for _ in 0..random.below(3) {
            let is_function = random.once_in(2);
            let term =
                Pen { draft: &draft, random, function: is_function, velocities: false, index: false }.term(2);
            draft.definitions.push((term, is_function));
        }
        draft.lagrangian = draft.kinetic(random);
        for _ in 0..1 + random.below(2) {
            let term = draft.pen(random).term(3);
            draft.lagrangian.push(negative(term));
        }
        draft.act(random);
        let first = random.below(draft.count);
        for k in 0..random.below(draft.count.min(3)) {
            let constraint = draft.constraint((first + k) % draft.count, random);
            draft.constraints.push(constraint);
        }
        draft
    }

    fn pen<'d>(&'d self, random: &'d mut Random) -> Pen<'d> {
        Pen { draft: self, random, function: false, velocities: false, index: false }
    }

    /// Squares of the velocities, each with some of those before it, which makes M definite; and now and then what only adds
    /// to it, or is linear in the velocities.
    fn kinetic(&self, random: &mut Random) -> Vec<Term> {
        let mut terms = Vec::new();
        for i in 0..self.count {
            let mut speed = Term::Velocity(i);
            for j in 0..i {
                if random.once_in(3) {
                    let slope = self.pen(random).bounded(2);
                    speed = binary('+', speed, binary('*', slope, Term::Velocity(j)));
                }
            }
            let mass = if random.once_in(3) { self.pen(random).positive(2) } else { Term::Parameter(0) };
            terms.push(half(binary('*', mass, power(speed, 2, 1))));
        }
        let i = random.below(self.count);
        terms.extend(match random.below(6) {
            0 => Some(power(Term::Der(Box::new(self.pen(random).bounded(2))), 2, 1)),
            1 => Some(Term::Der(Box::new(self.pen(random).term(2)))),
            2 => Some(binary('*', self.pen(random).bounded(2), Term::Velocity(i))),
            3 => Some(Term::Sqrt(Box::new(binary(
                '+',
                Term::Number("1", 1, 1),
                power(Term::Velocity(i), 2, 1),
            )))),
            _ => None,
        });
        terms
    }

    fn act(&mut self, random: &mut Random) {
        for i in 0..self.count {
            if random.once_in(4) {
                let mut pen = self.pen(random);
                pen.velocities = true;
                let force = pen.term(2);
                self.forces.push((i, force));
            }
        }
        if random.once_in(3) {
            let speed = Term::Velocity(random.below(self.count));
            let drag = binary('*', self.pen(random).positive(1), power(speed, 2, 1));
            self.dissipation = Some(drag);
        }
    }

    /// Of coordinates, or linear in velocities. Each has a coordinate of its own, so that none says what another one does.
    fn constraint(&self, i: usize, random: &mut Random) -> (Term, bool) {
        let of_velocities = random.once_in(2);
        let own = if of_velocities { Term::Velocity(i) } else { Term::Coordinate(i) };
        let mut term = binary('*', Term::Parameter(random.below(self.parameters)), own);
        for j in 0..self.count {
            if j != i && random.once_in(2) {
                let factor = self.pen(random).bounded(1);
                let other = if of_velocities { Term::Velocity(j) } else { Term::Coordinate(j) };
                term = binary('+', term, binary('*', factor, other));
            }
        }
        let rest = self.pen(random).bounded(2);
        (binary('-', term, rest), of_velocities)
    }

    /// A random time, coordinates, velocities and parameters.
    pub(super) fn numbers(&self, random: &mut Random) -> (f64, [Vec<f64>; 3]) {
        let mut several =
            |count, low, high| (0..count).map(|_| random.between(low, high)).collect::<Vec<_>>();
        let numbers = [
            several(self.count, -1.5, 1.5),
            several(self.count, -1.5, 1.5),
            several(self.parameters, 0.5, 2.0),
        ];
        (random.between(0.0, 2.0), numbers)
    }
}

fn binary(sign: char, x: Term, y: Term) -> Term {
    Term::Binary(sign, Box::new([x, y]))
}

fn power(x: Term, numerator: i128, denominator: i128) -> Term {
    Term::Power(Box::new(x), numerator, denominator)
}

fn half(x: Term) -> Term {
    binary('/', x, Term::Number("2", 2, 1))
}

fn negative(x: Term) -> Term {
    Term::Negative(Box::new(x))
}

fn function(name: Function, x: Term) -> Term {
    Term::Function(name, Box::new(x))
}

/// Writes terms of what there is.
struct Pen<'d> {
    draft: &'d Draft,
    random: &'d mut Random,
    /// Inside of a function.
    function: bool,
    velocities: bool,
    /// Inside of a sum.
    index: bool,
}

impl Pen<'_> {
    fn number(&mut self) -> Term {
        const NUMBERS: [(&str, i128, i128); 9] = [
            ("1", 1, 1),
            ("2", 2, 1),
            ("3", 3, 1),
            ("0.5", 1, 2),
            ("9.81", 981, 100),
            ("1_0.25", 41, 4),
            ("2.5e-1", 1, 4),
            ("2/3", 2, 3),
            ("7/5", 7, 5),
        ];
        let (text, numerator, denominator) = self.random.one_of(&NUMBERS);
        Term::Number(text, numerator, denominator)
    }

    fn atom(&mut self) -> Term {
        let draft = self.draft;
        match self.random.below(12) {
            0..4 if self.function => Term::Argument,
            0..3 if self.velocities => Term::Velocity(self.random.below(draft.count)),
            0..2 if self.index => Term::Index,
            0..7 => Term::Coordinate(self.random.below(draft.count)),
            7 | 8 => Term::Parameter(self.random.below(draft.parameters)),
            9 => Term::Time,
            10 if !draft.definitions.is_empty() => self.defined(),
            11 if self.random.once_in(4) => Term::Pi,
            _ => self.number(),
        }
    }

    fn defined(&mut self) -> Term {
        let k = self.random.below(self.draft.definitions.len());
        if self.draft.definitions[k].1 {
            Term::Applied(k, Box::new(self.bounded(1)))
        } else {
            Term::Defined(k)
        }
    }

    fn boxed(&mut self, depth: usize) -> Box<Term> {
        Box::new(self.term(depth))
    }

    fn vector(&mut self, depth: usize) -> [Term; 3] {
        std::array::from_fn(|_| self.term(depth))
    }

    /// Any smooth function.
    fn term(&mut self, depth: usize) -> Term {
        let Some(below) = depth.checked_sub(1) else { return self.atom() };
        match self.random.below(24) {
            0..8 => {
                let sign = self.random.one_of(&['+', '-', '*', '*']);
                binary(sign, self.term(below), self.term(below))
            }
            8 => binary('/', self.term(below), self.positive(below)),
            9 => negative(self.term(below)),
            10 => power(self.term(below), 2, 1),
            11 => power(self.bounded(below), 3, 1),
            12..16 => self.bounded(depth),
            16..18 => self.positive(depth),
            18 => match self.random.below(3) {
                0 => function(Function::Acos, half(self.bounded(below))),
                1 => function(Function::Tan, half(self.bounded(below))),
                _ => function(Function::Ln, self.positive(below)),
            },
            19 => Term::Atan2(Box::new([self.term(below), self.positive(below)])),
            20 => Term::Dot(Box::new([self.vector(below), self.vector(below)])),
            21 => {
                let vectors = Box::new([self.vector(below), self.vector(below)]);
                Term::Cross(vectors, self.random.below(3))
            }
            22 if !self.index && !self.function => {
                self.index = true;
                let term = self.boxed(below);
                self.index = false;
                Term::Sum(2 + self.random.below(2), term)
            }
            _ => self.equal(below),
        }
    }

    /// What a simplifier has something to do with, and may get wrong.
    fn equal(&mut self, depth: usize) -> Term {
        let (x, y) = (self.term(depth), self.atom());
        let square = |name, x: &Term| power(function(name, x.clone()), 2, 1);
        match self.random.below(9) {
            0 => binary('+', square(Function::Sin, &x), square(Function::Cos, &x)),
            1 => binary('-', square(Function::Cos, &x), square(Function::Sin, &x)),
            2 => binary('-', power(binary('+', x.clone(), y.clone()), 2, 1), power(x, 2, 1)),
            3 => binary('*', binary('-', x.clone(), y.clone()), binary('-', y, x)),
            4 => function(Function::Sin, negative(x)),
            5 => function(Function::Cos, binary('-', x, y)),
            6 => power(negative(x), 3, 1),
            7 => function(Function::Ln, function(Function::Exp, self.bounded(depth))),
            _ => {
                let base = self.positive(depth);
                binary('*', power(base.clone(), 1, 3), power(base, -4, 3))
            }
        }
    }

    /// Between -1 and 1.
    fn bounded(&mut self, depth: usize) -> Term {
        let Some(below) = depth.checked_sub(1) else {
            return function(Function::Sin, self.atom());
        };
        match self.random.below(8) {
            0 | 1 => function(Function::Sin, self.term(below)),
            2 | 3 => function(Function::Cos, self.term(below)),
            4 => function(Function::Tanh, self.term(below)),
            5 => half(function(Function::Atan, self.term(below))),
            6 => half(function(Function::Asin, half(self.bounded(below)))),
            _ => {
                let x = self.term(below);
                binary('/', x.clone(), binary('+', Term::Number("1", 1, 1), power(x, 2, 1)))
            }
        }
    }

    /// Well above 0.
    fn positive(&mut self, depth: usize) -> Term {
        let Some(below) = depth.checked_sub(1) else {
            return Term::Parameter(self.random.below(self.draft.parameters));
        };
        let one = Term::Number("1", 1, 1);
        match self.random.below(10) {
            0 => binary('+', one, power(self.term(below), 2, 1)),
            1 => binary('+', Term::Number("2", 2, 1), function(Function::Sin, self.term(below))),
            2 => function(Function::Exp, self.bounded(below)),
            3 => function(Function::Cosh, self.bounded(below)),
            4 => Term::Sqrt(Box::new(binary('+', one, power(self.term(below), 2, 1)))),
            5 => binary('+', function(Function::Abs, self.bounded(below)), Term::Number("0.5", 1, 2)),
            6 => {
                let [x, y, _] = self.vector(below);
                Term::Norm(Box::new([x, y, Term::Parameter(0)]))
            }
            7 => Term::Exponential(Box::new([self.positive(below), self.bounded(below)])),
            8 => power(self.positive(below), self.random.one_of(&[1, -1, 3]), self.random.one_of(&[1, 2, 3])),
            _ => Term::Parameter(self.random.below(self.draft.parameters)),
        }
    }
}
