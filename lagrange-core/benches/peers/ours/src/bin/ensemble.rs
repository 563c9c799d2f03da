//! Many double pendulums from rest to T = 10, timed.
//!
//! `ensemble taylor|dop853 lanes|one-by-one TOLERANCE STARTS ENDS`: STARTS holds the initial angles, two `f64` a pendulum in the machine's byte
//! order. Each line on the standard input asks for one run, which answers with the seconds it took as a line of JSON; at
//! its end the last states are written to ENDS, two angles and two rates a pendulum.

use std::io::{BufRead, stdin};
use std::time::Instant;

use lagrange_core::motion::LaneMethod;
use lagrange_core::prelude::*;

const END: f64 = 10.0;

/// Two equal links, as Landau and Lifshitz state them (*Mechanics*, § 5, problem 1).
#[derive(Lagrangian)]
#[coordinates(a, b)]
#[lagrangian(a_dot^2 + b_dot^2/2 + a_dot*b_dot*cos(a - b) + g*(2*cos(a) + cos(b)))]
struct DoublePendulum<T> {
    g: T,
}

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

fn run(
    on_lanes: bool,
    starts: &[[f64; 2]],
    method: impl LaneMethod<DoublePendulum<f64>> + Sync,
) -> Outcome<Vec<State<f64, 2>>> {
    let member = |k: usize| (DoublePendulum { g: 9.81 }, State::at_rest(starts[k]));
    let ensemble = Ensemble::from_fn(starts.len(), member);
    let outcome =
        if on_lanes { ensemble.integrate_on_lanes(END, method)? } else { ensemble.integrate(END, method)? };
    let ends: Vec<State<f64, 2>> = outcome.completed().map(|(_, state)| *state).collect();
    if ends.len() == starts.len() { Ok(ends) } else { Err("a member has failed".into()) }
}

fn main() -> Outcome<()> {
    let [_, method, way, tolerance, starts, ends] =
        <[String; 6]>::try_from(std::env::args().collect::<Vec<_>>())
            .map_err(|_| "usage: ensemble taylor|dop853 lanes|one-by-one TOLERANCE STARTS ENDS")?;
    let numbers: Vec<f64> =
        std::fs::read(starts)?.as_chunks().0.iter().map(|&bytes| f64::from_ne_bytes(bytes)).collect();
    let (tolerance, starts) = (tolerance.parse()?, numbers.as_chunks().0);
    let mut states = Vec::new();
    for line in stdin().lock().lines() {
        line?;
        let begun = Instant::now();
        states = match &*method {
            "taylor" => run(way == "lanes", starts, Taylor::with_tolerance(tolerance))?,
            _ => run(way == "lanes", starts, Dop853::with_tolerance(tolerance))?,
        };
        println!("{{\"seconds\": {}}}", begun.elapsed().as_secs_f64());
    }
    let numbers = states.iter().flat_map(|state| state.q.iter().chain(state.v.iter()));
    std::fs::write(ends, numbers.flat_map(|number| number.to_ne_bytes()).collect::<Vec<_>>())?;
    Ok(())
}
