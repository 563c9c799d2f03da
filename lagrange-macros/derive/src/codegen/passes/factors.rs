//! Factors sums of products: a b + a c becomes a (b + c), and (p cos x)² + (p sin x)² becomes p².
//!
//! A sum includes its inner sums if they are used nowhere else. The factor that most terms share goes first (Horner's
//! rule in several variables: Knuth, *The Art of Computer Programming*, 4.6.4).

use indexmap::IndexMap;

use super::rewrite::{Places, carried_over, rebuilt};
use super::signs::Signed;
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::Function;

/// Maximum number of terms of a sum. Longer sums stay unchanged, because all pairs of terms would be
/// compared.
const TERMS: usize = 256;
/// Maximum number of factors of a product. Longer products stay whole, because each factor taken out is a
/// level of recursion.
const FACTORS: usize = 64;

pub(super) fn taken_out(old: &Schedule, results: &[Register]) -> (Schedule, Vec<Register>) {
    let uses = old.uses(results);
    let inner = inner_sums(old, &uses);
    rebuilt(old, results, |new, index, places| {
        let operation = old.operations[index];
        let mut pass = Pass { old, uses: &uses, new, places };
        let factored = if is_sum(operation) && !inner[index] { pass.factored(operation) } else { None };
        factored.unwrap_or_else(|| carried_over(new, old, operation, |_, operand| places.at(operand)))
    })
}

fn is_sum(operation: Operation) -> bool {
    matches!(operation, Operation::Add(..) | Operation::Subtract(..))
}

/// True for a sum that only one other sum uses, and that is merged into it.
fn inner_sums(old: &Schedule, uses: &[usize]) -> Vec<bool> {
    let mut inner = vec![false; uses.len()];
    for (index, &operation) in old.operations.iter().enumerate() {
        if uses[index] > 0 && is_sum(operation) {
            old.operands(operation)
                .filter(|operand| uses[operand.index()] == 1)
                .for_each(|operand| inner[operand.index()] = true);
        }
    }
    inner
}

/// Product with a sign. Its factors are registers of the old schedule.
#[derive(Clone, PartialEq)]
struct SignedProduct {
    negative: bool,
    factors: Vec<Register>,
}

struct Pass<'s> {
    old: &'s Schedule,
    uses: &'s [usize],
    new: &'s mut Schedule,
    /// Registers in the new schedule of results of the old one.
    places: &'s Places,
}

impl Pass<'_> {
    /// Returns the factored sum. `None` if no two terms share a factor.
    fn factored(&mut self, sum: Operation) -> Option<Register> {
        let terms = self.terms(sum)?;
        let (register, negative) = self.grouped(terms)?;
        Some(if negative { self.new.push(Operation::Negate(register)) } else { register })
    }

    /// Returns the terms of a sum. `None` if there are too many.
    fn terms(&self, sum: Operation) -> Option<Vec<SignedProduct>> {
        let mut terms = Vec::new();
        let mut pending = vec![(sum, false)];
        while let Some((sum, negative)) = pending.pop() {
            let (Operation::Add(x, y) | Operation::Subtract(x, y)) = sum else { continue };
            let flipped = negative != matches!(sum, Operation::Subtract(..));
            for (operand, negative) in [(x, negative), (y, flipped)] {
                let operation = self.old.operations[operand.index()];
                match is_sum(operation) && self.uses[operand.index()] == 1 {
                    true => pending.push((operation, negative)),
                    false => terms.push(SignedProduct { negative, factors: self.factors(operand) }),
                }
            }
            if terms.len() + pending.len() > TERMS {
                return None;
            }
        }
        // Restore the order in which operands precede their uses.
        terms.reverse();
        Some(terms)
    }

    fn factors(&self, product: Register) -> Vec<Register> {
        let mut factors = Vec::new();
        let mut pending = vec![product];
        while let Some(register) = pending.pop() {
            match self.old.operations[register.index()] {
                Operation::Multiply(x, y)
                    if self.uses[register.index()] == 1 && factors.len() + pending.len() < FACTORS =>
                {
                    pending.extend([x, y]);
                }
                _ => factors.push(register),
            }
        }
        factors.sort_unstable();
        factors
    }

    /// Combines terms of the sum as long as some share a factor.
    fn grouped(&mut self, mut terms: Vec<SignedProduct>) -> Option<Signed> {
        let mut sums = Vec::new();
        let mut is_better = false;
        loop {
            while let Some((i, j, square)) = self.circle(&terms) {
                terms[i].factors = square;
                terms.remove(j);
                is_better = true;
            }
            let Some(shared) = most_shared(&terms) else { break };
            let (with, without) = terms.into_iter().partition(|term| term.factors.contains(&shared));
            sums.push(self.product_of_sum(shared, with));
            terms = without;
            is_better = true;
        }
        if !is_better {
            return None;
        }
        let rest: Vec<Signed> = terms.iter().map(|term| self.product(term)).collect();
        Some(self.sum(rest.into_iter().chain(sums)))
    }

    fn product_of_sum(&mut self, shared: Register, mut terms: Vec<SignedProduct>) -> Signed {
        for term in &mut terms {
            let position = term.factors.iter().position(|&factor| factor == shared);
            position.map(|position| term.factors.remove(position));
        }
        let (sum, negative) = match self.grouped(terms.clone()) {
            Some(sum) => sum,
            None => {
                let terms: Vec<Signed> = terms.iter().map(|term| self.product(term)).collect();
                self.sum(terms.into_iter())
            }
        };
        let shared = self.places.at(shared);
        (self.new.push(Operation::Multiply(shared, sum)), negative)
    }

    fn product(&mut self, term: &SignedProduct) -> Signed {
        let places: Vec<Register> = term.factors.iter().map(|&factor| self.places.at(factor)).collect();
        let product =
            places.into_iter().reduce(|product, factor| self.new.push(Operation::Multiply(product, factor)));
        (product.unwrap_or_else(|| self.new.constant(1.0)), term.negative)
    }

    /// Sums the terms, starting with a positive one to avoid a negation.
    fn sum(&mut self, terms: impl Iterator<Item = Signed>) -> Signed {
        let mut terms: Vec<Signed> = terms.collect();
        let first = terms.iter().position(|(_, negative)| !negative);
        let (start, all_negative) = terms.remove(first.unwrap_or(0));
        let total = terms.into_iter().fold(start, |total, (term, negative)| {
            self.new.push(match negative == all_negative {
                true => Operation::Add(total, term),
                false => Operation::Subtract(total, term),
            })
        });
        (total, all_negative)
    }

    /// Finds two terms (p cos x)² and (p sin x)². Returns their indices, and p².
    fn circle(&self, terms: &[SignedProduct]) -> Option<(usize, usize, Vec<Register>)> {
        let arms: Vec<_> = terms.iter().map(|term| self.arm(term)).collect();
        for (i, first) in arms.iter().enumerate() {
            let Some((radius, Function::Cos, angle)) = first else { continue };
            let partner = Some((radius.clone(), Function::Sin, *angle));
            for (j, second) in arms.iter().enumerate() {
                if *second == partner && terms[i].negative == terms[j].negative {
                    return Some((i, j, [&radius[..], radius].concat()));
                }
            }
        }
        None
    }

    /// Splits a term (p cos x)² or (p sin x)² into p, the function, and x.
    fn arm(&self, term: &SignedProduct) -> Option<(Vec<Register>, Function, Register)> {
        let [x, y] = term.factors[..] else { return None };
        let operation = |register: Register| self.old.operations[register.index()];
        let circular = |register| match operation(register) {
            Operation::Function(function @ (Function::Sin | Function::Cos), angle) => Some((function, angle)),
            _ => None,
        };
        if x != y {
            return None;
        }
        if let Some((function, angle)) = circular(x) {
            return Some((Vec::new(), function, angle));
        }
        let Operation::Multiply(p, q) = operation(x) else { return None };
        let (radius, (function, angle)) =
            circular(q).map(|found| (p, found)).or_else(|| circular(p).map(|found| (q, found)))?;
        Some((vec![radius], function, angle))
    }
}

/// Factor that most terms share; among equals, the first.
fn most_shared(terms: &[SignedProduct]) -> Option<Register> {
    let mut counts: IndexMap<Register, usize> = IndexMap::new();
    for term in terms {
        let mut factors = term.factors.clone();
        factors.dedup();
        factors.into_iter().for_each(|factor| *counts.entry(factor).or_default() += 1);
    }
    let most = counts.values().copied().max().filter(|&most| most > 1)?;
    counts.into_iter().find(|&(_, count)| count == most).map(|(factor, _)| factor)
}
