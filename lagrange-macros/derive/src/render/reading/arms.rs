//! Puts cross products with a common factor together: c×a + b×c = c×(a − b).

use num_traits::Signed;

use super::super::formula::Formula;
use super::atoms::Meaning;
use super::vectors::VectorTerm;

/// Puts terms together that are cross products with a common factor, with equal coefficients but for the sign.
pub(super) fn joined(mut terms: Vec<VectorTerm>) -> Vec<VectorTerm> {
    let mut done = Vec::new();
    while !terms.is_empty() {
        let first = terms.remove(0);
        let joined = sides(&first).into_iter().flatten().find_map(|arm| with_others(&first, arm, &mut terms));
        done.push(joined.unwrap_or(first));
    }
    done
}

/// The sum of a term with others that have the same factor in their cross products, which are removed; `None` if there are none.
fn with_others(first: &VectorTerm, arm: &Formula, terms: &mut Vec<VectorTerm>) -> Option<VectorTerm> {
    let (number, mut forces) = (first.coefficient.abs(), vec![beside(first, arm)?]);
    terms.retain(|term| {
        let is_like = term.scalar == first.scalar && term.coefficient.abs() == number;
        let force = beside(term, arm).filter(|_| is_like);
        let is_alone = force.is_none();
        forces.extend(force);
        is_alone
    });
    (forces.len() > 1).then_some(())?;
    forces.sort_by_key(Formula::is_negative);
    let is_negative = forces[0].is_negative();
    let forces = forces.into_iter().map(|force| force.signed(is_negative)).collect();
    let product = Formula::Call("cross".to_owned(), vec![arm.clone(), sum(forces)]);
    let Meaning::Vector(_, variables) = &first.factors[0] else { return None };
    let coefficient = if is_negative { -number } else { number };
    let factors = vec![Meaning::Vector(product, variables.clone())];
    Some(VectorTerm { coefficient, scalar: first.scalar.clone(), factors })
}

/// Factors of a term that is a cross product.
fn sides(term: &VectorTerm) -> Option<[&Formula; 2]> {
    match &term.factors[..] {
        [Meaning::Vector(Formula::Call(name, sides), _)] if name == "cross" => Some([&sides[0], &sides[1]]),
        _ => None,
    }
}

/// The other factor of a cross product that begins with this one, with the sign of the term.
fn beside(term: &VectorTerm, arm: &Formula) -> Option<Formula> {
    let [one, other] = sides(term)?;
    let is_negative = term.coefficient.is_negative();
    match (one == arm, other == arm) {
        (true, _) => Some(other.clone().signed(is_negative)),
        (_, true) => Some(one.clone().signed(!is_negative)),
        _ => None,
    }
}

/// A sum of products with a common first factor is a product with a sum.
fn sum(terms: Vec<Formula>) -> Formula {
    let factors = |term: &Formula| match term.sign_and_magnitude().1 {
        Formula::Product(factors, below) if below.is_empty() => factors,
        other => vec![other],
    };
    let all: Vec<Vec<Formula>> = terms.iter().map(factors).collect();
    if !all.iter().all(|factors| factors.len() > 1 && factors[0] == all[0][0]) {
        return Formula::sum(terms);
    }
    let rest = all.iter().zip(&terms).map(|(factors, term)| {
        let rest = match &factors[1..] {
            [single] => single.clone(),
            several => Formula::Product(several.to_vec(), Vec::new()),
        };
        rest.signed(term.is_negative())
    });
    Formula::Product(vec![all[0][0].clone(), sum(rest.collect())], Vec::new())
}
