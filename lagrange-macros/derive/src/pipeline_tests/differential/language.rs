//! Scalar expressions of the language: their text and their values.

use super::double::{self, Double};
use super::draft::{ATOM, Draft, POWER, PRODUCT, SIGN, SUM, Term, Vector};
use super::here::Here;
use super::jet::Jet;
use super::space;
use crate::symbolic::{Function, Rational};

impl Term {
    pub(super) fn text(&self, draft: &Draft) -> String {
        self.written(draft).0
    }

    /// Text of the term, in parentheses if its precedence is below `least`.
    pub(super) fn at(&self, least: u8, draft: &Draft) -> String {
        let (text, place) = self.written(draft);
        if place < least { format!("({text})") } else { text }
    }

    fn written(&self, draft: &Draft) -> (String, u8) {
        let at = |term: &Self, least: u8| term.at(least, draft);
        match self {
            Self::Number(text, ..) if text.contains('/') => ((*text).to_owned(), PRODUCT),
            Self::Number(text, ..) => ((*text).to_owned(), ATOM),
            Self::Pi => ("pi".to_owned(), ATOM),
            Self::Time => ("t".to_owned(), ATOM),
            Self::Index => ("i".to_owned(), ATOM),
            Self::Argument(k) => (["s", "r"][*k].to_owned(), ATOM),
            Self::Coordinate(i) => (draft.coordinate(*i, ""), ATOM),
            Self::Velocity(i) => (draft.coordinate(*i, "_dot"), ATOM),
            Self::Parameter(k) => (draft.names[*k].clone(), ATOM),
            Self::Picked(i) => (format!("{}[pick[i]]", draft.block(*i, "")), ATOM),
            Self::Defined(k) => (format!("d{k}"), ATOM),
            Self::Applied(k, x) => (format!("d{k}({})", x.text(draft)), ATOM),
            Self::Supplied(k, x) => (format!("u{k}({}, {})", x[0].text(draft), x[1].text(draft)), ATOM),
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
            Self::Function(function, x) => (format!("{}({})", function.name(), x.text(draft)), ATOM),
            Self::Sqrt(x) => (format!("sqrt({})", x.text(draft)), ATOM),
            Self::Atan2(terms) => {
                (format!("atan2({}, {})", terms[0].text(draft), terms[1].text(draft)), ATOM)
            }
            Self::Dot(v) => (format!("dot({}, {})", v[0].text(draft), v[1].text(draft)), ATOM),
            Self::Norm(v) => (format!("norm({})", v.text(draft)), ATOM),
            Self::Component(v, k) => (format!("{}[{k}]", v.atom(draft)), ATOM),
            Self::Kinetic(k, of, inertia) => {
                let (frame, inertia) = (&draft.frames[*k].name, draft.whole(*inertia));
                (format!("kinetic({frame}, {}, {}, {inertia})", of.0.text(draft), of.1.text(draft)), ATOM)
            }
            Self::Sum(count, x) => (format!("sum(i in 0..{count}, {})", x.text(draft)), ATOM),
            Self::Der(x) => (format!("der({})", x.text(draft)), ATOM),
        }
    }

    /// Value of the term at the time, state and parameters of `here`.
    pub(super) fn value(&self, draft: &Draft, here: &Here) -> Jet {
        let of = |term: &Self| term.value(draft, here);
        let vector = |vector: &Vector| vector.value(draft, here);
        match self {
            Self::Number(_, n, 1) => Jet::number(*n as f64),
            Self::Number(_, n, d) => Jet::rounded(Double::from(Rational::new(*n, *d))),
            Self::Pi => Jet::rounded(double::PI),
            Self::Time => here.time.clone(),
            Self::Index => Jet::number(here.index as f64),
            Self::Argument(k) => here.arguments[*k].clone(),
            Self::Coordinate(i) => here.coordinates[*i].clone(),
            Self::Velocity(i) => here.velocities[*i].clone(),
            Self::Parameter(k) => Jet::number(here.parameters[*k]),
            Self::Picked(i) => here.coordinates[i + draft.table[here.index]].clone(),
            Self::Defined(k) => draft.definitions[*k].0.value(draft, &here.with_arguments(Vec::new())),
            Self::Applied(k, x) => draft.definitions[*k].0.value(draft, &here.with_arguments(vec![of(x)])),
            Self::Supplied(k, x) => {
                let here = here.with_arguments(x.each_ref().map(of).to_vec());
                draft.supplied[*k].results[0].value(draft, &here)
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
            Self::Dot(v) => space::dot(&vector(&v[0]), &vector(&v[1])),
            Self::Norm(v) => space::dot(&vector(v), &vector(v)).sqrt(),
            Self::Component(v, k) => vector(v)[*k].clone(),
            Self::Kinetic(k, parts, inertia) => {
                space::kinetic(*k, &of(&parts.0), &parts.1, *inertia, draft, here)
            }
            Self::Sum(count, x) => {
                (0..*count).fold(Jet::number(0.0), |sum, index| sum + x.value(draft, &here.at_index(index)))
            }
            Self::Der(x) => x.value(draft, &here.later()).rate(here.order),
        }
    }
}
