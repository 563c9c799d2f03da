//! Tables of Parquet: what is written is read, what was cut off is done again, what is of another run is refused.

use std::fs::{copy, create_dir_all, read, read_dir, remove_dir_all, write};
use std::ops::{ControlFlow, Range};
use std::path::PathBuf;
use std::time::Duration;

use lagrange_core::ensemble::{EnsembleError, ParquetTable};
use lagrange_core::{
    Ending,
    ensemble::{Member, MemberTable, Outcome},
    nalgebra::Const,
    prelude::*,
};

#[derive(Lagrangian, Clone, Copy)]
#[coordinates(a, b)]
#[lagrangian(m[0]/2*a_dot^2 + m[1]/2*b_dot^2 - k/2*(a - b)^2 - k/4*a^4)]
struct Oscillators<T> {
    m: [T; 2],
    k: T,
}

const COUNT: usize = 40;
const ALL: Range<usize> = 0..COUNT;
const TO: f64 = 3.0;

/// The parameters of one are not finite.
fn member(index: usize) -> (Oscillators<f64>, State<f64, 2>) {
    let x = 1.0 + index as f64 / 7.0;
    let k = if index == 7 { f64::NAN } else { x.sqrt() };
    (Oscillators { m: [1.0, x], k }, State::new([0.3 * x, -0.1], [x - 2.0, 1.0 / 3.0]))
}

/// A quantity that is infinite at the start.
const SLOWNESS: &str = "1/t, \"slowness\"\n";

type Members = Ensemble<'static, Oscillators<f64>, true>;

/// Some meet the limit on steps, and some are ended early: by the observer, by an event. Samples, quantities and crossings are
/// kept.
fn members() -> Members {
    members_by(member)
}

fn members_by(member: fn(usize) -> (Oscillators<f64>, State<f64, 2>)) -> Members {
    let back = member(0).0.event("back", |sample| sample.state().v[0] + 5.0).terminal();
    let turns = member(0).0.event("turns", |sample| sample.state().v[0]);
    let members = Ensemble::from_fn(COUNT, member).event(back).event(turns).tag("back");
    let members = members.samples_at((0..=6).map(|k| 0.5 * f64::from(k)));
    let members = members.quantity("energy", |sample| sample.energy());
    members.quantity(SLOWNESS, |sample| sample.time().recip()).observe(|index, state| {
        match index % 5 == 1 && state.t > 1.0 {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    })
}

fn method() -> Dop853 {
    Dop853::default().max_steps(36)
}

fn whole() -> Outcome<f64, Const<2>> {
    let outcome = members().integrate_on_lanes(TO, method()).expect("an outcome");
    let failures = outcome.failures().count();
    let by_event =
        |m: &&Member<f64, Const<2>>| m.arrival().is_some_and(|a| matches!(a.ending, Ending::Event { .. }));
    let ended = outcome.members().iter().filter(by_event).count();
    assert!(
        failures > 2 && ended > 2 && outcome.completed().count() > 10,
        "{failures} failures, {ended} events"
    );
    outcome
}

/// As the table of JSON lines has it.
fn expected(outcome: &Outcome<f64, Const<2>>) -> MemberTable<f64, Const<2>> {
    MemberTable::read::<Oscillators<f64>>(&outcome.json_lines().to_string()).expect("a table")
}

/// A directory that is removed in the end.
struct Directory(PathBuf);

impl Directory {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("lagrange-{}-{name}", std::process::id()));
        create_dir_all(&path).expect("a directory");
        Self(path)
    }

    fn files(&self) -> Vec<PathBuf> {
        let mut files: Vec<_> =
            read_dir(&self.0).expect("a directory").map(|entry| entry.expect("a file").path()).collect();
        files.sort();
        files
    }
}

impl Drop for Directory {
    fn drop(&mut self) {
        let _ = remove_dir_all(&self.0);
    }
}

fn table(directory: &Directory) -> ParquetTable<'static, Oscillators<f64>> {
    ParquetTable::open(&directory.0, member).expect("a table")
}

/// A file of each of these parts.
fn write_parts(directory: &Directory, outcome: &Outcome<f64, Const<2>>, members: Range<usize>, parts: usize) {
    let mut table = table(directory);
    for part in outcome.members()[members.clone()].chunks(members.len().div_ceil(parts)) {
        part.iter().for_each(|member| table.push(member).expect("a row"));
        table.flush().expect("a file");
    }
    assert_eq!(directory.files().len(), parts);
}

#[track_caller]
fn refused<X>(result: Result<X, Error>, why: &str) {
    match result.map(drop) {
        Err(Error::Ensemble(EnsembleError::Parquet { reason, .. })) => {
            assert!(reason.contains(why), "{reason}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_written_is_read() {
    let directory = Directory::new("read");
    let outcome = whole();
    write_parts(&directory, &outcome, ALL, 3);
    assert_eq!(table(&directory).read().unwrap(), expected(&outcome));
    assert!(table(&directory).damaged().is_empty());
    // None of what failed is taken over.
    let resumed = members().resume_from(table(&directory).read().unwrap()).unwrap();
    assert_eq!(expected(&resumed.integrate_on_lanes(TO, method()).unwrap()), expected(&outcome));
}

#[test]
fn single_precision_comes_back_to_the_bit() {
    let directory = Directory::new("single");
    let member = |index: usize| {
        let x = 1.0 + index as f32 / 7.0;
        (Oscillators { m: [1.0, x], k: x.sqrt() }, State::new([0.3 * x, -0.1], [x - 2.0, 1.0 / 3.0]))
    };
    let method = Dop853::with_tolerance(1e-5);
    let outcome = Ensemble::from_fn(9, member).integrate(3.0_f32, method).unwrap();
    let mut table = ParquetTable::open(&directory.0, member).unwrap();
    outcome.members().iter().for_each(|member| table.push(member).unwrap());
    table.flush().unwrap();
    let expected = MemberTable::read::<Oscillators<f32>>(&outcome.json_lines().to_string()).unwrap();
    assert_eq!(table.read().unwrap(), expected);
}

/// More rows than a row group of the file has.
#[test]
fn a_file_of_several_row_groups_comes_back() {
    let directory = Directory::new("groups");
    let outcome = Ensemble::from_fn(1100, member).samples_at([0.0, 0.01]).integrate(0.01, method()).unwrap();
    let mut table = table(&directory);
    outcome.members().iter().for_each(|member| table.push(member).unwrap());
    table.flush().unwrap();
    assert_eq!((directory.files().len(), table.read().unwrap()), (1, expected(&outcome)));
}

/// Files are written on the way where rows have waited long enough, and by the drop.
#[test]
fn a_run_that_was_stopped_goes_on_from_the_files() {
    let directory = Directory::new("stopped");
    let mut first = table(&directory).every(Duration::ZERO);
    let stopped = members().on_progress(|progress| {
        first.push(progress.member).unwrap();
        if progress.done == 15 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    stopped.integrate_on_lanes(TO, method()).unwrap();
    assert_eq!(directory.files().len(), 15);
    // The names of files tell rows, not when they were written.
    first
        .read()
        .unwrap()
        .rows()
        .iter()
        .for_each(|row| assert_eq!(row.fingerprint, whole().get(row.index).unwrap().fingerprint));
    drop(first);
    let mut rest = table(&directory);
    let done = rest.read().unwrap();
    let mut again = 0;
    let arrived = done.rows().iter().filter(|row| !row.has_failed()).count();
    let resumed = members().resume_from(done).unwrap().on_progress(|progress| {
        again += 1;
        rest.push(progress.member).unwrap();
        ControlFlow::Continue(())
    });
    assert_eq!(expected(&resumed.integrate_on_lanes(TO, method()).unwrap()), expected(&whole()));
    assert_eq!(again, COUNT - arrived);
    drop(rest);
    assert_eq!(directory.files().len(), 16);
    assert_eq!(table(&directory).read().unwrap(), expected(&whole()));
}

/// As if nothing had happened: also in samples, quantities and crossings.
#[test]
fn a_run_that_was_stopped_twice_has_all_bits() {
    let (directory, whole) = (Directory::new("twice"), whole());
    for after in [7, 13, COUNT] {
        let mut table = table(&directory).every(Duration::ZERO);
        let (done, mut pushed) = (table.read().unwrap(), 0);
        let resumed = members().resume_from(done).unwrap().on_progress(|progress| {
            pushed += 1;
            table.push(progress.member).unwrap();
            if pushed == after { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let outcome = resumed.integrate_on_lanes(TO, method()).unwrap();
        assert_eq!(outcome.members().len() == COUNT, after == COUNT);
        for member in outcome.members() {
            let expected = whole.get(member.index).unwrap();
            // A NaN equals itself in print.
            assert_eq!(format!("{member:?}"), format!("{expected:?}"));
        }
        if after == COUNT {
            assert_eq!(outcome.json_lines().to_string(), whole.json_lines().to_string());
        }
    }
    let read = table_of(&directory);
    let crossed = read.rows().iter().filter(|row| row.crossings.len() > 1).count();
    assert!(crossed > 10 && read.get(7).unwrap().samples.is_empty(), "{crossed}");
    let slowness: Vec<f64> = read.get(0).unwrap().quantity(SLOWNESS).unwrap().collect();
    assert_eq!(slowness, [f64::INFINITY, 2.0, 1.0, 1.0 / 1.5, 0.5, 0.4, 1.0 / 3.0]);
}

/// NaN and single numbers; members without samples and crossings before, between and after others.
#[test]
fn lists_of_every_length_and_numbers_of_every_kind_are_read() {
    let directory = Directory::new("lists");
    let member =
        |index: usize| (Oscillators { m: [1.0, 1.0 + index as f64], k: 1.0 }, State::at_rest([1.0, 0.0]));
    let run = || {
        // Ends at once, or late: by a terminal event that depends on the member.
        let ends = member(0).0.event("ends", |sample| {
            sample.time() - [0.0, 0.05, 2.5, 0.15][sample.system().m[1] as usize % 4] - 1e-3
        });
        let members = Ensemble::from_fn(9, member).event(ends.terminal()).samples_at([0.1, 0.2, 1.0]).tag("");
        members.quantity("none", |sample| if sample.time() < 0.15 { f64::NAN } else { -0.0 })
    };
    let outcome = run().integrate(TO, Dop853::default()).unwrap();
    let lengths = outcome.members().iter().map(|member| member.arrival().unwrap().samples.len());
    assert!(lengths.eq([0, 3, 1, 0, 0, 3, 1, 0, 0]));
    let mut table = ParquetTable::open(&directory.0, member).unwrap();
    for part in outcome.members().chunks(4) {
        part.iter().for_each(|member| table.push(member).unwrap());
        table.flush().unwrap();
    }
    for _ in 0..2 {
        assert_eq!(table.read().unwrap().to_string(), outcome.json_lines().to_string());
        let again =
            run().resume_from(table.read().unwrap()).unwrap().integrate(TO, Dop853::default()).unwrap();
        assert_eq!(format!("{again:?}"), format!("{outcome:?}"));
        table.clean().unwrap();
    }
}

#[test]
fn a_file_that_was_cut_off_loses_its_rows_alone() {
    let directory = Directory::new("cut");
    let outcome = whole();
    write_parts(&directory, &outcome, ALL, 4);
    let cut = directory.files()[1].clone();
    let bytes = read(&cut).unwrap();
    for length in (0..bytes.len()).step_by(31).chain(bytes.len() - 9..bytes.len()) {
        write(&cut, &bytes[..length]).unwrap();
        let mut table = table(&directory);
        let rest = table.read().unwrap();
        assert!(rest.rows().iter().map(|row| row.index).eq((0..10).chain(20..40)), "cut at {length}");
        assert!(
            matches!(table.damaged(), [Error::Ensemble(EnsembleError::Parquet { file, .. })] if *file == cut.display().to_string())
        );
    }
    let resumed = members().resume_from(table(&directory).read().unwrap()).unwrap();
    assert_eq!(expected(&resumed.integrate_on_lanes(TO, method()).unwrap()), expected(&outcome));
}

/// Rows twice, failures that were tried again, a file that was cut off, and one that was not written to its end.
#[test]
fn one_call_cleans() {
    let directory = Directory::new("clean");
    let outcome = members().integrate_on_lanes(TO, Dop853::default()).unwrap();
    let limited = whole();
    assert_eq!(outcome.failures().count(), 1);
    write_parts(&directory, &limited, ALL, 2);
    let files = directory.files();
    copy(&files[0], directory.0.join("copied.parquet")).unwrap();
    write(directory.0.join("cut.parquet"), &read(&files[1]).unwrap()[..999]).unwrap();
    write(directory.0.join("rows-000000000-1-00000000.unfinished"), "PAR1").unwrap();
    let mut table = table(&directory);
    outcome.members().iter().for_each(|member| table.push(member).unwrap());
    for _ in 0..2 {
        table.clean().unwrap();
        assert_eq!(directory.files().len(), 1);
        assert_eq!(table.read().unwrap(), expected(&outcome));
        assert!(table.damaged().is_empty());
    }
}

#[test]
fn tables_of_other_runs_are_refused() {
    let directory = Directory::new("other");
    let outcome = whole();
    write_parts(&directory, &outcome, ALL, 2);
    let settings =
        "the method, one of its settings, a sample, a quantity, an event, the tag or the end is another";
    // By the ensemble.
    let resumed = || members().resume_from(table(&directory).read().unwrap()).unwrap();
    let others = [
        resumed().integrate_on_lanes(TO, Dop853::with_tolerance(1e-8)),
        resumed().integrate(TO, method()),
        resumed().integrate_on_lanes(TO, Dopri5::default()),
    ];
    for other in others {
        assert_eq!(
            other.unwrap_err(),
            Error::Ensemble(EnsembleError::OtherRun { member: 0, differs: settings })
        );
    }
    let fewer = Ensemble::from_fn(COUNT - 1, member).resume_from(table(&directory).read().unwrap());
    assert_eq!(
        fewer.unwrap_err(),
        Error::Ensemble(EnsembleError::NoSuchMember { member: COUNT - 1, count: COUNT - 1 })
    );
    // By the directory, before anything is written into it.
    let coarse = members().integrate_on_lanes(TO, Dop853::with_tolerance(1e-8)).unwrap();
    let mut other = table(&directory);
    other.push(&coarse.members()[0]).unwrap();
    refused(other.flush(), settings);
    assert_eq!(
        other.push(&outcome.members()[1]).unwrap_err(),
        Error::Ensemble(EnsembleError::OtherRun { member: 1, differs: settings })
    );
    drop(other);
    assert_eq!(directory.files().len(), 2);
    // Put into it by hand.
    let beside = Directory::new("beside");
    write_parts(&beside, &coarse, ALL, 1);
    copy(&beside.files()[0], directory.0.join("zzz.parquet")).unwrap();
    refused(table(&directory).read(), settings);
    refused(table(&directory).clean(), settings);
    assert_eq!(directory.files().len(), 3);
}

#[test]
fn tables_of_other_systems_and_starts_are_refused() {
    #[derive(Lagrangian, Clone, Copy)]
    #[coordinates(a, c)]
    #[lagrangian(m*(a_dot^2 + c_dot^2)/2)]
    struct Free {
        m: f64,
    }
    let directory = Directory::new("systems");
    let outcome = whole();
    write_parts(&directory, &outcome, ALL, 1);
    let free = |_: usize| (Free { m: 1.0 }, State::at_rest([0.0; 2]));
    let mut other = ParquetTable::open(&directory.0, free).unwrap();
    refused(other.read(), "its columns are others");
    let moved = Ensemble::from_fn(1, free).integrate(1.0, Dop853::default()).unwrap();
    other.push(&moved.members()[0]).unwrap();
    refused(other.flush(), "the system or its equations are others");
    // A row whose member is made otherwise than the ensemble made it.
    let mut shifted = ParquetTable::open(&directory.0, |index| member(index + 1)).unwrap();
    let differs = "the start or the parameters of the member are others";
    assert_eq!(
        shifted.push(&outcome.members()[4]).unwrap_err(),
        Error::Ensemble(EnsembleError::OtherRun { member: 4, differs })
    );
}

/// The same but for the sign of a spring.
mod soft {
    use lagrange_core::prelude::*;

    #[derive(Lagrangian, Clone, Copy)]
    #[coordinates(a, b)]
    #[lagrangian(m[0]/2*a_dot^2 + m[1]/2*b_dot^2 - k/2*(a - b)^2 + k/4*a^4)]
    pub(super) struct Oscillators<T> {
        pub(super) m: [T; 2],
        pub(super) k: T,
    }
}

#[test]
fn tables_of_other_equations_are_refused() {
    let directory = Directory::new("equations");
    write_parts(&directory, &whole(), ALL, 1);
    let soft = |index: usize| {
        let (Oscillators { m, k }, start) = member(index);
        (soft::Oscillators { m, k }, start)
    };
    let mut other = ParquetTable::open(&directory.0, soft).unwrap();
    refused(other.read(), "the system or its equations are others");
    refused(other.clean(), "the system or its equations are others");
}

/// A second program writes without reading: nothing of it gets in, and the first goes on.
#[test]
fn rows_of_other_parameters_do_not_get_into_a_directory() {
    let outcome = whole();
    let stiff = |index: usize| {
        let (mut system, start) = member(index);
        system.k *= 2.0;
        (system, start)
    };
    let others = members_by(stiff).integrate_on_lanes(TO, method()).unwrap();
    // Members that are in both, before and behind those of the first.
    for [there, pushed] in [[0..40, 0..40], [0..40, 25..40], [0..10, 25..40], [25..40, 0..10]] {
        let directory = Directory::new("parameters");
        write_parts(&directory, &outcome, there.clone(), 2);
        let before = table_of(&directory);
        let mut table = ParquetTable::open(&directory.0, stiff).unwrap();
        others.members()[pushed].iter().for_each(|member| table.push(member).unwrap());
        let reason = "the start or the parameters of the member are others";
        refused(table.flush(), reason);
        refused(table.read(), reason);
        drop(table);
        assert_eq!(directory.files().len(), 2);
        assert_eq!(table_of(&directory), before);
        assert_eq!(before.rows().len(), there.len());
    }
}

/// Where member 0 is the same, rows are compared as soon as their members have been made.
#[test]
fn rows_are_compared_when_members_come_as_far() {
    let directory = Directory::new("later");
    write_parts(&directory, &whole(), 25..40, 1);
    let late = |index: usize| {
        let (mut system, start) = member(index);
        system.k *= if index > 20 { 2.0 } else { 1.0 };
        (system, start)
    };
    let others = members_by(late).integrate_on_lanes(TO, method()).unwrap();
    let mut table = ParquetTable::open(&directory.0, late).unwrap();
    others.members()[..10].iter().for_each(|member| table.push(member).unwrap());
    table.flush().unwrap();
    others.members()[20..30].iter().for_each(|member| table.push(member).unwrap());
    refused(table.flush(), "the start or the parameters of the member are others");
    drop(table);
    // What was the same is taken over.
    assert_eq!(table_of(&directory).rows().len(), 25);
    assert_eq!(
        expected(
            &members().resume_from(table_of(&directory)).unwrap().integrate_on_lanes(TO, method()).unwrap()
        ),
        expected(&whole())
    );
}

fn table_of(directory: &Directory) -> MemberTable<f64, Const<2>> {
    table(directory).read().expect("the table can be read")
}

#[test]
fn a_directory_that_cannot_be_is_an_error() {
    let directory = Directory::new("none");
    let file = directory.0.join("file");
    write(&file, "").unwrap();
    let opened = ParquetTable::<Oscillators<f64>>::open(file.join("below"), member);
    assert!(matches!(opened, Err(Error::Ensemble(EnsembleError::Parquet { .. }))));
}

/// The name of the file is that of its rows, so that it can be known before.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_and_the_rows_wait() {
    let outcome = whole();
    let elsewhere = Directory::new("elsewhere");
    write_parts(&elsewhere, &outcome, ALL, 1);
    let name = elsewhere.files()[0].with_extension("unfinished");
    let directory = Directory::new("full");
    let full = directory.0.join(name.file_name().unwrap());
    std::os::unix::fs::symlink("/dev/full", &full).unwrap();
    let mut table = table(&directory);
    outcome.members().iter().for_each(|member| table.push(member).unwrap());
    refused(table.flush(), "No space left");
    assert!(directory.files().is_empty(), "what was left of the file is removed");
    table.flush().unwrap();
    assert_eq!(table.read().unwrap(), expected(&outcome));
}
