//! Ensembles: every member as if it were alone.

mod constraints;
mod contacts;
mod controllers;
mod events;
mod failures;
mod fields;
mod members;
mod parts;
mod samples;
mod tables;
mod taylor_on_lanes;
mod unseen;

use lagrange_core::prelude::*;

/// Two bobs on two rods, the angles from the vertical.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(a, b)]
#[lagrangian(
    (m[0] + m[1])/2*l[0]^2*a_dot^2 + m[1]/2*l[1]^2*b_dot^2 + m[1]*l[0]*l[1]*a_dot*b_dot*cos(a - b)
        + (m[0] + m[1])*g*l[0]*cos(a) + m[1]*g*l[1]*cos(b)
)]
struct DoublePendulum<T> {
    m: [T; 2],
    l: [T; 2],
    g: T,
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

/// On a pool of its own with this many threads.
fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads").install(work)
}
