//! Checks that passes keep the results, by evaluating random programs before and after.

use super::split::{TwoParts, split};
use super::{Program, factors, fuse, guard, reciprocals, signs};
use crate::codegen::operation::{Operation, Register};
use crate::codegen::schedule::Schedule;
use crate::symbolic::{Function, Symbol};
use crate::variables::Variable;
use lagrange_random::{Random, cases};

/// Evaluates the results; input k has the value 0.3 + 0.1 k.
fn values(schedule: &Schedule, results: &[Register]) -> Vec<f64> {
    schedule.values(results, |symbol| 0.3 + 0.1 * f64::from(symbol.index))
}

/// Random program, mostly sums and products of few inputs, so that terms share factors.
fn program(random: &mut Random) -> (Schedule, Vec<Register>) {
    let mut schedule = Schedule::default();
    let mut registers: Vec<Register> =
        (0..4).map(|index| schedule.push(Operation::Input(Symbol { family: 1, index }))).collect();
    registers.push(schedule.constant(-2.0));
    for _ in 0..60 {
        let (x, y) = (registers[random.below(registers.len())], registers[random.below(registers.len())]);
        let operation = match random.below(16) {
            0 => Operation::Negate(x),
            1..=5 => Operation::Add(x, y),
            6..=8 => Operation::Subtract(x, y),
            9..=13 => Operation::Multiply(x, y),
            14 => Operation::Divide(x, registers[random.below(4)]),
            _ => Operation::Function(
                if y < x { Function::Sin } else { Function::Cos },
                registers[random.below(4)],
            ),
        };
        registers.push(schedule.push(operation));
    }
    let results = (0..6).map(|_| registers[random.below(registers.len())]).collect();
    (schedule, results)
}

fn input(schedule: &mut Schedule, index: u32) -> Register {
    schedule.push(Operation::Input(Symbol { family: 1, index }))
}

#[test]
fn signs_change_no_value() {
    let mut random = Random(1);
    for _ in 0..cases([100, 500, 5_000]) {
        let (schedule, results) = program(&mut random);
        let (new, new_results) = signs::gathered(&schedule, &results);
        let (before, after) = (values(&schedule, &results), values(&new, &new_results));
        assert!(
            before.iter().zip(&after).all(|(x, y)| x == y || x.is_nan() && y.is_nan()),
            "{before:?} {after:?}"
        );
        assert!(new.count(&new_results).arithmetic <= schedule.count(&results).arithmetic + results.len());
    }
}

#[test]
fn no_pass_changes_a_result_beyond_rounding_nor_leaves_more_to_do() {
    let mut random = Random(2);
    for _ in 0..cases([250, 2_000, 20_000]) {
        let (schedule, results) = program(&mut random);
        for pass in [factors::taken_out, reciprocals::shared, fuse::fused] {
            let (new, new_results) = pass(&schedule, &results);
            let (before, after) = (values(&schedule, &results), values(&new, &new_results));
            // Skip results near zero: after cancellation they have fewer digits.
            for (x, y) in before.iter().zip(&after).filter(|(x, _)| x.is_finite() && x.abs() > 1e-6) {
                assert!((x - y).abs() <= 1e-9 * x.abs(), "{before:?} {after:?}");
            }
        }
        let before = schedule.time(&results).work;
        assert!(Program::new(schedule, results).time().work <= before);
    }
}

#[test]
fn a_negative_is_carried_into_the_sum_that_takes_it() {
    let mut schedule = Schedule::default();
    let [x, y, z] = [0, 1, 2].map(|index| input(&mut schedule, index));
    // z + (−x) y and −(x y) − z
    let negative = schedule.push(Operation::Negate(x));
    let product = schedule.push(Operation::Multiply(negative, y));
    let first = schedule.push(Operation::Add(z, product));
    let second = schedule.push(Operation::Subtract(product, z));
    let (new, results) = signs::gathered(&schedule, &[first, second]);
    // x y, z − x y, x y + z and one negation.
    assert_eq!(new.count(&results).arithmetic, 4);
    assert_eq!(schedule.count(&[first, second]).arithmetic, 4);
    let (new, results) = signs::gathered(&schedule, &[first]);
    assert_eq!(new.count(&results).arithmetic, 2);
}

#[test]
fn the_factor_that_most_terms_share_goes_first() {
    let mut schedule = Schedule::default();
    let [a, b, c, d] = [0, 1, 2, 3].map(|index| input(&mut schedule, index));
    // a b c + a b d − a d + c
    let products = [[a, b, c], [a, b, d]].map(|[x, y, z]| {
        // Use separate products, so that none is shared already.
        let product = schedule.push(Operation::Multiply(x, z));
        schedule.push(Operation::Multiply(product, y))
    });
    let sum = schedule.push(Operation::Add(products[0], products[1]));
    let product = schedule.push(Operation::Multiply(a, d));
    let sum = schedule.push(Operation::Subtract(sum, product));
    let sum = schedule.push(Operation::Add(sum, c));
    let (new, results) = factors::taken_out(&schedule, &[sum]);
    let [before, after] = [values(&schedule, &[sum])[0], values(&new, &results)[0]];
    assert!((before - after).abs() < 1e-15);
    // a d has two uses and stays: (b (a c + a d) − a d) + c. The factors b and a c occur equally often.
    assert!(new.count(&results).arithmetic < schedule.count(&[sum]).arithmetic);
}

#[test]
fn sine_and_cosine_squared_are_one() {
    let mut schedule = Schedule::default();
    let [angle, radius, mass] = [0, 1, 2].map(|index| input(&mut schedule, index));
    let squares = [Function::Sin, Function::Cos].map(|function| {
        let value = schedule.push(Operation::Function(function, angle));
        let arm = schedule.push(Operation::Multiply(radius, value));
        let moment = schedule.push(Operation::Multiply(mass, arm));
        schedule.push(Operation::Multiply(moment, arm))
    });
    let sum = schedule.push(Operation::Add(squares[0], squares[1]));
    let (new, results) = factors::taken_out(&schedule, &[sum]);
    let count = new.count(&results);
    assert_eq!((count.arithmetic, count.functions), (2, 0), "m r²");
    assert!((values(&new, &results)[0] - 0.5 * 0.4 * 0.4).abs() < 1e-15);
}

#[test]
fn divisions_by_the_same_share_a_reciprocal() {
    let mut schedule = Schedule::default();
    let [x, y, z] = [0, 1, 2].map(|index| input(&mut schedule, index));
    let results = [x, y].map(|x| schedule.push(Operation::Divide(x, z)));
    let (new, results) = reciprocals::shared(&schedule, &results);
    let divisions =
        new.operations.iter().filter(|operation| matches!(operation, Operation::Divide(..))).count();
    assert_eq!((divisions, new.count(&results).arithmetic), (1, 3));
    let alone = schedule.push(Operation::Divide(x, y));
    let (new, results) = reciprocals::shared(&schedule, &[alone]);
    assert_eq!(new.count(&results).arithmetic, 1);
}

#[test]
fn what_is_constant_is_computed_at_once() {
    let mut schedule = Schedule::default();
    let x = input(&mut schedule, 0);
    let [two, half] = [2.0, 0.5].map(|value| schedule.constant(value));
    let one = schedule.push(Operation::Multiply(two, half));
    assert_eq!(schedule.push(Operation::Multiply(x, one)), x);
    assert_eq!(schedule.push(Operation::Divide(x, one)), x);
    let reciprocal = schedule.push(Operation::Divide(one, two));
    assert_eq!(reciprocal, half);
    let zero = schedule.constant(0.0);
    let poison = schedule.push(Operation::Multiply(zero, x));
    assert!(matches!(schedule.operations[poison.index()], Operation::Multiply(..)), "0 x shows what x is");
    let infinite = schedule.push(Operation::Divide(one, zero));
    assert!(matches!(schedule.operations[infinite.index()], Operation::Divide(..)), "no literal is infinite");
}

#[test]
fn a_product_is_fused_with_the_only_sum_that_uses_it() {
    let mut schedule = Schedule::default();
    let [x, y, z] = [0, 1, 2].map(|index| input(&mut schedule, index));
    let shared = schedule.push(Operation::Multiply(x, y));
    let own = schedule.push(Operation::Multiply(y, z));
    let results = [schedule.push(Operation::Add(shared, z)), schedule.push(Operation::Subtract(shared, own))];
    let (new, new_results) = fuse::fused(&schedule, &results);
    let of_result = |result: Register| new.operations[result.index()];
    assert!(matches!(of_result(new_results[0]), Operation::Add(..)), "x y is used twice");
    assert!(matches!(of_result(new_results[1]), Operation::SubtractProduct(..)));
    assert_eq!(values(&new, &new_results), values(&schedule, &results));
    assert_eq!(new.count(&new_results), schedule.count(&results), "fused operations count for two");
}

#[test]
fn differences_of_products_are_not_fused() {
    let mut schedule = Schedule::default();
    let [x, y] = [0, 1].map(|index| input(&mut schedule, index));
    let squares = [x, y].map(|x| schedule.push(Operation::Multiply(x, x)));
    let difference = schedule.push(Operation::Subtract(squares[0], squares[1]));
    let (new, results) = fuse::fused(&schedule, &[difference]);
    assert!(matches!(new.operations[results[0].index()], Operation::Subtract(..)));
}

/// d√x + dy: at x = 0 the slope of √x is infinite, and must not affect dy.
#[test]
fn a_slope_that_does_not_exist_counts_only_where_something_changes() {
    let mut schedule = Schedule::default();
    let x = input(&mut schedule, 0);
    let changes = [0, 1].map(|i| schedule.push(Operation::Input(Variable::Change(i).symbol())));
    let root = schedule.push(Operation::SquareRoot(x));
    let rate = schedule.push(Operation::Divide(changes[0], root));
    let sum = schedule.push(Operation::Add(rate, changes[1]));
    let (new, results) = guard::guarded(&schedule, &[sum], &[root]);
    let value = |schedule: &Schedule, results: &[Register], x: f64, changes: [f64; 2]| {
        schedule.values(results, |symbol| match Variable::of(symbol) {
            Variable::Change(i) => changes[i],
            _ => x,
        })[0]
    };
    assert!(value(&schedule, &[sum], 0.0, [0.0, 2.0]).is_nan());
    assert_eq!(value(&new, &results, 0.0, [0.0, 2.0]), 2.0);
    assert_eq!(value(&new, &results, 4.0, [3.0, 2.0]), 3.5);
    assert_eq!(value(&new, &results, 0.0, [1.0, 2.0]), f64::INFINITY);
}

/// dx/x²: at x = 0, 1/x is infinite, so nothing is lost; the residuals 1/(1/x) and atan(1/x) stay finite.
#[test]
fn a_slope_is_guarded_unless_the_residual_is_infinite_with_it() {
    let guards = |residual: fn(&mut Schedule, Register, Register) -> Register| {
        let mut schedule = Schedule::default();
        let x = input(&mut schedule, 0);
        let one = schedule.push(Operation::Constant(1.0_f64.to_bits()));
        let residual = residual(&mut schedule, x, one);
        let square = schedule.push(Operation::Multiply(x, x));
        let change = schedule.push(Operation::Input(Variable::Change(0).symbol()));
        let rate = schedule.push(Operation::Divide(change, square));
        let (new, _) = guard::guarded(&schedule, &[rate], &[residual]);
        new.operations.iter().filter(|operation| matches!(operation, Operation::Where(..))).count()
    };
    let inverse = |schedule: &mut Schedule, x, one| schedule.push(Operation::Divide(one, x));
    assert_eq!(guards(inverse), 0);
    assert_eq!(
        guards(|schedule, x, one| {
            let inverse = schedule.push(Operation::Divide(one, x));
            let product = schedule.push(Operation::Multiply(inverse, x));
            let negative = schedule.push(Operation::Negate(product));
            schedule.push(Operation::Subtract(one, negative))
        }),
        0
    );
    assert_eq!(guards(|_, x, _| x), 1);
    assert_eq!(
        guards(|schedule, x, one| {
            let inverse = schedule.push(Operation::Divide(one, x));
            schedule.push(Operation::Divide(one, inverse))
        }),
        1
    );
    assert_eq!(
        guards(|schedule, x, one| {
            let inverse = schedule.push(Operation::Divide(one, x));
            schedule.push(Operation::Function(Function::Atan, inverse))
        }),
        1
    );
}

/// xʸ dx: xʸ is finite where a residual x + xʸ is, and may be infinite where atan(xʸ) is finite.
#[test]
fn a_factor_is_guarded_unless_the_residual_is_infinite_with_it() {
    let guards = |residual: fn(&mut Schedule, Register, Register) -> Register| {
        let mut schedule = Schedule::default();
        let [x, y] = [0, 1].map(|index| input(&mut schedule, index));
        let power = schedule.push(Operation::Power(x, y));
        let residual = residual(&mut schedule, x, power);
        let change = schedule.push(Operation::Input(Variable::Change(0).symbol()));
        let rate = schedule.push(Operation::Multiply(power, change));
        let (new, _) = guard::guarded(&schedule, &[rate], &[residual]);
        new.operations.iter().filter(|operation| matches!(operation, Operation::Where(..))).count()
    };
    assert_eq!(guards(|schedule, x, power| schedule.push(Operation::Add(x, power))), 0);
    assert_eq!(guards(|schedule, _, power| schedule.push(Operation::Function(Function::Atan, power))), 1);
}

/// a b dx − (a b dy)/c + sin(a) (b dx): the coefficients are formed first, and each multiplies a rate once.
#[test]
fn what_does_not_depend_on_a_direction_is_computed_apart() {
    let mut schedule = Schedule::default();
    let [a, b, c] = [0, 1, 2].map(|index| input(&mut schedule, index));
    let [dx, dy] = [0, 1].map(|i| schedule.push(Operation::Input(Variable::Change(i).symbol())));
    let push = |schedule: &mut Schedule, operation| schedule.push(operation);
    let in_x = push(&mut schedule, Operation::Multiply(b, dx));
    let first = push(&mut schedule, Operation::Multiply(a, in_x));
    let in_y = push(&mut schedule, Operation::Multiply(b, dy));
    let second = push(&mut schedule, Operation::Multiply(in_y, a));
    let second = push(&mut schedule, Operation::Negate(second));
    let second = push(&mut schedule, Operation::Divide(second, c));
    let sine = push(&mut schedule, Operation::Function(Function::Sin, a));
    let third = push(&mut schedule, Operation::Multiply(sine, in_x));
    let sum = push(&mut schedule, Operation::Add(first, second));
    let sum = push(&mut schedule, Operation::Add(sum, third));
    let TwoParts { slopes: (numbers, slopes), changes: (changes, results), .. } = split(&schedule, &[sum]);
    let value = |symbol| match Variable::of(symbol) {
        Variable::Change(i) => [5.0, 7.0][i],
        _ => 0.3 + 0.1 * f64::from(symbol.index),
    };
    let found = numbers.values(&slopes, value);
    assert_eq!(found.len(), 4, "a b, − a b, c and b sin a");
    let whole = schedule.values(&[sum], value)[0];
    let by_slopes = changes.values(&results, |symbol| match Variable::of(symbol) {
        Variable::Slope(k) => found[k],
        _ => value(symbol),
    });
    assert!((by_slopes[0] - whole).abs() < 1e-15 * whole.abs(), "{by_slopes:?} for {whole}");
    assert_eq!(changes.count(&results).total(), 6, "three products, a quotient and two sums");
    assert_eq!(numbers.count(&slopes).total(), 4, "a b, its negative, sin a and b sin a");
}
