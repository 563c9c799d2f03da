//! Samples, quantities and crossings of jobs that are killed: the same bits as without a kill.

use std::ops::ControlFlow;

use lagrange_core::ensemble::{EnsembleError, MemberEnding, MemberTable, Outcome};
use lagrange_core::{Ending, contact::Contact, generic::StaticLength, nalgebra::Const, prelude::*};

use lagrange_random::cases;
use lagrange_systems::{Ball, DoublePendulum};

use crate::{COUNT, END, arrival, ensemble, member, on_threads};

type Job<'a> = Ensemble<'a, DoublePendulum<f64>, true>;

const NAMES: [&str; 2] = ["energy, \"kinetic\"\nand potential", "ratio"];

/// Member 2 does not start, a quantity of member 7 fails on the way, the observer ends member 9, an event those that swing far.
/// Of the second quantity some values are infinite.
fn job<'a>() -> Job<'a> {
    let any = member(0).0;
    let far = any.event("far, \"out\"\n", |s| s.state().q[0].abs() - 1.0).terminal_at(3);
    let turns = any.event("turns", |s| s.state().v[1]);
    let bad = |index| {
        let (system, start) = member(index);
        (system, if index == 2 { State::at_rest([f64::NAN, 0.0]) } else { start })
    };
    let job = Ensemble::from_fn(COUNT, bad).observe(|index, state| match index == 9 && state.t > 1.5 {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    });
    let job = job.samples_at((0..=30).map(|k| 0.1 * f64::from(k))).event(far).event(turns).tag("first");
    job.quantity(NAMES[0], |s| s.energy()).quantity(NAMES[1], |s| {
        let is_seven = s.system().m[0] == member(7).0.m[0];
        if is_seven && s.time() > 1.0 { s.coordinate("nowhere") } else { Ok(1.0 / s.state().v[0]) }
    })
}

const LONG: f64 = 3.0;

/// By its method, alone or on lanes.
fn integrate(job: Job<'_>, on_lanes: bool) -> Outcome<f64, Const<2>> {
    match on_lanes {
        true => job.integrate_on_lanes(LONG, Dop853::default()).expect("an outcome"),
        false => job.integrate(LONG, Dop853::default()).expect("an outcome"),
    }
}

/// Runs the job until this many members are done, and is then killed in the middle of a row.
fn killed(
    job: Job<'_>,
    table: &mut String,
    after: usize,
    run: impl FnOnce(Job<'_>) -> Outcome<f64, Const<2>>,
) {
    let mut rows = Vec::new();
    let resumed = job.resume(table).expect("a table").on_progress(|progress| {
        rows.push(progress.member.json_line().to_string());
        if rows.len() == after { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    run(resumed);
    let torn = rows.pop().expect("a row");
    let cut = (torn.len() / 2..).find(|cut| torn.is_char_boundary(*cut)).expect("a boundary");
    *table += &(rows.concat() + &torn[..cut]);
}

/// The same in memory and in all bits: `Debug` prints numbers that read back to them, and a NaN equals itself.
fn assert_same<N: StaticLength>(resumed: &Outcome<f64, N>, whole: &Outcome<f64, N>) {
    assert_eq!(resumed.members().len(), whole.members().len());
    for (resumed, whole) in resumed.members().iter().zip(whole.members()) {
        assert_eq!(format!("{resumed:?}"), format!("{whole:?}"));
    }
    assert_eq!(resumed.json_lines().to_string(), whole.json_lines().to_string());
}

#[test]
fn a_job_killed_twice_has_the_bits_of_one_that_ran_through() {
    for on_lanes in [false, true] {
        let whole = on_threads(1, || integrate(job(), on_lanes));
        let infinite = |x: f64| x.is_infinite();
        let by_event = |index| matches!(arrival(&whole, index).ending, Ending::Event { .. });
        let ended = (0..COUNT).filter(|index| *index != 2 && by_event(*index)).count();
        assert!((3..COUNT - 3).contains(&ended), "{ended}");
        assert!(whole.quantity(0, NAMES[1]).unwrap().any(infinite));
        assert!(whole.members().iter().filter_map(|m| m.arrival()).any(|a| a.crossings.len() > 2));
        assert_eq!((whole.failures().count(), arrival(&whole, 7).samples.len()), (2, 11));
        for threads in [3, 1].into_iter().take(cases([1, 2, 2])) {
            let mut table = String::new();
            for after in [4, 7] {
                let run = |job: Job<'_>| on_threads(threads, || integrate(job, on_lanes));
                killed(job(), &mut table, after, run);
            }
            let (mut done, mut rest) = (0, String::new());
            let last = job().resume(&table).unwrap().on_progress(|progress| {
                done += 1;
                rest += &progress.member.json_line().to_string();
                ControlFlow::Continue(())
            });
            assert_same(&on_threads(threads, || integrate(last, on_lanes)), &whole);
            assert!(done <= COUNT - 5, "{done} were done again");
            // All rows that were written, cleaned and not.
            let read = MemberTable::read::<DoublePendulum<f64>>(&(table + "\n" + &rest)).unwrap();
            assert_eq!(read.to_string(), whole.json_lines().to_string());
            let by_event = MemberEnding::Event("far, \"out\"\n".into());
            assert_eq!(read.rows().iter().filter(|row| row.ending == by_event).count(), ended);
            let again = job().resume(&read.to_string()).unwrap();
            assert_same(&integrate(again, on_lanes), &whole);
        }
    }
}

/// Tables of shards: one after the other, line by line in turn, and merged in memory.
#[test]
fn shards_make_the_whole() {
    let whole = integrate(job(), true);
    let parts = [0, 1, 2].map(|k| integrate(job().shard(k, 3), true));
    let tables = parts.each_ref().map(|part| part.json_lines().to_string());
    let lines: Vec<Vec<&str>> = tables.iter().map(|table| table.lines().collect()).collect();
    let in_turn = (0..COUNT).flat_map(|k| lines.iter().filter_map(move |table| table.get(k)));
    let in_turn = in_turn.fold(String::new(), |all, line| all + line + "\n");
    for table in [tables.concat(), in_turn] {
        let again = job().resume(&table).unwrap();
        assert_same(&integrate(again, true), &whole);
    }
    let [one, two, three] = parts;
    assert_same(&one.merge(two).and_then(|two| two.merge(three)).unwrap(), &whole);
}

/// A row that was lost from the middle is done again; of rows in another order nothing is lost.
#[test]
fn lines_that_were_lost_or_moved_change_nothing() {
    let whole = integrate(job(), false);
    let table = whole.json_lines().to_string();
    let mut lines: Vec<&str> = table.lines().collect();
    lines.reverse();
    lines.remove(4);
    let mut done = Vec::new();
    let again = job().resume(&(lines.join("\n") + "\n")).unwrap().on_progress(|progress| {
        assert_eq!((progress.done, progress.of), (COUNT - 2 + done.len(), COUNT));
        done.push(progress.member.index);
        ControlFlow::Continue(())
    });
    let again = on_threads(1, || integrate(again, false));
    assert_same(&again, &whole);
    assert_eq!(done, [2, 7, COUNT - 5]);
}

#[test]
fn other_samples_quantities_and_events_are_other_runs() {
    let table = integrate(job(), false).json_lines().to_string();
    let others: [fn(Job<'_>) -> Job<'_>; 4] = [
        |job| job.samples_at([0.5]),
        |job| job.every(0.1),
        |job| job.quantity("third", |s| s.time()),
        |job| job.event(member(0).0.event("third", |s| s.state().q[1])),
    ];
    for other in others {
        let error = other(job()).resume(&table).unwrap().integrate(LONG, Dop853::default()).unwrap_err();
        assert!(matches!(error, Error::Ensemble(EnsembleError::OtherRun { member: 0, .. })), "{error}");
    }
    // Names that would read alike without quotes.
    let run = |names: &[&'static str]| {
        let plain = ensemble().samples_at([0.5]).tag("");
        names.iter().fold(plain, |run, name| run.quantity(name, |s| s.time()))
    };
    let table = run(&["u of v"]).integrate(END, Dop853::default()).unwrap().json_lines().to_string();
    let error = run(&["u", "v"]).resume(&table).unwrap().integrate(END, Dop853::default()).unwrap_err();
    assert!(error.to_string().contains("a sample, a quantity"), "{error}");
}

/// Two tables that say different things of a member, each whole in itself: values of a quantity, the time of an event.
#[test]
fn tables_that_contradict_each_other_are_refused() {
    let quantity = |shift: f64| ensemble().samples_at([0.5]).quantity("q", move |s| s.time() + shift);
    let event = |level: f64| {
        ensemble().event(member(0).0.event("far", move |s| s.time() - 0.5 + 2.5e14 * level).terminal())
    };
    for run in [&quantity as &dyn Fn(f64) -> Job<'static>, &event] {
        let run = |shift| run(shift).tag("");
        let [one, other] = [0.0, 1e-15]
            .map(|shift| run(shift).integrate(END, Dop853::default()).unwrap().json_lines().to_string());
        let both = run(0.0).resume(&one).unwrap().resume(&other).unwrap();
        let error = both.integrate(END, Dop853::default()).unwrap_err();
        assert!(matches!(error, Error::Ensemble(EnsembleError::OtherRun { member: 0, .. })), "{error}");
        assert!(matches!(
            run(0.0).resume(&(one + &other)),
            Err(Error::Ensemble(EnsembleError::Resume { reason, .. })) if reason.contains("another result")
        ));
    }
}

/// Columns of one name could not be told apart.
#[test]
fn quantities_need_names_of_their_own() {
    for name in ["t", "a", "b_dot", "again"] {
        let twice = ensemble().samples_at([0.5]).quantity("again", |s| s.time()).quantity(name, |s| s.time());
        let error = twice.integrate(END, Dop853::default()).unwrap_err();
        assert_eq!(error, Error::Ensemble(EnsembleError::QuantityName { name: name.into() }));
        assert_eq!(
            error.to_string(),
            format!(
                "the quantity `{name}` has the name of another quantity, of the time, of a coordinate or of a velocity: give it a name of its own"
            )
        );
    }
}

/// No samples, and quantities without samples: nothing is lost either.
#[test]
fn tables_of_runs_that_keep_nothing_are_resumed_too() {
    let run = || ensemble().samples_at([]).quantity("energy", |s| s.energy()).tag("");
    let whole = run().integrate(END, Dop853::default()).unwrap();
    let table = whole.json_lines().to_string();
    let again = run().resume(&table).unwrap().integrate(END, Dop853::default()).unwrap();
    assert_same(&again, &whole);
    assert_eq!(again.quantity(3, "energy").unwrap().count(), 0);
}

#[cfg(feature = "thorough")]
#[test]
fn single_precision_comes_back_to_the_bit() {
    use lagrange_systems::PushedSpring;

    let spring = |index: usize| {
        (
            PushedSpring { m: 1.0, k: 1.0 + index as f32 / 7.0, ..PushedSpring::default() },
            State::at_rest([1.0_f32]),
        )
    };
    let run = || {
        let zero = spring(0).0.event("zero", |s| s.state().q[0]);
        let springs = Ensemble::from_fn(9, spring).every(0.1).event(zero);
        springs.quantity("tension", |s| s.system().k * s.state().q[0]).tag("")
    };
    let method = Dop853::with_tolerance(1e-5);
    let whole = run().integrate(9.0, method).unwrap();
    let table = whole.json_lines().to_string();
    let again = run().resume(&table).unwrap().integrate(9.0, method).unwrap();
    assert_eq!(again, whole);
    assert_eq!(again.json_lines().to_string(), table);
}

#[test]
fn members_across_contacts_come_back_to_the_bit() {
    let ball = |k: usize| Ball { m: 1.0, g: 9.81, e: 0.1 * k as f64, ..Ball::default() };
    let run = || {
        let lands = ball(0).event("lands", |s| s.state().q[1]).falling();
        let balls = Ensemble::from_fn(8, |k| (ball(k), State::at_rest([0.0, 1.0]))).event(lands).every(0.1);
        balls.quantity("closed", |s| f64::from(s.system().floor == Contact::Closed)).tag("")
    };
    let whole = run().integrate_with_contacts(1.0, Dop853::default()).unwrap();
    assert!(whole.quantity(0, "closed").unwrap().any(|closed| closed == 1.0));
    let mut rows = String::new();
    let stopped = run().on_progress(|progress| {
        rows += &progress.member.json_line().to_string();
        if progress.done == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    stopped.integrate_with_contacts(1.0, Dop853::default()).unwrap();
    let again = run().resume(&rows).unwrap().integrate_with_contacts(1.0, Dop853::default()).unwrap();
    assert_same(&again, &whole);
}
