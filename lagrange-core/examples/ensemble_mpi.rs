//! Double pendulums on all ranks of MPI, resumed after a kill.
//!
//! ```text
//! apt-get install libopenmpi-dev openmpi-bin libclang-dev
//! cargo build --release -p lagrange-core --features mpi --example ensemble_mpi
//! mpirun -n 4 target/release/examples/ensemble_mpi 100000 rows.jsonl
//! ```
//!
//! Rank 0 appends the row of each member to the file as it is done. Killed and started again, it does what is not in the file
//! yet. The file is the same for any number of ranks. `--plain` as the third argument does the same without MPI, to compare.

use std::error::Error;
use std::fs::{File, read_to_string, rename, write};
use std::io::{ErrorKind, Write};
use std::ops::ControlFlow;
use std::time::Instant;

use lagrange_core::mpi::{self, Threading, topology::SimpleCommunicator, traits::Communicator};
use lagrange_core::{ensemble::Outcome, nalgebra::Const, prelude::*};

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

/// Let go at rest from angles that fill the square (−2, 2)² evenly: sums, products and remainders, which are the same on
/// all machines.
fn member(index: usize) -> (DoublePendulum<f64>, State<f64, 2>) {
    let angle = |ratio: f64| 4.0 * ((index + 1) as f64 * ratio).fract() - 2.0;
    let pendulum = DoublePendulum { m: [1.0; 2], l: [1.0; 2], g: 9.81 };
    (pendulum, State::at_rest([angle(0.754_877_666_246_692_8), angle(0.569_840_290_998_053_3)]))
}

/// In seconds.
const END: f64 = 10.0;

/// Members of which samples are kept, of two coordinates and without constraints.
type Pendulums<'a> = Ensemble<'a, DoublePendulum<f64>, true>;
type Result<T, E = Box<dyn Error>> = std::result::Result<T, E>;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (count, file) = match &arguments[..] {
        [count, file, ..] => (count.parse()?, file.as_str()),
        _ => return Err("usage: ensemble_mpi COUNT FILE [--plain]".into()),
    };
    let pendulums = Ensemble::from_fn(count, member).samples_at([END]).tag("energy");
    let pendulums = pendulums.quantity("energy", |sample| sample.energy());
    if arguments.len() > 2 {
        return with_file(pendulums, file, |all| all.integrate_on_lanes(END, Dop853::default()).map(Some));
    }
    let (universe, _) = mpi::initialize_with_threading(Threading::Funneled).ok_or("MPI is in use")?;
    let world = universe.world();
    // The others would wait for a rank that left.
    on_ranks(&world, pendulums, file).unwrap_or_else(|error| {
        eprintln!("rank {}: {error}", world.rank());
        world.abort(1)
    });
    Ok(())
}

/// The file is rank 0's alone.
fn on_ranks(world: &SimpleCommunicator, pendulums: Pendulums<'_>, file: &str) -> Result<()> {
    let method = Dop853::default();
    match world.rank() {
        0 => with_file(pendulums, file, |all| all.on_ranks(world).integrate_on_lanes(END, method)),
        _ => pendulums.on_ranks(world).integrate_on_lanes(END, method).map(drop).map_err(Into::into),
    }
}

/// Takes over what is in the file, and appends what is done.
fn with_file(
    pendulums: Pendulums<'_>,
    file: &str,
    run: impl FnOnce(Pendulums<'_>) -> Result<Option<Outcome<f64, Const<2>>>, lagrange_core::Error>,
) -> Result<()> {
    let known = match read_to_string(file) {
        Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
        known => known?,
    };
    let mut rows = File::options().append(true).create(true).open(file)?;
    let (mut written, started) = (Ok(()), Instant::now());
    let pendulums = pendulums.resume(&known)?.on_progress(|progress| {
        written = rows.write_all(progress.member.json_line().to_string().as_bytes());
        if written.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let outcome = run(pendulums)?;
    written?;
    let Some(outcome) = outcome else { return Ok(()) };
    // In order, and without what a kill has left of rows.
    let cleaned = format!("{file}.cleaned");
    write(&cleaned, outcome.json_lines().to_string())?;
    rename(&cleaned, file)?;
    let (done, failed) = (outcome.members().len(), outcome.failures().count());
    println!("{done} members, {failed} failures; the energy is off by {:e}", off(&outcome)?);
    eprintln!("{:.3} s", started.elapsed().as_secs_f64());
    Ok(())
}

/// The largest change of the energy.
fn off(outcome: &Outcome<f64, Const<2>>) -> Result<f64> {
    let mut largest = 0.0_f64;
    for index in outcome.members().iter().map(|member| member.index) {
        let (pendulum, start) = member(index);
        for energy in outcome.quantity(index, "energy")? {
            largest = largest.max((energy - pendulum.energy(&start)).abs());
        }
    }
    Ok(largest)
}
