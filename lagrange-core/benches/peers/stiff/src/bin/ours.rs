//! `ours SYSTEM about` prints end, start and the known last state as JSON. `ours SYSTEM STAGES TOLERANCE ENDS` integrates by
//! `Radau` with this number of stages once for each line of the standard input, and answers with the costs of each run. At the end
//! of the input it writes the last state to the file ENDS.

use std::io::{BufRead, stdin};
use std::time::Instant;

use lagrange_core::nalgebra::Const;
use lagrange_core::{Method, StateDerivatives, prelude::*};
use stiff::{Work, work_on};

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn numbers<const N: usize>(state: &State<f64, N>) -> Vec<f64> {
    state.q.iter().chain(state.v.iter()).copied().collect()
}

struct About;

impl Work for About {
    type Outcome = Outcome;
    fn on<L, const N: usize>(self, _: &L, start: State<f64, N>, end: State<f64, N>) -> Outcome {
        let (time, start, end) = (end.t, numbers(&start), numbers(&end));
        println!("{{\"time\": {time}, \"start\": {start:?}, \"end\": {end:?}}}");
        Ok(())
    }
}

struct Timed {
    stages: String,
    tolerance: f64,
    ends: String,
}

impl Work for Timed {
    type Outcome = Outcome;
    fn on<L, const N: usize>(self, system: &L, start: State<f64, N>, end: State<f64, N>) -> Outcome
    where
        L: StateDerivatives<N = Const<N>, Scalar = f64>,
    {
        let method = Radau::with_tolerance(self.tolerance);
        match self.stages.as_str() {
            "3" => self.by(method, system, start, end.t),
            "5" => self.by(method.stages::<5>(), system, start, end.t),
            "7" => self.by(method.stages::<7>(), system, start, end.t),
            other => Err(format!("there is no method with {other} stages").into()),
        }
    }
}

impl Timed {
    fn by<L, const N: usize>(
        &self,
        method: impl for<'l> Method<&'l L> + Copy,
        system: &L,
        start: State<f64, N>,
        end: f64,
    ) -> Outcome
    where
        L: StateDerivatives<N = Const<N>, Scalar = f64>,
    {
        let mut last = start;
        for line in stdin().lock().lines() {
            line?;
            let begun = Instant::now();
            let mut motion = Motion::new(system, start, method)?;
            motion.advance_to(end)?;
            let (seconds, spent) = (begun.elapsed().as_secs_f64(), motion.statistics());
            println!(
                "{{\"seconds\": {seconds}, \"steps\": {}, \"rejected\": {}, \"evaluations\": {}}}",
                spent.accepted, spent.rejected, spent.evaluations
            );
            last = *motion.state();
        }
        std::fs::write(&self.ends, numbers(&last).iter().flat_map(|x| x.to_ne_bytes()).collect::<Vec<_>>())?;
        Ok(())
    }
}

fn main() -> Outcome {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [system, "about"] => work_on(system, About),
        [system, stages, tolerance, ends] => {
            let (stages, ends) = (stages.to_owned(), ends.to_owned());
            work_on(system, Timed { stages, tolerance: tolerance.parse()?, ends })
        }
        _ => None,
    };
    done.ok_or("usage: ours squeezer|car_axis|honey about | ours SYSTEM 3|5|7 TOLERANCE ENDS")?
}
