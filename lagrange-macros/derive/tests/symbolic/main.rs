//! `lagrange-symbolic`: properties of the graph on random expressions, each checked against an independent computation.
//!
//! The tests stand here since all that stands in the package itself is optimised, which takes them half a minute more to
//! compile.

mod antiderivative;
mod bounds;
mod canonical;
mod combined;
mod derivatives;
mod double;
mod elimination;
mod external;
mod faults;
mod fractions;
mod functions;
mod nested;
mod polynomial;
mod rationals;
mod rounded;
mod sample;
mod tree;
mod values;
mod waves;
mod zero;

use std::cell::Cell;
use std::fmt::Debug;

use lagrange_random::cases;
use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngSeed, TestCaseError, TestRunner};

use lagrange_symbolic::{Approximate, Graph, Id, Rational, Symbol, drawn};

/// Draws the value of each symbol from this range.
fn within(range: (f64, f64)) -> impl Fn(Symbol, u64) -> Approximate {
    move |symbol, draw| Approximate::exact(drawn(symbol, range, draw))
}

/// Outcome of one random case.
enum Outcome {
    Checked,
    /// Outside the domain, or too ill-conditioned for a comparison.
    Skipped,
}

/// Runs `property` on `count` random values at the level `run`, on an eighth and on ten times as many at the levels below
/// and above. They are the same in every run unless `PROPTEST_RNG_SEED` is set. At least the fraction `share` of them
/// must not be skipped.
fn for_all<T: Debug>(
    count: usize,
    share: f64,
    strategy: impl Strategy<Value = T>,
    property: impl Fn(T) -> Result<Outcome, TestCaseError>,
) {
    let cases = cases([count / 8, count, 10 * count]) as u32;
    let mut config = Config { failure_persistence: None, cases, ..Config::default() };
    if std::env::var_os("PROPTEST_RNG_SEED").is_none() {
        config.rng_seed = RngSeed::Fixed(1687);
    }
    let (runs, checked) = (Cell::new(0), Cell::new(0));
    let result = TestRunner::new(config).run(&strategy, |value| {
        runs.set(runs.get() + 1);
        if let Outcome::Checked = property(value)? {
            checked.set(checked.get() + 1);
        }
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    let (runs, checked) = (runs.get(), checked.get());
    assert!(f64::from(checked) >= share * f64::from(runs), "only {checked} of {runs} cases could be checked");
}

/// Value of a number.
fn value(graph: &Graph, number: Id) -> f64 {
    graph.evaluate(number, |_| f64::NAN).value
}

fn symbol(index: usize) -> Symbol {
    Symbol { family: 0, index: index as u32 }
}

fn rational(numerator: i128, denominator: i128) -> Rational {
    Rational::new(numerator, denominator)
}

/// A graph with the symbols x, y and z.
fn graph() -> (Graph, [Id; 3]) {
    let mut graph = Graph::default();
    let symbols = [0, 1, 2].map(|index| graph.symbol(symbol(index)));
    (graph, symbols)
}

/// Looks up the value of a symbol in a point.
fn at(point: &[f64]) -> impl Fn(Symbol) -> f64 + Copy + '_ {
    |symbol| point[symbol.index as usize]
}
