//! Random systems: compares the accelerations and multipliers of the emitted code with an oracle. The oracle
//! differentiates the Lagrangian as written, by nilpotent numbers of twice the precision, and solves by Gaussian
//! elimination.
//!
//! The oracle neither differentiates symbolically nor simplifies. It shares with the emitted code only the source
//! and the values of time, coordinates, velocities and parameters. `LAGRANGE_FUZZ_SECONDS` sets the duration of the
//! test, `LAGRANGE_FUZZ_SEED` the first seed.

#[expect(dead_code, reason = "a module of lagrange-symbolic, which has more uses for it")]
#[path = "../../tests/symbolic/double.rs"]
mod double;
mod draft;
mod drawing;
mod here;
mod jet;
mod language;
mod oracle;
mod pen;
mod points;
mod space;

use super::equations;
use crate::codegen::solutions_by;
use crate::resolve::Problem;
use crate::symbolic::Symbol;
use crate::variables::Variable;
use draft::Draft;
use here::Here;
use jet::Jet;
use lagrange_random::{Random, rounds};
use oracle::Solution;

/// Factor by which an error may exceed the bound of the oracle: a bit more than one digit. That bound holds for
/// elimination from the top of the matrix down. The emitted code eliminates in other orders and has other expressions for the
/// same entries. Where it reports a pivot below 1/16, an error may exceed the bound by 1/pivot: so many digits cancel.
const ROOM: f64 = 16.0;

/// Smallest trusted pivot. With a smaller one, less than two thirds of the digits are left: the emitted code gives
/// no number, and the general elimination takes over.
const TRUSTED: f64 = 6e-6;

/// Largest relative error bound at which a comparison can detect an error.
const TELLING: f64 = 1e-6;

#[derive(Default, Debug)]
struct Tally {
    systems: usize,
    states: usize,
    /// States without a comparison, because rounding may change any digit.
    untold: usize,
    /// Solutions that the emitted code rejects, so that the general elimination takes over.
    doubted: usize,
    /// Largest errors, relative to their bounds and relative to the largest entry.
    worst: f64,
    worst_relative: f64,
}

#[test]
fn the_accelerations_are_those_of_the_lagrangian_as_it_is_written() {
    let mut tally = Tally::default();
    rounds("systems", [15, 40, 10_000], |random| checked(random, &mut tally));
    println!("{tally:?}");
    let told = tally.states - tally.untold.max(tally.doubted);
    assert!(tally.systems < 40 || 10 * told > 9 * tally.states, "too little is told");
}

fn checked(random: &mut Random, tally: &mut Tally) {
    let draft = Draft::new(random);
    let source = draft.source();
    let (graph, problem, equations) = equations(&source);
    tally.systems += 1;
    for _ in 0..3 {
        let (time, numbers) = draft.numbers(random);
        let here = Here::new(time, &numbers[0], &numbers[1], &numbers[2]);
        tally.states += 1;
        let Some(expected) = oracle::solve(&draft, &here).filter(is_telling) else {
            tally.untold += 1;
            continue;
        };
        let input = |symbol| input(time, &numbers, &draft, &problem, symbol);
        let found = solutions_by(&graph, &equations, input, |function, by, arguments, output| {
            supplied(&draft, function, by, arguments, output)
        });
        assert!(found.iter().any(Option::is_some), "left to loops:\n{source}");
        let what = format!("at t = {time}, {numbers:?}\n{source}");
        for entries in found.iter().flatten() {
            match entries.split_last() {
                Some((pivot, entries)) if *pivot > TRUSTED => {
                    compare(entries, ROOM.max(1.0 / pivot), &expected, tally, &what);
                }
                _ => tally.doubted += 1,
            }
        }
    }
}

/// Returns true for finite values whose rounding errors are small enough for a comparison.
fn is_telling(solution: &Solution) -> bool {
    let largest = largest(solution);
    largest.is_finite() && solution.bounds.iter().all(|bound| ROOM * bound <= TELLING * largest)
}

fn largest(solution: &Solution) -> f64 {
    solution.values.iter().fold(1.0_f64, |largest, x| largest.max(x.to_f64().abs()))
}

fn compare(entries: &[f64], room: f64, expected: &Solution, tally: &mut Tally, what: &str) {
    assert_eq!(entries.len(), expected.values.len());
    for (k, (&found, (value, bound))) in
        entries.iter().zip(expected.values.iter().zip(&expected.bounds)).enumerate()
    {
        let off = value.distance(found);
        assert!(
            off <= room * bound,
            "entry {k} is {found:e}, not {:e}: {:.1} times the bound {bound:e}; {what}",
            value.to_f64(),
            off / bound
        );
        tally.worst = tally.worst.max(off / bound.max(f64::MIN_POSITIVE));
        tally.worst_relative = tally.worst_relative.max(off / largest(expected));
    }
}

fn input(
    time: f64,
    [coordinates, velocities, parameters]: &[Vec<f64>; 3],
    draft: &Draft,
    problem: &Problem,
    symbol: Symbol,
) -> f64 {
    match Variable::of(symbol) {
        Variable::Time => time,
        Variable::Coordinate(i) => coordinates[i],
        Variable::Velocity(i) => velocities[i],
        Variable::Parameter(k) => {
            let name = problem.parameters.name(k);
            parameters[draft.names.iter().position(|known| *known == name).expect("a number of a field")]
        }
        other => panic!("the solution depends on {other:?}"),
    }
}

/// Returns a result of a user-supplied function, or its partial derivative by the arguments `by`.
fn supplied(draft: &Draft, function: u32, by: &[u32], arguments: &[f64], output: u32) -> f64 {
    let mut arguments: Vec<Jet> = arguments.iter().copied().map(Jet::number).collect();
    for (epsilon, &position) in (0..).zip(by) {
        // Give every argument this ε, so that all jets have the same length.
        for (k, argument) in arguments.iter_mut().enumerate() {
            let rate = if k == position as usize { 1.0 } else { 0.0 };
            *argument = argument.moved(&Jet::number(rate), epsilon);
        }
    }
    let here = Here::new(0.0, &[], &[], &[]).with_arguments(arguments);
    let value = draft.supplied[function as usize].results[output as usize].value(draft, &here);
    value.coefficient(by.len() as u32).value.to_f64()
}
