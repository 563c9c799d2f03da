//! Steps of a chain whose number of masses is known when the program runs, against the same chain of a constant length.
//!
//! `cargo bench -p lagrange-benches --bench lengths`
//!
//! Both are timed in turn; the medians count.

use std::time::Instant;

use lagrange_core::motion::VectorField;
use lagrange_core::{Method, StateOf, System, prelude::*};
use lagrange_systems::{Chain, ChainOf};

const BETA: f64 = 0.7;
const ROUNDS: usize = 41;

/// Returns a function that advances a motion by `span`, and returns the nanoseconds of a step.
fn timed<L, P>(system: L, start: StateOf<L>, span: f64, method: P) -> impl FnMut() -> f64
where
    L: System<Scalar = f64, Field: VectorField<L>>,
    P: Method<L>,
{
    let mut motion = Motion::new(system, start, method).expect("a motion");
    let mut end = 0.0;
    move || {
        let steps = motion.statistics().accepted;
        end += span;
        let begun = Instant::now();
        motion.advance_to(end).expect("its end");
        begun.elapsed().as_secs_f64() * 1e9 / (motion.statistics().accepted - steps) as f64
    }
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn compare<const N: usize, P>(name: &str, span: f64, method: P)
where
    P: Method<Chain> + Method<ChainOf<N>> + Clone,
{
    let mut known_at_run_time = timed(Chain { masses: N, beta: BETA }, Chain::start(N), span, method.clone());
    let mut constant = timed(ChainOf::<N> { beta: BETA }, ChainOf::start(), span, method);
    let (one, other) = (0..ROUNDS).map(|_| (known_at_run_time(), constant())).unzip();
    let [one, other] = [one, other].map(median);
    println!("{name:12} {N:5} masses: {one:9.1} ns, constant {other:9.1} ns, ratio {:.2}", one / other);
}

fn compare_all<const N: usize>(span: f64) {
    compare::<N, _>("Dopri5", span, Dopri5::with_tolerance(1e-6).max_steps(usize::MAX));
    compare::<N, _>("Dop853", span, Dop853::with_tolerance(1e-9).max_steps(usize::MAX));
    compare::<N, _>("RungeKutta4", span, RungeKutta4::with_step(0.02).max_steps(usize::MAX));
    compare::<N, _>("Verlet", span, Verlet::with_step(0.02).max_steps(usize::MAX));
}

fn main() {
    compare_all::<2>(1000.0);
    compare_all::<10>(300.0);
    compare_all::<32>(100.0);
    compare_all::<100>(40.0);
    compare_all::<1000>(4.0);
}
