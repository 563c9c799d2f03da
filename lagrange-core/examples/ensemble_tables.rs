//! Springs with samples, quantities and crossings, in a table that survives a kill.
//!
//! ```text
//! cargo run --release -p lagrange-core --features rayon,parquet --example ensemble_tables -- 100000 FOLDER json
//! cargo run --release -p lagrange-core --features rayon,parquet --example ensemble_tables -- 100000 FOLDER parquet
//! ```
//!
//! Members are appended to `FOLDER/rows.jsonl`, or to files in `FOLDER/parquet`, as they are done. Killed and started again, the program
//! does what is not in the table yet. In the end it writes all that it knows of the members to `FOLDER/json.jsonl` or
//! `FOLDER/parquet.jsonl`. `.ci/tables` compares these, kills, and reads the tables with polars and pandas.

use std::error::Error;
use std::fs::{File, create_dir_all, read_to_string, write};
use std::io::{ErrorKind, Write};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use lagrange_core::ensemble::{Outcome, ParquetTable};
use lagrange_core::{nalgebra::Const, prelude::*};

/// x = cos √k t, until an event ends the motion.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k/2 * x^2)]
struct Spring<T> {
    k: T,
    until: T,
}

/// Every tenth is ended early, and of every thousand one does not start.
fn member(index: usize) -> (Spring<f64>, State<f64, 1>) {
    let k = if index % 1000 == 7 { f64::NAN } else { 1.0 + index as f64 / 1000.0 };
    let until = if index % 10 == 3 { 0.01 * (index % 100) as f64 } else { 100.0 };
    (Spring { k, until }, State::at_rest([1.0]))
}

type Springs<'a> = Ensemble<'a, Spring<f64>, true>;

fn springs<'a>(count: usize) -> Springs<'a> {
    let any = member(0).0;
    let zero = any.event("zero", |sample| sample.state().q[0]);
    let end = any.event("end, \"early\"", |sample| sample.system().until - sample.time()).terminal();
    let springs = Ensemble::from_fn(count, member).every(0.1).event(zero).event(end);
    let springs = springs.quantity("energy", |sample| sample.energy());
    springs.quantity("1/v, \"slowness\"", |sample| sample.state().v[0].recip()).tag("first")
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [count, folder, kind] = &arguments[..] else {
        return Err("usage: ensemble_tables COUNT FOLDER json|parquet".into());
    };
    let (springs, folder) = (springs(count.parse()?), Path::new(folder));
    create_dir_all(folder)?;
    let outcome = if kind == "json" { with_json(springs, folder)? } else { with_parquet(springs, folder)? };
    write(folder.join(format!("{kind}.jsonl")), outcome.json_lines().to_string())?;
    let all = outcome.members().iter().filter_map(|member| member.arrival());
    let kept = all.fold([0; 2], |[s, c], arrival| [s + arrival.samples.len(), c + arrival.crossings.len()]);
    println!("{} members, {} failures", outcome.members().len(), outcome.failures().count());
    println!("{} samples, {} crossings", kept[0], kept[1]);
    Ok(())
}

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn integrate(springs: Springs<'_>, since: Instant) -> Result<Outcome<f64, Const<1>>> {
    eprintln!("read in {:.2} s", since.elapsed().as_secs_f64());
    let since = Instant::now();
    let outcome = springs.integrate_on_lanes(2.0, Dop853::with_tolerance(1e-10))?;
    eprintln!("integrated in {:.2} s", since.elapsed().as_secs_f64());
    Ok(outcome)
}

fn with_json(springs: Springs<'_>, folder: &Path) -> Result<Outcome<f64, Const<1>>> {
    let (file, since) = (folder.join("rows.jsonl"), Instant::now());
    let known = match read_to_string(&file) {
        Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
        known => known?,
    };
    let mut rows = File::options().append(true).create(true).open(file)?;
    let mut written = Ok(());
    let springs = springs.resume(&known)?.on_progress(|progress| {
        written = rows.write_all(progress.member.json_line().to_string().as_bytes());
        if written.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let outcome = integrate(springs, since)?;
    written?;
    Ok(outcome)
}

fn with_parquet(springs: Springs<'_>, folder: &Path) -> Result<Outcome<f64, Const<1>>> {
    let since = Instant::now();
    let mut table = ParquetTable::open(folder.join("parquet"), member)?.every(Duration::from_millis(300));
    let mut written = Ok(());
    let springs = springs.resume_from(table.read()?)?.on_progress(|progress| {
        written = table.push(progress.member);
        if written.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let outcome = integrate(springs, since)?;
    written?;
    table.flush()?;
    Ok(outcome)
}
