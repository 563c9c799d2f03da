//! Merges products of sines and cosines: sin² + cos², sums and differences of angles, double angles, half angles.

use num_traits::{One, Signed};

use super::atoms::{Atoms, Meaning};
use crate::symbolic::{self, Atom, Function, Monomial, Polynomial, Rational};

/// A sine or cosine in a monomial.
#[derive(Clone, Copy)]
struct Wave {
    atom: Atom,
    is_sine: bool,
    /// Atom of the cosine for a sine, and of the sine for a cosine.
    other: Atom,
    is_squared: bool,
}

/// Terms to remove, and the terms that replace them.
struct Merger {
    parts: Vec<Monomial>,
    factors: Polynomial,
}

type Rule = fn(&mut Atoms, &Polynomial, &Monomial, Rational, [Wave; 2]) -> Option<Merger>;

/// Rules in order of priority: the first that applies to any term is used. Each removes a term, or fractions of angles.
const RULES: [Rule; 4] = [pythagoras, complement, addition, halves];

impl Atoms {
    /// Merges terms until no rule applies.
    pub(super) fn merged(&mut self, polynomial: Polynomial) -> Option<Polynomial> {
        let mut merged = polynomial;
        while let Some(Merger { parts, factors }) = self.merger(&merged) {
            parts.iter().for_each(|part| merged.remove(part));
            merged.add(&factors, Rational::one())?;
        }
        Some(merged)
    }

    fn merger(&mut self, polynomial: &Polynomial) -> Option<Merger> {
        let mut terms = Vec::new();
        for (monomial, &c) in polynomial.terms() {
            let waves = self.waves(monomial);
            let pairs =
                waves.iter().enumerate().flat_map(|(i, &one)| waves[i..].iter().map(move |&two| [one, two]));
            terms.extend(pairs.map(|pair| (monomial, c, pair)));
        }
        let mut tries = RULES.iter().flat_map(|rule| terms.iter().map(move |term| (rule, term)));
        tries.find_map(|(rule, &(monomial, c, pair))| rule(self, polynomial, monomial, c, pair))
    }

    fn waves(&mut self, monomial: &Monomial) -> Vec<Wave> {
        let mut waves = Vec::new();
        for &(atom, exponent) in
            monomial.factors().iter().filter(|(_, exponent)| *exponent >= Rational::one())
        {
            if let Some((is_sine, other)) = self.other_wave(atom) {
                waves.push(Wave { atom, is_sine, other, is_squared: exponent >= Rational::from_integer(2) });
            }
        }
        waves
    }

    /// Returns whether an atom is a sine, with the cosine of its angle, or a cosine, with the sine.
    fn other_wave(&mut self, atom: Atom) -> Option<(bool, Atom)> {
        let Meaning::Function(function @ (Function::Sin | Function::Cos), angle) = self.meaning(atom) else {
            return None;
        };
        let is_sine = *function == Function::Sin;
        if let Some(&other) = self.other_waves.get(&atom) {
            return Some((is_sine, other));
        }
        let other = if is_sine { Function::Cos } else { Function::Sin };
        let other = self.atom(Meaning::Function(other, angle.clone()));
        self.other_waves.insert(atom, other);
        Some((is_sine, other))
    }

    /// Angle of a sine or cosine.
    fn angle(&self, wave: Wave) -> &Polynomial {
        match self.meaning(wave.atom) {
            Meaning::Function(_, angle) => angle,
            other => unreachable!("{other:?} is no wave"),
        }
    }
}

/// Term without the square of a sine or cosine, and the same term with the square of the other function.
fn other_square(one: &Monomial, [a, b]: [Wave; 2]) -> Option<[Monomial; 2]> {
    let square = |atom| Monomial::of(atom, Rational::from_integer(2));
    (a.atom == b.atom && a.is_squared).then_some(())?;
    let rest = one.over(&square(a.atom))?;
    let other = rest.times(&square(a.other))?;
    Some([rest, other])
}

/// c m sin² a + c m cos² a = c m
fn pythagoras(
    _: &mut Atoms,
    all: &Polynomial,
    one: &Monomial,
    c: Rational,
    waves: [Wave; 2],
) -> Option<Merger> {
    let [rest, other] = other_square(one, waves)?;
    let is_it = all.coefficient(&other) == Some(c);
    is_it.then(|| Merger { parts: vec![one.clone(), other], factors: Polynomial::term(rest, c) })
}

/// c m − c m sin² a = c m cos² a
fn complement(
    _: &mut Atoms,
    all: &Polynomial,
    one: &Monomial,
    c: Rational,
    waves: [Wave; 2],
) -> Option<Merger> {
    let [rest, other] = other_square(one, waves)?;
    let is_it = all.coefficient(&rest) == Some(-c);
    is_it.then(|| Merger { parts: vec![one.clone(), rest], factors: Polynomial::term(other, -c) })
}

/// 2ⁿ sinⁿ(a/2) cosⁿ(a/2) = sinⁿ a
fn halves(
    atoms: &mut Atoms,
    _: &Polynomial,
    one: &Monomial,
    c: Rational,
    [a, b]: [Wave; 2],
) -> Option<Merger> {
    let two = Rational::from_integer(2);
    let are_both = a.atom == b.other && one.exponent(a.atom) == one.exponent(b.atom);
    (are_both && atoms.angle(a).terms().all(|(_, c)| c.denom() % 2 == 0)).then_some(())?;
    let times = one.exponent(a.atom).floor();
    let rest = one.over(&Monomial::of(a.atom, times))?.over(&Monomial::of(b.atom, times))?;
    let double = atoms.angle(a).scaled(&Monomial::default(), two)?;
    let sine = atoms.function(Function::Sin, &double);
    let half = symbolic::power(two, -times.to_integer())?;
    let factors = atoms.natural_power(&sine, times.to_integer())?.scaled(&rest, symbolic::times(c, half)?)?;
    Some(Merger { parts: vec![one.clone()], factors })
}

/// cos a cos b ± sin a sin b = cos(a ∓ b), sin a cos b ± cos a sin b = sin(a ± b)
fn addition(
    atoms: &mut Atoms,
    all: &Polynomial,
    one: &Monomial,
    c: Rational,
    [a, b]: [Wave; 2],
) -> Option<Merger> {
    let is_square = a.atom == b.atom;
    if a.is_sine && b.is_sine || is_square && !a.is_squared || !is_square && a.atom == b.other {
        return None;
    }
    let (a, b) = if b.is_sine { (b, a) } else { (a, b) };
    let rest =
        one.over(&Monomial::of(a.atom, Rational::one()))?.over(&Monomial::of(b.atom, Rational::one()))?;
    let others = Monomial::of(a.other, Rational::one()).times(&Monomial::of(b.other, Rational::one()))?;
    let two = rest.times(&others)?;
    let ratio = symbolic::times(all.coefficient(&two)?, c.recip())?;
    if !ratio.abs().is_one() {
        return None;
    }
    let (function, sign) = if a.is_sine { (Function::Sin, ratio) } else { (Function::Cos, -ratio) };
    let mut angle = atoms.angle(a).clone();
    angle.add(atoms.angle(b), sign)?;
    let factors = atoms.function(function, &angle).scaled(&rest, c)?;
    Some(Merger { parts: vec![one.clone(), two], factors })
}
