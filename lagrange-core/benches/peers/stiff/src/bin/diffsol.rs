//! `diffsol SYSTEM TOLERANCE ENDS` integrates by the BDF method of diffsol once for each line of the standard input, and answers
//! with the costs of each run. At the end of the input it writes the last state to the file ENDS.

use std::cell::{Cell, RefCell};
use std::io::{BufRead, stdin};
use std::time::Instant;

use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason, VectorCommon};
use lagrange_core::nalgebra::Const;
use lagrange_core::{StateDerivatives, prelude::*};
use stiff::{Work, jacobian, rates, work_on};

type Outcome = Result<(), Box<dyn std::error::Error>>;

struct Timed {
    tolerance: f64,
    ends: String,
}

impl Work for Timed {
    type Outcome = Outcome;
    fn on<L, const N: usize>(self, system: &L, start: State<f64, N>, end: State<f64, N>) -> Outcome
    where
        L: StateDerivatives<N = Const<N>, Scalar = f64>,
    {
        let start: Vec<f64> = start.q.iter().chain(start.v.iter()).copied().collect();
        let mut last = start.clone();
        for line in stdin().lock().lines() {
            line?;
            let begun = Instant::now();
            let evaluations = Cell::new(0);
            // The Jacobian is asked for column by column: it is evaluated once at each state.
            let known = RefCell::new((f64::NAN, vec![f64::NAN; 2 * N], vec![0.0; 4 * N * N]));
            let along = |y: &[f64], _: &[f64], t: f64, direction: &[f64], out: &mut [f64]| {
                let mut known = known.borrow_mut();
                if known.0 != t || known.1 != y {
                    (known.0, known.1) = (t, y.to_vec());
                    jacobian(system, t, y, &mut known.2);
                }
                for (out, row) in out.iter_mut().zip(known.2.chunks_exact(2 * N)) {
                    *out = row.iter().zip(direction).map(|(x, d)| x * d).sum();
                }
            };
            let problem = OdeBuilder::<NalgebraMat<f64>>::new()
                .rtol(self.tolerance)
                .atol([self.tolerance])
                .rhs_implicit(
                    |y, _, t, out| {
                        evaluations.set(evaluations.get() + 1);
                        rates(system, t, y, out);
                    },
                    along,
                )
                .init(|_, _, y| y.copy_from_slice(&start), 2 * N)
                .build()?;
            let mut solver = problem.bdf::<NalgebraLU<f64>>()?;
            solver.set_stop_time(end.t)?;
            while !matches!(solver.step()?, OdeSolverStopReason::TstopReached) {}
            let seconds = begun.elapsed().as_secs_f64();
            let spent = solver.get_statistics();
            let rejected = spent.number_of_error_test_failures + spent.number_of_nonlinear_solver_fails;
            println!(
                "{{\"seconds\": {seconds}, \"steps\": {}, \"rejected\": {rejected}, \"evaluations\": {}}}",
                spent.number_of_steps,
                evaluations.get()
            );
            last.copy_from_slice(solver.state().y.inner().as_slice());
        }
        std::fs::write(&self.ends, last.iter().flat_map(|x| x.to_ne_bytes()).collect::<Vec<_>>())?;
        Ok(())
    }
}

fn main() -> Outcome {
    let [_, system, tolerance, ends] = <[String; 4]>::try_from(std::env::args().collect::<Vec<_>>())
        .map_err(|_| "usage: diffsol SYSTEM TOLERANCE ENDS")?;
    work_on(&system, Timed { tolerance: tolerance.parse()?, ends }).ok_or("there is no such system")?
}
