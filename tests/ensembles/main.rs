//! Ensembles: every member as if it were alone.

mod constraints;
mod contacts;
mod controllers;
mod events;
mod failures;
mod lengths;
mod members;
mod parts;
mod samples;
mod tables;

// Costly to compile: Taylor's method on lanes once more for most of the above, and what a run cannot see of its members.
#[cfg(feature = "thorough")]
mod fields;
#[cfg(feature = "thorough")]
mod taylor_on_lanes;
#[cfg(feature = "thorough")]
mod unseen;

use lagrange_core::ensemble::{Arrival, Outcome};
use lagrange_core::generic::StaticLength;
use lagrange_core::nalgebra::Const;
use lagrange_core::prelude::*;
use lagrange_random::cases;
use lagrange_systems::DoublePendulum;

/// A bob on a rod, pushed sideways. Its pull is m v²/l − m g·r/l.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[force(x: u)]
#[observable(pull = l*lambda(rod))]
struct Pendulum<T> {
    m: T,
    g: T,
    l: T,
    u: T,
}

/// The second constraint says the same as the first, but shows it where that holds only. In the stages of a coarse
/// step the two look independent, and what they demand together is wrong: such members are integrated alone.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[constraint(again: c*(x^2 + y^2 - l^2)*(2 + x) = 0)]
#[observable(pull = l*(lambda(rod) + 2*c*(2 + x)*lambda(again)))]
struct Redundant<T> {
    m: T,
    g: T,
    l: T,
    c: T,
}

/// ẍ = k x²: with k = 6 from x = 1, ẋ = 2 it is x = (1 − t)⁻².
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 + k*x^3/3)]
struct Runaway<T> {
    k: T,
}

/// Numbers between 0 and 1 that look random, always the same.
fn noise(index: usize, entry: usize) -> f64 {
    let mut x = (index as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (entry as u64 + 1).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 30)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x >> 11) as f64 / (1_u64 << 53) as f64
}

/// A member of other parameters and another start for each index.
fn member(index: usize) -> (DoublePendulum<f64>, State<f64, 2>) {
    let number = |entry| noise(index, entry);
    let system = DoublePendulum {
        m: [0.5 + number(0), 0.5 + number(1)],
        l: [0.5 + number(2), 0.5 + number(3)],
        g: 9.81,
    };
    (system, State::at_rest([4.0 * number(4) - 2.0, 4.0 * number(5) - 2.0]))
}

const COUNT: usize = 19;
const END: f64 = 1.0;

fn ensemble<'a>() -> Ensemble<'a, DoublePendulum<f64>> {
    Ensemble::from_fn(COUNT, member)
}

/// Members that tests also run alone.
fn some() -> impl Iterator<Item = usize> {
    (0..COUNT).step_by(cases([6, 1, 1]))
}

/// On a pool of its own with this many threads.
fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads").install(work)
}

/// By the default method, on lanes.
fn on_lanes<const LIVE: bool>(ensemble: Ensemble<'_, DoublePendulum<f64>, LIVE>) -> Outcome<f64, Const<2>> {
    ensemble.integrate_on_lanes(END, Dop853::default()).expect("an outcome")
}

fn arrival<N: StaticLength>(outcome: &Outcome<f64, N>, index: usize) -> &Arrival<f64, N> {
    outcome.get(index).and_then(|member| member.arrival()).expect("a motion")
}

/// Accepted and refused steps.
fn steps<N: StaticLength>(arrival: &Arrival<f64, N>) -> [usize; 2] {
    [arrival.statistics.accepted, arrival.statistics.rejected]
}

/// Members of which the third starts at an angle that the lanes have no sines of: its steps are taken alone.
fn far(index: usize) -> (DoublePendulum<f64>, State<f64, 2>) {
    let (system, start) = member(index);
    let turns = if index == 2 { 2e9 * std::f64::consts::PI } else { 0.0 };
    (system, State::at_rest(start.q.add_scalar(turns)))
}
