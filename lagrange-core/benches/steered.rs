//! A control loop that changes its input every 10 ms: an acrobot, steered, against loops written by hand over the emitted
//! accelerations.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p lagrange-benches --bench steered`
//!
//! All are timed in turn, so that what disturbs one disturbs the others; the medians of the ratios to the loop by hand count.

use std::hint::black_box;
use std::time::Instant;

use lagrange_core::{Method, prelude::*, runge_kutta_step};

/// Two links with a motor at the elbow; the angles are those of the upper link and of the elbow.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(a, b)]
#[lagrangian(
    (i1 + i2 + m2*l1^2)/2*a_dot^2 + i2/2*(2*a_dot*b_dot + b_dot^2) + m2*l1*lc2*a_dot*(a_dot + b_dot)*cos(b)
        + (m1*lc1 + m2*l1)*g*cos(a) + m2*g*lc2*cos(a + b)
)]
#[force(b: u)]
struct Acrobot {
    m1: f64,
    m2: f64,
    l1: f64,
    lc1: f64,
    lc2: f64,
    i1: f64,
    i2: f64,
    g: f64,
    u: f64,
}

const ACROBOT: Acrobot =
    Acrobot { m1: 1.0, m2: 1.0, l1: 1.0, lc1: 0.5, lc2: 0.5, i1: 0.33, i2: 0.33, g: 9.81, u: 0.0 };

const START: [[f64; 2]; 2] = [[0.3, -0.2], [0.0, 0.0]];
const TICK: f64 = 0.01;
const TICKS: usize = 2000;
const ROUNDS: usize = 101;

type Y = [[f64; 2]; 2];

fn control(q: f64, v: f64) -> f64 {
    -2.0 * q - 0.5 * v
}

#[inline]
fn slope(acrobot: &Acrobot, t: f64, y: &Y) -> Y {
    [y[1], acrobot.accelerations_unchecked(&State::new(y[0], y[1]).at_time(t)).accelerations.into()]
}

/// y + h Σ cᵢ kᵢ.
#[inline]
fn moved<const K: usize>(y: &Y, h: f64, terms: [(f64, &Y); K]) -> Y {
    let sum = |half: usize, i: usize| terms.iter().map(|(c, k)| c * k[half][i]).sum::<f64>();
    std::array::from_fn(|half| std::array::from_fn(|i| y[half][i] + h * sum(half, i)))
}

/// The classical method as one writes it.
fn classical_by_hand() -> f64 {
    let (mut acrobot, mut y) = (black_box(ACROBOT), START);
    for tick in 0..TICKS {
        acrobot.u = control(y[0][1], y[1][1]);
        let (t, h) = (TICK * tick as f64, TICK);
        let a = slope(&acrobot, t, &y);
        let b = slope(&acrobot, t + 0.5 * h, &moved(&y, 0.5 * h, [(1.0, &a)]));
        let c = slope(&acrobot, t + 0.5 * h, &moved(&y, 0.5 * h, [(1.0, &b)]));
        let d = slope(&acrobot, t + h, &moved(&y, h, [(1.0, &c)]));
        y = moved(&y, h / 6.0, [(1.0, &a), (2.0, &b), (2.0, &c), (1.0, &d)]);
    }
    y[0][0]
}

fn classical_function() -> f64 {
    let (mut acrobot, mut state) = (black_box(ACROBOT), State::new(START[0], START[1]));
    for _ in 0..TICKS {
        acrobot.u = control(state.q[1], state.v[1]);
        state = runge_kutta_step(&acrobot, &state, TICK);
    }
    state.q[0]
}

fn steered(method: impl Method<Acrobot>) -> f64 {
    let start = State::new(START[0], START[1]);
    let mut motion = Motion::new(black_box(ACROBOT), start, method).expect("a start");
    for tick in 1..=TICKS {
        motion.system_mut().u = control(motion.state().q[1], motion.state().v[1]);
        motion.advance_to(TICK * tick as f64).expect("no end before");
    }
    motion.state().q[0]
}

/// The seven evaluations of a step of Dormand and Prince, each where the last one leads, and nothing else.
fn seven_evaluations() -> f64 {
    let (mut acrobot, mut y) = (black_box(ACROBOT), START);
    for tick in 0..TICKS {
        acrobot.u = control(y[0][1], y[1][1]);
        let t = TICK * tick as f64;
        for _ in 0..7 {
            let slope = slope(&acrobot, t, &y);
            y = moved(&y, TICK / 7.0, [(1.0, &slope)]);
        }
    }
    y[0][0]
}

/// A step of Dormand and Prince as one writes it, by its tables.
fn dopri5_by_hand() -> f64 {
    use lagrange_core::motion::{DormandPrince54 as P, Pair};
    let (mut acrobot, mut y) = (black_box(ACROBOT), START);
    let mut slopes = [[[0.0; 2]; 2]; 7];
    let moved = |y: &Y, slopes: &[Y; 7], row: &[(usize, f64)]| -> Y {
        let sum = |half: usize, i: usize| row.iter().map(|(j, c)| c * slopes[*j][half][i]).sum::<f64>();
        std::array::from_fn(|half| std::array::from_fn(|i| y[half][i] + TICK * sum(half, i)))
    };
    for tick in 0..TICKS {
        acrobot.u = control(y[0][1], y[1][1]);
        let t = TICK * tick as f64;
        slopes[0] = slope(&acrobot, t, &y);
        for (k, row) in P::STAGES.iter().enumerate() {
            let at = moved(&y, &slopes, row);
            slopes[k + 1] = slope(&acrobot, t + TICK * P::NODES[k + 1], &at);
        }
        y = moved(&y, &slopes, P::WEIGHTS);
        slopes[6] = slope(&acrobot, t + TICK, &y);
        black_box(&slopes[6]);
    }
    y[0][0]
}

fn time(work: &dyn Fn() -> f64) -> f64 {
    let start = Instant::now();
    black_box(work());
    start.elapsed().as_secs_f64() * 1e9 / TICKS as f64
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

/// Nanoseconds a tick and the ratio to the first, of each.
fn compare(title: &str, works: &[(&str, &dyn Fn() -> f64)]) {
    let rounds: Vec<Vec<f64>> =
        (0..ROUNDS).map(|_| works.iter().map(|(_, work)| time(work)).collect()).collect();
    println!("{title}");
    for (k, (name, _)) in works.iter().enumerate() {
        let times = median(rounds.iter().map(|round| round[k]).collect());
        let ratio = median(rounds.iter().map(|round| round[k] / round[0]).collect());
        println!("    {name:<24} {times:7.1} ns a tick   ratio {ratio:.3}");
    }
}

fn main() {
    compare(
        "classical Runge–Kutta",
        &[
            ("loop by hand", &classical_by_hand),
            ("runge_kutta_step", &classical_function),
            ("Motion, RungeKutta4", &|| steered(RungeKutta4::with_step(TICK))),
        ],
    );
    compare(
        "Dormand–Prince 5(4), fixed steps",
        &[
            ("seven evaluations", &seven_evaluations),
            ("loop by hand", &dopri5_by_hand),
            ("Motion, Dopri5", &|| steered(Dopri5::default().fixed_step(TICK))),
            ("Motion, Dopri5, adaptive", &|| steered(Dopri5::with_tolerance(1e-6))),
        ],
    );
}
