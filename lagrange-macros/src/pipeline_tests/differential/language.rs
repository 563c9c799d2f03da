//! Expressions of the language: how they are written, and what they are worth.

use super::jet::Jet;
use crate::symbolic::{Double, Function, Rational};

/// What is written at random.
#[derive(Clone, Debug)]
pub(super) enum Term {
    Number(&'static str, i128, i128),
    Pi,
    Time,
    /// The number of an index.
    Index,
    /// What a function is given.
    Argument,
    Coordinate(usize),
    Velocity(usize),
    Parameter(usize),
    /// A definition before this.
    Defined(usize),
    Applied(usize, Box<Self>),
    Negative(Box<Self>),
    Binary(char, Box<[Self; 2]>),
    /// To a fixed power.
    Power(Box<Self>, i128, i128),
    /// To any power, of what is positive.
    Exponential(Box<[Self; 2]>),
    Function(Function, Box<Self>),
    Sqrt(Box<Self>),
    Atan2(Box<[Self; 2]>),
    Dot(Box<[[Self; 3]; 2]>),
    Norm(Box<[Self; 3]>),
    /// An entry of the cross product.
    Cross(Box<[[Self; 3]; 2]>, usize),
    Sum(usize, Box<Self>),
    Der(Box<Self>),
}

/// Where in the order of operations what is written stands: it takes parentheses where more is needed.
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const SIGN: u8 = 3;
const POWER: u8 = 4;
const ATOM: u8 = 5;

/// What names there are, and what they stand for.
pub(super) trait Names {
    fn coordinate(&self, i: usize, suffix: &str) -> String;
    fn definition(&self, i: usize) -> &Term;
}

impl Term {
    pub(super) fn text(&self, names: &impl Names) -> String {
        self.written(names).0
    }

    fn written(&self, names: &impl Names) -> (String, u8) {
        let at = |term: &Self, least: u8| {
            let (text, place) = term.written(names);
            if place < least { format!("({text})") } else { text }
        };
        let all = |terms: &[Self; 3]| {
            let texts = terms.each_ref().map(|term| term.text(names));
            format!("[{}]", texts.join(", "))
        };
        match self {
            Self::Number(text, ..) if text.contains('/') => ((*text).to_owned(), PRODUCT),
            Self::Number(text, ..) => ((*text).to_owned(), ATOM),
            Self::Pi => ("pi".to_owned(), ATOM),
            Self::Time => ("t".to_owned(), ATOM),
            Self::Index => ("i".to_owned(), ATOM),
            Self::Argument => ("s".to_owned(), ATOM),
            Self::Coordinate(i) => (names.coordinate(*i, ""), ATOM),
            Self::Velocity(i) => (names.coordinate(*i, "_dot"), ATOM),
            Self::Parameter(k) => (format!("p{k}"), ATOM),
            Self::Defined(k) => (format!("d{k}"), ATOM),
            Self::Applied(k, x) => (format!("d{k}({})", x.text(names)), ATOM),
            Self::Negative(x) => (format!("-{}", at(x, SIGN)), SIGN),
            Self::Binary(sign, terms) => {
                let (place, right) = match sign {
                    '+' => (SUM, SUM),
                    '-' => (SUM, PRODUCT),
                    '*' => (PRODUCT, PRODUCT),
                    _ => (PRODUCT, SIGN),
                };
                (format!("{} {sign} {}", at(&terms[0], place), at(&terms[1], right)), place)
            }
            Self::Power(x, n, 1) => (format!("{}^{n}", at(x, ATOM)), POWER),
            Self::Power(x, n, d) => (format!("{}^({n}/{d})", at(x, ATOM)), POWER),
            Self::Exponential(terms) => (format!("{}^{}", at(&terms[0], ATOM), at(&terms[1], SIGN)), POWER),
            Self::Function(function, x) => (format!("{}({})", function.name(), x.text(names)), ATOM),
            Self::Sqrt(x) => (format!("sqrt({})", x.text(names)), ATOM),
            Self::Atan2(terms) => {
                (format!("atan2({}, {})", terms[0].text(names), terms[1].text(names)), ATOM)
            }
            Self::Dot(vectors) => (format!("dot({}, {})", all(&vectors[0]), all(&vectors[1])), ATOM),
            Self::Norm(vector) => (format!("norm({})", all(vector)), ATOM),
            Self::Cross(vectors, k) => {
                (format!("cross({}, {})[{k}]", all(&vectors[0]), all(&vectors[1])), ATOM)
            }
            Self::Sum(count, x) => (format!("sum(i in 0..{count}, {})", x.text(names)), ATOM),
            Self::Der(x) => (format!("der({})", x.text(names)), ATOM),
        }
    }

    /// The value where things are as they are `here`.
    pub(super) fn value(&self, names: &impl Names, here: &Here) -> Jet {
        let of = |term: &Self| term.value(names, here);
        let all = |terms: &[Self; 3]| terms.each_ref().map(of);
        let dot = |[a, b, c]: [Jet; 3], [x, y, z]: [Jet; 3]| a * x + b * y + c * z;
        match self {
            Self::Number(_, n, 1) => Jet::number(*n as f64),
            Self::Number(_, n, d) => Jet::rounded(Double::from(Rational::new(*n, *d))),
            Self::Pi => Jet::rounded(Double::PI),
            Self::Time => here.time.clone(),
            Self::Index => Jet::number(here.index as f64),
            Self::Argument => here.argument.clone().expect("a function has an argument"),
            Self::Coordinate(i) => here.coordinates[*i].clone(),
            Self::Velocity(i) => here.velocities[*i].clone(),
            Self::Parameter(k) => Jet::number(here.parameters[*k]),
            Self::Defined(k) => names.definition(*k).value(names, &Here { argument: None, ..here.clone() }),
            Self::Applied(k, x) => {
                names.definition(*k).value(names, &Here { argument: Some(of(x)), ..here.clone() })
            }
            Self::Negative(x) => -of(x),
            Self::Binary(sign, terms) => {
                let [x, y] = terms.each_ref().map(of);
                match sign {
                    '+' => x + y,
                    '-' => x - y,
                    '*' => x * y,
                    _ => x / y,
                }
            }
            Self::Power(x, n, d) => of(x).power(Rational::new(*n, *d)),
            Self::Exponential(terms) => {
                (of(&terms[0]).apply(Function::Ln) * of(&terms[1])).apply(Function::Exp)
            }
            Self::Function(function, x) => of(x).apply(*function),
            Self::Sqrt(x) => of(x).sqrt(),
            Self::Atan2(terms) => of(&terms[0]).atan2(&of(&terms[1])),
            Self::Dot(vectors) => dot(all(&vectors[0]), all(&vectors[1])),
            Self::Norm(vector) => dot(all(vector), all(vector)).sqrt(),
            Self::Cross(vectors, k) => {
                let [a, b] = vectors.each_ref().map(all);
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                a[i].clone() * b[j].clone() - a[j].clone() * b[i].clone()
            }
            Self::Sum(count, x) => (0..*count)
                .fold(Jet::number(0.0), |sum, index| sum + x.value(names, &Here { index, ..here.clone() })),
            Self::Der(x) => x.value(names, &here.later()).rate(here.order),
        }
    }
}

/// Where and when, with so many ε in it.
#[derive(Clone)]
pub(super) struct Here {
    pub(super) time: Jet,
    pub(super) coordinates: Vec<Jet>,
    pub(super) velocities: Vec<Jet>,
    pub(super) parameters: Vec<f64>,
    pub(super) order: u32,
    index: usize,
    argument: Option<Jet>,
}

impl Here {
    pub(super) fn new(time: f64, coordinates: &[f64], velocities: &[f64], parameters: &[f64]) -> Self {
        let jets = |numbers: &[f64]| numbers.iter().copied().map(Jet::number).collect();
        Self {
            time: Jet::number(time),
            coordinates: jets(coordinates),
            velocities: jets(velocities),
            parameters: parameters.to_vec(),
            order: 0,
            index: 0,
            argument: None,
        }
    }

    /// A new ε later, by these velocities, that do not change.
    pub(super) fn later(&self) -> Self {
        let mut later = self.clone();
        later.time = self.time.moved(&Jet::number(1.0), self.order);
        let moved = self.coordinates.iter().zip(&self.velocities);
        later.coordinates = moved.map(|(q, v)| q.moved(v, self.order)).collect();
        later.argument = self.argument.clone();
        later.order += 1;
        later
    }

    /// With one coordinate a new ε larger.
    pub(super) fn by_coordinate(&self, i: usize) -> Self {
        let mut moved = self.clone();
        moved.coordinates[i] = self.coordinates[i].moved(&Jet::number(1.0), self.order);
        moved.order += 1;
        moved
    }

    /// With one velocity a new ε larger.
    pub(super) fn by_velocity(&self, i: usize) -> Self {
        let mut moved = self.clone();
        moved.velocities[i] = self.velocities[i].moved(&Jet::number(1.0), self.order);
        moved.order += 1;
        moved
    }
}
