//! Parts of an ensemble, stopped and resumed, make the whole.

use std::ops::ControlFlow;

use lagrange_core::ensemble::Outcome;
use lagrange_core::prelude::*;

use crate::{COUNT, DoublePendulum, END, ensemble, member, on_threads};

fn whole() -> Outcome<f64, 2> {
    ensemble().integrate_on_lanes(END, Dop853::default()).expect("an outcome")
}

#[test]
fn the_parts_are_the_whole() {
    for parts in [2, 5, COUNT + 3] {
        let run = |k| ensemble().shard(k, parts).integrate_on_lanes(END, Dop853::default()).unwrap();
        let sizes = (0..parts).map(|k| run(k).members().len());
        assert!(
            sizes.clone().sum::<usize>() == COUNT && sizes.clone().max().unwrap() <= COUNT.div_ceil(parts)
        );
        let together = (0..parts).rev().map(run).reduce(Outcome::merge).unwrap();
        assert_eq!(together, whole());
    }
}

#[test]
fn a_table_reads_back_the_same() {
    let failing = || {
        Ensemble::from_fn(COUNT, |index| {
            let (system, start) = member(index);
            (DoublePendulum { g: if index == 4 { f64::NAN } else { system.g }, ..system }, start)
        })
    };
    let outcome = failing().integrate_on_lanes(END, Dop853::default()).unwrap();
    let table = outcome.csv().to_string();
    let mut lines = table.lines();
    assert_eq!(
        lines.next(),
        Some("member,t,a,b,a_dot,b_dot,accepted,rejected,evaluations,multipliers_are_unique,ending")
    );
    assert_eq!(lines.clone().count(), COUNT);
    let line = lines.nth(4).unwrap();
    assert!(line.starts_with("4,,,,,,,,,,\"the equations are not finite at t = 0; row of"), "{line}");
    // What is done is not done again, and what failed is.
    let count = std::sync::atomic::AtomicUsize::new(0);
    let again = failing().resume(&table).unwrap().on_progress(|headway| {
        count.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        assert_eq!((headway.done, headway.of, headway.member.index), (COUNT, COUNT, 4));
        ControlFlow::Continue(())
    });
    assert_eq!(again.integrate_on_lanes(END, Dop853::default()).unwrap().csv().to_string(), table);
    assert_eq!(count.into_inner(), 1);
}

#[test]
fn progress_never_goes_back() {
    for threads in [1, 4] {
        let mut seen = Vec::new();
        let watched = ensemble().on_progress(|headway| {
            seen.push((headway.done, headway.of));
            ControlFlow::Continue(())
        });
        on_threads(threads, || watched.integrate_on_lanes(END, Dop853::default()).unwrap());
        assert_eq!(seen, (1..=COUNT).map(|done| (done, COUNT)).collect::<Vec<_>>());
    }
}

#[test]
fn what_was_stopped_goes_on() {
    for threads in [1, 3] {
        let mut rows = String::new();
        let stopped = ensemble().on_progress(|headway| {
            rows += &headway.member.csv().to_string();
            if headway.done == 10 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let first = on_threads(threads, || stopped.integrate_on_lanes(END, Dop853::default()).unwrap());
        assert!(first.members().len() >= 10 && first.members().len() < COUNT);
        // The last row was not written to its end.
        rows.truncate(rows.len() - 3);
        let resumed = || ensemble().resume(&rows).unwrap();
        assert_eq!(resumed().integrate_on_lanes(END, Dop853::default()).unwrap(), whole());
        // Each part takes from the table what is its own.
        let part = |k| resumed().shard(k, 3).integrate_on_lanes(END, Dop853::default()).unwrap();
        assert_eq!(part(0).merge(part(1)).merge(part(2)), whole());
    }
}

#[test]
fn tables_of_several_parts_may_stand_in_one_file() {
    let part =
        |k| ensemble().shard(k, 3).integrate_on_lanes(END, Dop853::default()).unwrap().csv().to_string();
    let table = part(2) + &part(0);
    let rest = ensemble().resume(&table).unwrap().integrate_on_lanes(END, Dop853::default()).unwrap();
    assert_eq!(rest, whole());
}

#[test]
fn a_table_of_another_ensemble_is_refused() {
    let table = whole().csv().to_string();
    let reason = |ensemble: Result<Ensemble<'_, DoublePendulum<f64>, f64, 2>, Error>| match ensemble {
        Err(Error::Resume { line, reason }) => (line, reason),
        _ => panic!("not refused"),
    };
    let fewer = Ensemble::from_fn(COUNT - 1, member);
    assert_eq!(reason(fewer.resume(&table)), (COUNT + 1, "there is no such member"));
    assert_eq!(reason(ensemble().resume(&table.replace(",b,", ",c,"))), (1, "its coordinates are others"));
    for broken in
        ["3,1.0,2.0\n", "x\n", "3,1.0,1,2,3,4,5,6,7,true,fine\n", "3,1.0,1,2,3,4.x,5,6,7,true,complete\n"]
    {
        let rows = format!("{}{broken}", table.lines().next().unwrap().to_owned() + "\n");
        assert_eq!(reason(ensemble().resume(&rows)), (2, "it is no row of such a table"));
    }
    let other_end = ensemble().resume(&table).unwrap().integrate_on_lanes(END + 1.0, Dop853::default());
    assert_eq!(
        other_end.unwrap_err().to_string(),
        "line 2 of the table to resume from is not of this ensemble: it was integrated to another time"
    );
}
