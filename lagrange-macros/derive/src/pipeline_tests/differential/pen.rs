//! Random expressions from the parts of a system. The range of each operand is known, so that every function is smooth
//! there.

use super::draft::{Draft, Term, Vector};
use crate::symbolic::Function;
use lagrange_random::Random;

pub(super) fn number(text: &'static str, numerator: i128, denominator: i128) -> Term {
    Term::Number(text, numerator, denominator)
}

pub(super) fn binary(sign: char, x: Term, y: Term) -> Term {
    Term::Binary(sign, Box::new([x, y]))
}

pub(super) fn power(x: Term, numerator: i128, denominator: i128) -> Term {
    Term::Power(Box::new(x), numerator, denominator)
}

pub(super) fn half(x: Term) -> Term {
    binary('/', x, number("2", 2, 1))
}

pub(super) fn negative(x: Term) -> Term {
    Term::Negative(Box::new(x))
}

pub(super) fn function(name: Function, x: Term) -> Term {
    Term::Function(name, Box::new(x))
}

/// Draws terms from the coordinates, fields and definitions of a draft.
pub(super) struct Pen<'d> {
    pub(super) draft: &'d Draft,
    pub(super) random: &'d mut Random,
    /// True inside the definition of a function.
    pub(super) function: bool,
    pub(super) velocities: bool,
    /// True inside a sum or a family, where an index exists.
    pub(super) index: bool,
    /// True inside the step of a frame, where expressions must not refer to frames.
    pub(super) placing: bool,
}

impl Pen<'_> {
    fn any_number(&mut self) -> Term {
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
            0..4 if self.function => Term::Argument(0),
            0..3 if self.velocities => Term::Velocity(self.random.below(draft.count)),
            0 | 1 if self.index => self.indexed(),
            0..7 => Term::Coordinate(self.random.below(draft.count)),
            7 | 8 => self.parameter(),
            9 => Term::Time,
            10 if !draft.definitions.is_empty() => self.defined(),
            11 if self.random.once_in(4) => Term::Pi,
            _ => self.any_number(),
        }
    }

    fn parameter(&mut self) -> Term {
        Term::Parameter(self.random.one_of(&self.draft.scalars))
    }

    /// A term with the index, either alone or through the table.
    fn indexed(&mut self) -> Term {
        let several = self.draft.blocks(|length| length > 1);
        if self.draft.table.is_empty() || self.random.once_in(2) {
            return Term::Index;
        }
        Term::Picked(self.random.one_of(&several))
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

    /// A random smooth term.
    pub(super) fn term(&mut self, depth: usize) -> Term {
        let Some(below) = depth.checked_sub(1) else { return self.atom() };
        match self.random.below(25) {
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
            20 => self.dot(below),
            21 => self.component(below),
            22 if !self.index && !self.function => {
                self.index = true;
                let term = self.boxed(below);
                self.index = false;
                Term::Sum(2 + self.random.below(2), term)
            }
            23 if !self.draft.supplied.is_empty() => {
                Term::Supplied(0, Box::new([self.term(below), self.bounded(below)]))
            }
            _ => self.equal(below),
        }
    }

    /// A term that a simplifier can rewrite, and may get wrong.
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

    /// A term with values between -1 and 1.
    pub(super) fn bounded(&mut self, depth: usize) -> Term {
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
                binary('/', x.clone(), binary('+', number("1", 1, 1), power(x, 2, 1)))
            }
        }
    }

    /// A term with values well above 0.
    pub(super) fn positive(&mut self, depth: usize) -> Term {
        let Some(below) = depth.checked_sub(1) else {
            return self.parameter();
        };
        let one = number("1", 1, 1);
        match self.random.below(10) {
            0 => binary('+', one, power(self.term(below), 2, 1)),
            1 => binary('+', number("2", 2, 1), function(Function::Sin, self.term(below))),
            2 => function(Function::Exp, self.bounded(below)),
            3 => function(Function::Cosh, self.bounded(below)),
            4 => Term::Sqrt(Box::new(binary('+', one, power(self.term(below), 2, 1)))),
            5 => binary('+', function(Function::Abs, self.bounded(below)), number("0.5", 1, 2)),
            6 => {
                let entries = Box::new([self.term(below), self.term(below), Term::Parameter(0)]);
                Term::Norm(Box::new(Vector::Entries(entries)))
            }
            7 => Term::Exponential(Box::new([self.positive(below), self.bounded(below)])),
            8 => power(self.positive(below), self.random.one_of(&[1, -1, 3]), self.random.one_of(&[1, 2, 3])),
            _ => self.parameter(),
        }
    }
}
