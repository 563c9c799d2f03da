//! One motion, timed.
//!
//! `taylor SYSTEM METHOD END START ENDS`: SYSTEM is `planar-N`, `double` or `spherical`, METHOD `taylor` at the tolerance of round-off or
//! `dop853` at 1e-13. START holds coordinates and velocities, `f64` in the machine's byte order. Each line on the standard input
//! asks for one run, which answers with the seconds and steps it took as a line of JSON; at its end the last state is written
//! to ENDS.

use std::io::{BufRead, stdin};
use std::time::Instant;

use lagrange_core::{Method, TaylorSeries, nalgebra::Const, prelude::*};
use systems::*;

#[path = "../systems.rs"]
#[allow(dead_code, reason = "only some of the systems are integrated here")]
mod systems;

const GRAVITY: f64 = 9.81;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// What is asked for.
struct Task {
    method: String,
    end: f64,
    start: Vec<f64>,
    ends: String,
}

impl Task {
    fn run<L, const N: usize>(&self, system: &L) -> Outcome<()>
    where
        L: TaylorSeries<N = Const<N>, Scalar = f64>,
    {
        let halves: Vec<[f64; N]> = self.start.as_chunks().0.to_vec();
        let [q, v] = <[[f64; N]; 2]>::try_from(halves).map_err(|_| "START is of another length")?;
        let start = State::new(q, v);
        match self.method.as_str() {
            "taylor" => self.timed(system, start, Taylor::default()),
            "dop853" => self.timed(system, start, Dop853::with_tolerance(1e-13)),
            other => Err(format!("there is no method {other}").into()),
        }
    }

    fn timed<L, P, const N: usize>(&self, system: &L, start: State<f64, N>, method: P) -> Outcome<()>
    where
        L: Lagrangian<N = Const<N>, Scalar = f64>,
        P: for<'l> Method<&'l L> + Copy,
    {
        let mut last = start;
        for line in stdin().lock().lines() {
            line?;
            let begun = Instant::now();
            let mut motion = Motion::new(system, start, method)?;
            motion.advance_to(self.end)?;
            let (seconds, steps) = (begun.elapsed().as_secs_f64(), motion.statistics().accepted);
            println!("{{\"seconds\": {seconds}, \"steps\": {steps}}}");
            last = *motion.state();
        }
        let numbers = last.q.iter().chain(last.v.iter());
        std::fs::write(&self.ends, numbers.flat_map(|x| x.to_ne_bytes()).collect::<Vec<_>>())?;
        Ok(())
    }
}

fn main() -> Outcome<()> {
    let [_, system, method, end, start, ends] = <[String; 6]>::try_from(std::env::args().collect::<Vec<_>>())
        .map_err(|_| "usage: taylor SYSTEM METHOD END START ENDS")?;
    let start = std::fs::read(start)?.as_chunks().0.iter().map(|&bytes| f64::from_ne_bytes(bytes)).collect();
    let task = Task { method, end: end.parse()?, start, ends };
    match system.as_str() {
        "planar-2" => task.run(&Planar2 { m: [1.0; 2], l: [1.0; 2], g: GRAVITY }),
        "planar-5" => task.run(&Planar5 { m: [1.0; 5], l: [1.0; 5], g: GRAVITY }),
        "planar-10" => task.run(&Planar10 { m: [1.0; 10], l: [1.0; 10], g: GRAVITY }),
        "planar-20" => task.run(&Planar20 { m: [1.0; 20], l: [1.0; 20], g: GRAVITY }),
        "double" => task.run(&Double { m: [1.0; 2], l: [1.0; 2], g: GRAVITY }),
        "spherical" => task.run(&Spherical { m: 1.0, l: 1.0, g: GRAVITY }),
        other => Err(format!("there is no system {other}").into()),
    }
}
