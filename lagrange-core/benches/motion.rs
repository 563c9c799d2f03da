//! What a motion costs beside its equations.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p lagrange-benches --bench motion [-- PART...]`
//!
//! PART is `rods`, `lanes` or `quaternions`. What is compared is timed in turn, so that what disturbs one disturbs the
//! other; of 21 rounds each the least time counts. "called" is the emitted function behind a call that is not inlined.

#[macro_use]
mod rods;

use std::hint::black_box;
use std::time::Instant;

use lagrange_core::prelude::*;
use lagrange_core::{Lanes, Pack, SolutionOf, StateOf, nalgebra::Const};

/// One is enough to see that it runs.
fn rounds() -> usize {
    if std::env::args().any(|argument| argument == "--test") { 1 } else { 21 }
}

/// The least time in seconds that each takes, in turn.
fn in_turn<const K: usize>(work: [&dyn Fn(); K]) -> [f64; K] {
    let mut least = [f64::MAX; K];
    for _ in 0..rounds() {
        for (least, work) in least.iter_mut().zip(work) {
            let start = Instant::now();
            work();
            *least = least.min(start.elapsed().as_secs_f64());
        }
    }
    least
}

#[inline(never)]
fn called<L: Lagrangian>(system: &L, state: &StateOf<L>) -> SolutionOf<L> {
    system.accelerations_unchecked(state)
}

macro_rules! starts {
    ($($name:ident $n:literal),*) => {$(
        impl $name<f64> {
            const NEW: Self = Self { m: [1.0; $n], l: [1.0; $n], g: 9.81 };

            /// Stretched out at an angle, at rest.
            fn start(angle: f64) -> State<f64, { 2 * $n }> {
                let (sin, cos) = angle.sin_cos();
                let at = |k: usize| if k < $n { cos * (k + 1) as f64 } else { -sin * (k - $n + 1) as f64 };
                State::at_rest(std::array::from_fn::<f64, { 2 * $n }, _>(at))
            }
        }
    )*};
}

rods!(Rods5 5, Rods10 10, Rods20 20, Rods50 50, Rods100 100, Rods200 200);
starts!(Rods5 5, Rods10 10, Rods20 20, Rods50 50, Rods100 100, Rods200 200);

/// Wall time an evaluation of a motion, over one of the emitted function; the cost of a step.
fn rods_of<L>(system: L, start: StateOf<L>, time: f64) -> f64
where
    L: Lagrangian<Scalar = f64> + Copy,
{
    let method = || Dop853::with_tolerance(1e-9);
    let path = system.integrate(start, time, method()).expect("a motion");
    let (steps, tried) =
        (path.statistics().accepted, path.statistics().accepted + path.statistics().rejected);
    let states: Vec<StateOf<L>> = path.samples(12 * tried).map(|sample| *sample.state()).collect();
    let evaluate = || {
        for state in &states {
            black_box(called(black_box(&system), black_box(state)));
        }
    };
    let begun = || {
        black_box(Motion::new(system, start, method()).expect("a start").state().q[0]);
    };
    let passing = || {
        let mut motion = Motion::new(system, start, method()).expect("a start");
        motion.advance_to(time).expect("a motion");
        black_box(motion.state().q[0]);
    };
    let stored = || {
        black_box(system.integrate(start, time, method()).expect("a motion").end().state().q[0]);
    };
    // What the start takes, with the matrices that its check makes, is left out.
    let [one, begun, passing, stored] = in_turn([&evaluate, &begun, &passing, &stored]);
    let (passing, stored) = (passing - begun, stored - begun);
    let (one, each) = (one / (12 * tried) as f64, passing / (12 * tried) as f64);
    let with_extension = stored / (12 * tried + 3 * steps) as f64;
    println!(
        "{:3} rods   accelerations {:8.1} ns   an evaluation of a motion {:5.2} of that, stored {:5.2}   a step {:8.2} us",
        L::COORDINATES.len() / 2,
        1e9 * one,
        each / one,
        with_extension / one,
        1e6 * passing / tried as f64
    );
    passing / tried as f64
}

fn rods() {
    rods_of(Rods5::NEW, Rods5::start(0.6), 10.0);
    rods_of(Rods10::NEW, Rods10::start(0.6), 5.0);
    let short = rods_of(Rods20::NEW, Rods20::start(0.6), 2.0);
    rods_of(Rods50::NEW, Rods50::start(0.6), 1.0);
    rods_of(Rods100::NEW, Rods100::start(0.6), 0.5);
    let long = rods_of(Rods200::NEW, Rods200::start(0.6), 0.3);
    println!(
        "the cost of a step grows with the exponent {:.2} from 20 to 200 rods",
        (long / short).ln() / 10_f64.ln()
    );
}

fn lanes_of<L>(system: L, start: fn(f64) -> StateOf<L>, time: f64)
where
    L: Lagrangian<Scalar = f64>
        + Pack<Lanes, Packed: Lagrangian<N = L::N, M = L::M, Scalar = Lanes>>
        + Copy
        + Sync,
{
    const COUNT: usize = 64;
    let ensemble = || Ensemble::from_fn(COUNT, |k| (system, start(0.3 + k as f64 / COUNT as f64)));
    let [alone, lanes] = in_turn([
        &|| {
            black_box(ensemble().integrate(time, Dop853::with_tolerance(1e-9)).is_ok());
        },
        &|| {
            black_box(ensemble().integrate_on_lanes(time, Dop853::with_tolerance(1e-9)).is_ok());
        },
    ]);
    println!(
        "{:3} rods   an ensemble on lanes is {:.2} times as fast as one by one",
        L::COORDINATES.len() / 2,
        alone / lanes
    );
}

/// Long enough that the start, which is checked one by one, counts little.
fn lanes() {
    lanes_of(Rods5::NEW, Rods5::start, 2.0);
    lanes_of(Rods10::NEW, Rods10::start, 2.0);
    lanes_of(Rods20::NEW, Rods20::start, 2.0);
    lanes_of(Rods50::NEW, Rods50::start, 2.0);
}

/// A heavy top; with a term that vanishes on the constraint added to L by hand; and in Euler angles.
macro_rules! tops {
    ($($name:ident $extra:expr;)*) => {$(
        #[derive(Lagrangian, Clone, Copy)]
        #[coordinates(q: [4])]
        #[define(w = quat_rate_body(q, q_dot))]
        #[lagrangian((j[0]*w[0]^2 + j[1]*w[1]^2 + j[2]*w[2]^2)/2 - m*g*l*quat_rotate(q, [0, 0, 1])[2] + $extra)]
        #[constraint(unit: (dot(q, q) - 1)/2 = 0)]
        struct $name<T> { j: [T; 3], m: T, g: T, l: T }
    )*};
}

tops! {
    Top 0;
    TopByHand 2*j[0]*dot(q, q_dot)^2;
}

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(phi, theta, psi)]
#[define(w = [phi_dot*sin(theta)*sin(psi) + theta_dot*cos(psi), phi_dot*sin(theta)*cos(psi) - theta_dot*sin(psi), phi_dot*cos(theta) + psi_dot])]
#[lagrangian((j[0]*w[0]^2 + j[1]*w[1]^2 + j[2]*w[2]^2)/2 - m*g*l*cos(theta))]
struct TopInAngles<T> {
    j: [T; 3],
    m: T,
    g: T,
    l: T,
}

macro_rules! free_bodies {
    ($($name:ident $extra:expr;)*) => {$(
        #[derive(Lagrangian, Clone, Copy)]
        #[coordinates(q: [4])]
        #[define(w = quat_rate_body(q, q_dot))]
        #[lagrangian((j[0]*w[0]^2 + j[1]*w[1]^2 + j[2]*w[2]^2)/2 + $extra)]
        #[constraint(unit: (dot(q, q) - 1)/2 = 0)]
        struct $name<T> { j: [T; 3] }
    )*};
}

free_bodies! {
    Free 0;
    FreeByHand 2*j[0]*dot(q, q_dot)^2;
}

macro_rules! balls {
    ($($name:ident $extra:expr;)*) => {$(
        #[derive(Lagrangian, Clone, Copy)]
        #[coordinates(r: [3], q: [4])]
        #[define(J = 2/5*m*a^2)]
        #[define(Omega = quat_rate(q, q_dot))]
        #[lagrangian(m/2*dot(r_dot, r_dot) + J/2*dot(Omega, Omega) + m*dot(g, r) + $extra)]
        #[constraint(rolling: r_dot - a*cross(Omega, n) = w*cross(n, r))]
        #[constraint(unit: (dot(q, q) - 1)/2 = 0)]
        struct $name<T> { m: T, a: T, g: [T; 3], n: [T; 3], w: T }
    )*};
}

balls! {
    Ball 0;
    BallByHand 2*J*dot(q, q_dot)^2;
}

/// Three bodies in a row, hung from one another by spherical joints.
macro_rules! joints {
    ($($name:ident $extra:expr;)*) => {$(
        #[derive(Lagrangian, Clone, Copy)]
        #[coordinates(ra: [3], qa: [4], rb: [3], qb: [4], rc: [3], qc: [4])]
        #[define(wa = quat_rate_body(qa, qa_dot))]
        #[define(wb = quat_rate_body(qb, qb_dot))]
        #[define(wc = quat_rate_body(qc, qc_dot))]
        #[define(T = m/2*(dot(ra_dot, ra_dot) + dot(rb_dot, rb_dot) + dot(rc_dot, rc_dot)))]
        #[define(R = (j[0]*(wa[0]^2 + wb[0]^2 + wc[0]^2) + j[1]*(wa[1]^2 + wb[1]^2 + wc[1]^2) + j[2]*(wa[2]^2 + wb[2]^2 + wc[2]^2))/2)]
        #[lagrangian(T + R - m*g*(ra[2] + rb[2] + rc[2]) + $extra)]
        #[constraint(ua: (dot(qa, qa) - 1)/2 = 0)]
        #[constraint(ub: (dot(qb, qb) - 1)/2 = 0)]
        #[constraint(uc: (dot(qc, qc) - 1)/2 = 0)]
        #[constraint(first: ra + quat_rotate(qa, arm) = 0)]
        #[constraint(second: rb + quat_rotate(qb, arm) = ra - quat_rotate(qa, arm))]
        #[constraint(third: rc + quat_rotate(qc, arm) = rb - quat_rotate(qb, arm))]
        struct $name<T> { m: T, j: [T; 3], g: T, arm: [T; 3] }
    )*};
}

joints! {
    Joints 0;
    JointsByHand 2*(j[0] + j[1] + j[2])*(dot(qa, qa_dot)^2 + dot(qb, qb_dot)^2 + dot(qc, qc_dot)^2);
}

/// States of random entries, quaternions among them made units.
fn random_states<const N: usize>(quaternions: &[usize]) -> Vec<State<f64, N>> {
    let mut seed = 7_u64;
    let mut next = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let state = |_| {
        let mut state = State::new([0.0; N].map(|_| next()), [0.0; N].map(|_| next()));
        for &at in quaternions {
            let length = state.q.fixed_rows::<4>(at).norm();
            state.q.fixed_rows_mut::<4>(at).unscale_mut(length);
            let along = state.q.fixed_rows::<4>(at).dot(&state.v.fixed_rows::<4>(at));
            let part = state.q.fixed_rows::<4>(at) * along;
            state.v.fixed_rows_mut::<4>(at).zip_apply(&part, |v, part| *v -= part);
        }
        state
    };
    (0..64).map(state).collect()
}

fn solved<L>(system: &L, states: &[StateOf<L>])
where
    L: Lagrangian<Scalar = f64>,
{
    for _ in 0..100 {
        for state in states {
            black_box(black_box(system).solve(black_box(state)).is_ok());
        }
    }
}

/// Nanoseconds of one `solve` and the time over that by hand; evaluations on lanes over those one by one.
fn quaternion<L, H, const N: usize>(name: &str, system: L, by_hand: H, quaternions: &[usize]) -> f64
where
    L: Lagrangian<N = Const<N>, Scalar = f64>
        + Pack<Lanes, Packed: Lagrangian<N = Const<N>, M = L::M, Scalar = Lanes>>,
    H: Lagrangian<N = Const<N>, M = L::M, Scalar = f64>,
{
    let states = random_states::<N>(quaternions);
    let [own, hand] = in_turn([&|| solved(&system, &states), &|| solved(&by_hand, &states)]);
    let packed = system.pack();
    let wide: Vec<State<Lanes, N>> = states
        .as_chunks::<{ Lanes::COUNT }>()
        .0
        .iter()
        .map(|four| {
            let lane = |entry: &dyn Fn(&State<f64, N>) -> f64| {
                Lanes::from(std::array::from_fn(|lane| entry(&four[lane])))
            };
            State {
                t: lane(&|state| state.t),
                q: lagrange_core::nalgebra::SVector::from_fn(|i, _| lane(&|state| state.q[i])),
                v: lagrange_core::nalgebra::SVector::from_fn(|i, _| lane(&|state| state.v[i])),
            }
        })
        .collect();
    let [alone, lanes] = in_turn([
        &|| {
            for state in states.iter().cycle().take(6400) {
                black_box(called(black_box(&system), black_box(state)));
            }
        },
        &|| {
            for state in wide.iter().cycle().take(6400 / Lanes::COUNT) {
                black_box(called(black_box(&packed), black_box(state)));
            }
        },
    ]);
    println!(
        "{name:14} solve {:7.1} ns, {:.3} of that by hand; evaluated on lanes {:.2} times as fast",
        1e9 * own / 6400.0,
        own / hand,
        alone / lanes
    );
    own / 6400.0
}

fn quaternions() {
    let (j, m, g, l) = ([0.4, 0.5, 0.3], 1.2, 9.81, 0.6);
    let top = quaternion("heavy top", Top { j, m, g, l }, TopByHand { j, m, g, l }, &[0]);
    let angles = TopInAngles { j, m, g, l };
    let mut states = random_states::<3>(&[]);
    states.iter_mut().for_each(|state| state.q[1] = 1.5 + 0.5 * state.q[1]);
    let [in_angles] = in_turn([&|| solved(&angles, &states)]);
    println!(
        "heavy top      in quaternions {:.2} times as long as in Euler angles",
        top / (in_angles / 6400.0)
    );
    quaternion("free body", Free { j }, FreeByHand { j }, &[0]);
    let (a, down, n, w) = (0.3, [0.0, 0.0, -9.81], [0.0, 0.0, 1.0], 0.5);
    quaternion("rolling ball", Ball { m, a, g: down, n, w }, BallByHand { m, a, g: down, n, w }, &[3]);
    let arm = [0.0, 0.0, 0.5];
    quaternion("three joints", Joints { m, j, g, arm }, JointsByHand { m, j, g, arm }, &[3, 10, 17]);
}

fn main() {
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    for (part, run) in [("rods", rods as fn()), ("lanes", lanes), ("quaternions", quaternions)] {
        if asked.is_empty() || asked.iter().any(|asked| asked == part) {
            run();
        }
    }
}
