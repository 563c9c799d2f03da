//! What it costs to watch for events, and whether all are found: Poincaré sections of Hénon and Heiles' potential.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p lagrange-benches --bench events`
//!
//! What is compared is timed in turn, so that what disturbs one disturbs the other; of 21 rounds each the least time counts.

use std::hint::black_box;
use std::time::Instant;

use lagrange_core::{Crossing, StateOf, nalgebra::Const, prelude::*};
use lagrange_systems::HenonHeiles;

/// A pendulum in Cartesian coordinates.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - y)]
#[constraint(rod: (x^2 + y^2 - 1)/2 = 0)]
struct Rod;

fn is_test() -> bool {
    std::env::args().any(|argument| argument == "--test")
}

/// The least time in seconds that each takes, in turn.
fn in_turn<const K: usize>(work: [&dyn Fn(); K]) -> [f64; K] {
    let mut least = [f64::MAX; K];
    for _ in 0..if is_test() { 1 } else { 21 } {
        for (least, work) in least.iter_mut().zip(work) {
            let start = Instant::now();
            work();
            *least = least.min(start.elapsed().as_secs_f64());
        }
    }
    least
}

/// On x = 0 with the energy 1/12, where motions are regular.
fn start() -> State<f64, 2> {
    let (y, y_dot) = (0.1_f64, 0.1_f64);
    let kinetic = 1.0 / 12.0 - (y * y / 2.0 - y.powi(3) / 3.0) - y_dot * y_dot / 2.0;
    State::new([0.0, y], [(2.0 * kinetic).sqrt(), y_dot])
}

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-12).max_steps(100_000_000)
}

/// Runs with an event over runs without, both stored; and the iterator over crossings, which stores nothing.
fn cost<L>(name: &str, system: L, start: StateOf<L>, end: f64)
where
    L: Lagrangian<Scalar = f64> + Copy,
{
    let plain = || {
        black_box(system.integrate(start, end, method()).expect("a motion").end().state().q[0]);
    };
    let by = |pieces: usize| {
        let mut section = system.event("section", |s| s.state().q[0]).rising().subdivide(pieces);
        let path = system.motion(start).by(method()).event(&mut section).towards(end).expect("a start");
        black_box(path.crossings().len());
    };
    let silent = || {
        let mut never = system.event("never", |s| s.state().q[0] + 10.0);
        let path = system.motion(start).by(method()).event(&mut never).towards(end).expect("a start");
        black_box(path.crossings().len());
    };
    let iterated = || {
        let mut section = system.event("section", |s| s.state().q[0]).rising();
        let mut motion = Motion::new(system, start, method()).expect("a start");
        black_box(motion.crossings(end, &mut [&mut section]).count());
    };
    let [plain, silent, usual, eight, iterated] = in_turn([&plain, &silent, &|| by(1), &|| by(8), &iterated]);
    println!(
        "{name:14} with an event that never fires {:.3} of the time without, with a section {:.3}, in 8 pieces a step {:.3}; crossings alone {:.3}",
        silent / plain,
        usual / plain,
        eight / plain,
        iterated / plain
    );
}

/// All crossings, the largest |x| there as a part of the round-off of the largest within a step, and the last time.
fn section(count: usize, method: Dop853) -> (Vec<Crossing<f64, Const<2>>>, f64) {
    let mut section = HenonHeiles.event("section", |s| s.state().q[0]).rising();
    let mut motion = Motion::new(HenonHeiles, start(), method).expect("a start");
    let found: Result<Vec<_>, _> = motion.crossings(1e9, &mut [&mut section]).take(count).collect();
    let found = found.expect("a motion");
    // Within a step of 0.1 or more, x moves by more than a twentieth of its velocity.
    let part = |crossing: &Crossing<f64, Const<2>>| {
        let State { q, v, .. } = crossing.state;
        q[0].abs() / (f64::EPSILON * 0.05 * v[0].abs())
    };
    let worst = found.iter().map(part).fold(0.0, f64::max);
    (found, worst)
}

fn main() {
    let end = if is_test() { 100.0 } else { 3000.0 };
    cost("Hénon-Heiles", HenonHeiles, start(), end);
    cost("pendulum, rod", Rod, State::new([0.6, -0.8], [0.8, 0.6]), end / 3.0);
    let count = if is_test() { 20 } else { 10_000 };
    let (found, worst) = section(count, method());
    let (fine, _) = section(count, method().max_step(0.015));
    let last = |crossings: &[Crossing<f64, Const<2>>]| crossings.last().map_or(f64::NAN, |last| last.state.t);
    println!(
        "{} crossings up to t = {}; with a tenth of the step up to {}; largest |g| {worst:.2} units of round-off",
        found.len(),
        last(&found),
        last(&fine)
    );
}
