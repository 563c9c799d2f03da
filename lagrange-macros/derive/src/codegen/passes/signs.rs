//! Collects signs: the sign of −x is carried along until a sum absorbs it at no cost. The results are exact except
//! for the sign of zero, because rounding does not depend on signs.

use super::rewrite::{carried_over, carry_definitions};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;

/// Register and sign of a number; `true` if the number is the negative of the register.
pub(super) type Signed = (Register, bool);

pub(super) fn gathered(old: &Schedule, results: &[Register]) -> (Schedule, Vec<Register>) {
    let uses = old.uses(results);
    let mut new = Schedule::default();
    let mut places: Vec<Option<Signed>> = vec![None; old.operations.len()];
    for (index, &operation) in old.operations.iter().enumerate().filter(|(index, _)| uses[*index] > 0) {
        places[index] = Some(signed(&mut new, old, operation, &places));
    }
    carry_definitions(&mut new, old, |register| {
        places[register.index()].filter(|(_, negative)| !negative).map(|(place, _)| place)
    });
    let results = results.iter().map(|&result| whole(&mut new, of(&places, result))).collect();
    (new, results)
}

fn of(places: &[Option<Signed>], register: Register) -> Signed {
    places[register.index()].unwrap_or((register, false))
}

/// Returns the signed number as a register.
fn whole(new: &mut Schedule, (register, negative): Signed) -> Register {
    if !negative {
        return register;
    }
    match new.operations[register.index()] {
        Operation::Constant(bits) => new.constant(-f64::from_bits(bits)),
        Operation::Subtract(x, y) => new.push(Operation::Subtract(y, x)),
        _ => new.push(Operation::Negate(register)),
    }
}

fn signed(new: &mut Schedule, old: &Schedule, operation: Operation, places: &[Option<Signed>]) -> Signed {
    let place = |register| of(places, register);
    match operation {
        Operation::Constant(bits) => {
            let value = f64::from_bits(bits);
            (new.constant(value.abs()), value.is_sign_negative())
        }
        Operation::Negate(x) => {
            let (x, negative) = place(x);
            (x, !negative)
        }
        Operation::Add(x, y) => sum(new, place(x), place(y)),
        Operation::Subtract(x, y) => {
            let (y, negative) = place(y);
            sum(new, place(x), (y, !negative))
        }
        Operation::Multiply(x, y) => {
            let ((x, first), (y, second)) = (place(x), place(y));
            (new.push(Operation::Multiply(x, y)), first != second)
        }
        Operation::Divide(x, y) => {
            let ((x, first), (y, second)) = (place(x), place(y));
            (new.push(Operation::Divide(x, y)), first != second)
        }
        _ => (carried_over(new, old, operation, |new, operand| whole(new, place(operand))), false),
    }
}

fn sum(new: &mut Schedule, (x, x_negative): Signed, (y, y_negative): Signed) -> Signed {
    match (x_negative, y_negative) {
        (false, false) => (new.push(Operation::Add(x, y)), false),
        (true, true) => (new.push(Operation::Add(x, y)), true),
        (false, true) => difference(new, x, y),
        (true, false) => difference(new, y, x),
    }
}

/// Returns x − y, or −(y − x) if y − x is already computed.
fn difference(new: &mut Schedule, x: Register, y: Register) -> Signed {
    match new.find(Operation::Subtract(y, x)) {
        Some(register) => (register, true),
        None => (new.push(Operation::Subtract(x, y)), false),
    }
}
