//! Double pendulums on SIMD lanes against the same one by one, on one thread.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p lagrange-benches --bench ensemble`
//!
//! The two are timed in turn, so that what disturbs one disturbs the other; the least of the times counts.

use std::hint::black_box;
use std::time::Instant;

use lagrange_core::motion::{Adaptive, Pair};
use lagrange_core::prelude::*;
use lagrange_core::{Lanes, Pack, nalgebra::Const};
use lagrange_systems::DoublePendulum;

const PENDULUM: DoublePendulum<f64> = DoublePendulum { m: [1.0; 2], l: [1.0; 2], g: 9.81 };

/// The least time in nanoseconds that each takes, of so many rounds in turn.
fn in_turn<A, B>(rounds: usize, first: impl Fn() -> A, second: impl Fn() -> B) -> [f64; 2] {
    let mut least = [f64::MAX; 2];
    for _ in 0..rounds {
        least = [least[0].min(time(&first)), least[1].min(time(&second))];
    }
    least
}

fn time<R>(work: impl Fn() -> R) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64() * 1e9
}

/// Numbers in (−2, 2), always the same.
fn random(count: usize) -> Vec<f64> {
    let mut seed = 7_u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 * 4.0 - 2.0
    };
    (0..count).map(|_| next()).collect()
}

fn evaluate<L: Lagrangian<N = Const<2>>>(system: &L, states: &[State<L::Scalar, 2>]) {
    for state in states {
        black_box(black_box(system).accelerations_unchecked(black_box(state)));
    }
}

/// Eight evaluations, one after the other and on lanes.
fn accelerations() {
    const REPEATS: usize = 20_000;
    let numbers = random(32);
    let states: [State<f64, 2>; 8] = std::array::from_fn(|k| {
        let at = |entry: usize| numbers[4 * k + entry];
        State::new([at(0), at(1)], [at(2), at(3)])
    });
    let side_by_side = |states: &[State<f64, 2>; Lanes::COUNT]| {
        let entry = |pick: &dyn Fn(&State<f64, 2>) -> f64| {
            Lanes::from(std::array::from_fn(|lane| pick(&states[lane])))
        };
        State::new([entry(&|s| s.q[0]), entry(&|s| s.q[1])], [entry(&|s| s.v[0]), entry(&|s| s.v[1])])
    };
    let packed_states: Vec<_> = states.as_chunks::<{ Lanes::COUNT }>().0.iter().map(side_by_side).collect();
    let packed = PENDULUM.pack();
    let [scalar, lanes] = in_turn(
        200,
        || (0..REPEATS).for_each(|_| evaluate(&PENDULUM, &states)),
        || (0..REPEATS).for_each(|_| evaluate(&packed, &packed_states)),
    );
    let each = |time: f64| time / REPEATS as f64;
    println!(
        "8 accelerations   one by one {:7.1} ns   on lanes {:7.1} ns   ratio {:.2}",
        each(scalar),
        each(lanes),
        scalar / lanes
    );
}

/// Random angles, at rest, to t = 10, at a relative and absolute tolerance of 10⁻⁹.
fn motions() {
    const COUNT: usize = 2000;
    let angles = random(2 * COUNT);
    let ensemble =
        || Ensemble::from_fn(COUNT, |k| (PENDULUM, State::at_rest([angles[2 * k], angles[2 * k + 1]])));
    let [scalar, lanes] = in_turn(
        5,
        || ensemble().integrate(10.0, Dop853::default()),
        || ensemble().integrate_on_lanes(10.0, Dop853::default()),
    );
    let rate = |time: f64| COUNT as f64 / time * 1e9;
    println!(
        "motions a second  one by one {:7.0}      on lanes {:7.0}      ratio {:.2}",
        rate(scalar),
        rate(lanes),
        scalar / lanes
    );
}

/// 10⁵ of them, with a hundred samples each and without.
fn samples<P: Pair>(name: &str, method: Adaptive<P>)
where
    Adaptive<P>: Copy + Sync,
{
    const COUNT: usize = 100_000;
    let angles = random(2 * COUNT);
    let ensemble =
        || Ensemble::from_fn(COUNT, |k| (PENDULUM, State::at_rest([angles[2 * k], angles[2 * k + 1]])));
    let times = || (1..=100).map(|k| 0.1 * f64::from(k));
    let [plain, sampled] = in_turn(
        3,
        || ensemble().integrate_on_lanes(10.0, method),
        || ensemble().samples_at(times()).integrate_on_lanes(10.0, method),
    );
    println!(
        "10^5, {name:10}  ends only  {:7.2} s    100 samples {:6.2} s    ratio {:.2}",
        plain / 1e9,
        sampled / 1e9,
        sampled / plain
    );
}

fn main() {
    accelerations();
    motions();
    samples("Dop853 1e-9", Dop853::default());
    samples("Dopri5 1e-6", Dopri5::with_tolerance(1e-6));
}
