//! Parts of an ensemble, stopped and resumed, make the whole.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use lagrange_core::ensemble::EnsembleError;
use lagrange_core::ensemble::{Member, MemberEnding, MemberTable, Outcome};
use lagrange_core::{nalgebra::Const, prelude::*};

use crate::{COUNT, DoublePendulum, END, ensemble, member, on_threads};

fn whole() -> Outcome<f64, Const<2>> {
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
        let together = (0..parts).rev().map(run).reduce(|a, b| a.merge(b).unwrap()).unwrap();
        assert_eq!(together, whole());
    }
}

/// Other code, or a library with other roundings, may have made one of them.
#[test]
fn two_results_of_a_member_are_not_merged() {
    let table = whole().csv().to_string();
    let line = table.lines().nth(3).unwrap();
    let number = line.split(',').nth(5).unwrap();
    let digit = if number.ends_with('1') { "2" } else { "1" };
    let edited = line.replacen(number, &format!("{}{digit}", &number[..number.len() - 1]), 1);
    let other = ensemble().resume(&table.replace(line, &edited)).unwrap();
    let other = other.integrate_on_lanes(END, Dop853::default()).unwrap();
    assert!(other != whole() && whole().merge(whole()).is_ok());
    let error = whole().merge(other).unwrap_err().to_string();
    assert!(error.contains("two results"), "{error}");
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
        Some(
            "member,system,run,start,t,a,b,a_dot,b_dot,accepted,rejected,evaluations,multipliers_are_unique,ending,samples,crossings,member_again"
        )
    );
    assert_eq!(lines.clone().count(), COUNT);
    let line = lines.nth(4).unwrap();
    let (index, rest) = line.split_once(',').unwrap();
    let cells: Vec<&str> = rest.splitn(4, ',').collect();
    assert!(index == "4" && cells[..3].iter().all(|hash| hash.parse::<u32>().is_ok()), "{line}");
    assert!(cells[3].starts_with(",,,,,,,,,\"the parameter `g` is NaN"), "{line}");
    // What is done is not done again, and what failed is.
    let count = AtomicUsize::new(0);
    let again = failing().resume(&table).unwrap().on_progress(|progress| {
        count.fetch_add(1, Ordering::Relaxed);
        assert_eq!((progress.done, progress.of, progress.member.index), (COUNT, COUNT, 4));
        ControlFlow::Continue(())
    });
    assert_eq!(again.integrate_on_lanes(END, Dop853::default()).unwrap().csv().to_string(), table);
    assert_eq!(count.into_inner(), 1);
}

#[test]
fn progress_never_goes_back() {
    for threads in [1, 4] {
        let mut seen = Vec::new();
        let watched = ensemble().on_progress(|progress| {
            seen.push((progress.done, progress.of));
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
        let stopped = ensemble().on_progress(|progress| {
            rows += &progress.member.csv().to_string();
            if progress.done == 10 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let first = on_threads(threads, || stopped.integrate_on_lanes(END, Dop853::default()).unwrap());
        assert_eq!(first.members().len(), 10);
        // The last row was not written to its end.
        rows.truncate(rows.len() - 3);
        let resumed = || ensemble().resume(&rows).unwrap();
        assert_eq!(resumed().integrate_on_lanes(END, Dop853::default()).unwrap(), whole());
        // Each part takes from the table what is its own.
        let part = |k| resumed().shard(k, 3).integrate_on_lanes(END, Dop853::default()).unwrap();
        assert_eq!(part(0).merge(part(1)).and_then(|two| two.merge(part(2))).unwrap(), whole());
    }
}

/// The first is ended after a few steps, and all with it, while the others are on their way to their limit on steps.
#[test]
fn members_on_their_way_stop_too() {
    const LIMIT: usize = 10_000;
    for (threads, on_lanes) in [(1, true), (3, true), (3, false)] {
        let steps: [AtomicUsize; 8] = std::array::from_fn(|_| AtomicUsize::new(0));
        let others = || steps.iter().skip(1).map(|steps| steps.load(Ordering::SeqCst));
        let mut calls = Vec::new();
        let ensemble = Ensemble::from_fn(8, member)
            .observe(|index, _| {
                let taken = steps[index].fetch_add(1, Ordering::SeqCst);
                if (index, taken) == (0, 5) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
            .on_progress(|progress| {
                calls.push(progress.member.index);
                while others().sum::<usize>() == 0 {
                    std::thread::yield_now();
                }
                ControlFlow::Break(())
            });
        let method = Dop853::default().max_steps(LIMIT);
        let outcome = on_threads(threads, || match on_lanes {
            true => ensemble.integrate_on_lanes(1e6, method).unwrap(),
            false => ensemble.integrate(1e6, method).unwrap(),
        });
        assert!(outcome.members().iter().map(|member| member.index).eq([0]), "{outcome:?}");
        assert_eq!(calls, [0]);
        assert!(others().all(|steps| steps < LIMIT / 2), "{:?}", others().collect::<Vec<_>>());
    }
}

#[test]
fn members_that_end_after_the_stop_are_not_shown() {
    for on_lanes in [false, true] {
        let mut shown = Vec::new();
        let ensemble = ensemble().on_progress(|progress| {
            shown.push(progress.member.index);
            if progress.done == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let outcome = on_threads(4, || match on_lanes {
            // Steps of one size, so that four end at once.
            true => ensemble.integrate_on_lanes(END, Dop853::default().fixed_step(0.1)).unwrap(),
            false => ensemble.integrate(END, Dop853::default()).unwrap(),
        });
        shown.sort_unstable();
        assert_eq!(shown.len(), 5);
        assert!(shown.iter().copied().eq(outcome.members().iter().map(|member| member.index)));
    }
}

#[test]
fn tables_given_one_after_the_other_are_all_taken() {
    let part = |k| ensemble().shard(k, 3).integrate_on_lanes(END, Dop853::default()).unwrap();
    let tables = [part(2), part(0)].map(|part| part.csv().to_string());
    let mut done = Vec::new();
    let rest = tables.iter().fold(ensemble(), |ensemble, table| ensemble.resume(table).unwrap());
    let rest = rest.on_progress(|progress| {
        done.push(progress.member.index);
        ControlFlow::Continue(())
    });
    assert_eq!(on_threads(1, || rest.integrate_on_lanes(END, Dop853::default()).unwrap()), whole());
    done.sort_unstable();
    assert!(done.into_iter().eq((1..COUNT).step_by(3)));
}

/// Killed in the middle of a row, and the rows of the next run written behind it.
#[test]
fn rows_that_ran_into_each_other_are_no_row() {
    let whole = whole();
    let rows: Vec<String> = whole.members().iter().map(|member| member.csv().to_string()).collect();
    for torn in [1, 3, 12] {
        for next in [3, 12] {
            for length in 1..rows[torn].len() {
                let table = rows[0].clone() + &rows[torn][..length] + &rows[next] + &rows[5];
                let read = MemberTable::read::<DoublePendulum<f64>>(&table).unwrap();
                let known = [0, 5].map(|index| whole.members()[index].row());
                assert_eq!(read.rows(), known, "{table}");
            }
        }
    }
}

#[test]
fn parts_of_different_ensembles_are_not_put_together() {
    #[derive(Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(m*(x_dot^2 + y_dot^2)/2)]
    struct Free {
        m: f64,
    }
    let free = Ensemble::from_fn(2, |_| (Free { m: 1.0 }, State::at_rest([0.0; 2])));
    let free = free.integrate(END, Dop853::default()).unwrap();
    let later = ensemble().integrate(END + 1.0, Dop853::default()).unwrap();
    for (other, reason) in
        [(free, "their coordinates differ"), (later, "they were integrated to different times")]
    {
        let error = whole().merge(other).unwrap_err();
        assert_eq!(error.to_string(), format!("the outcomes are not parts of one ensemble: {reason}"));
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
    let reason = |ensemble: Result<Ensemble<'_, DoublePendulum<f64>>, Error>| match ensemble {
        Err(Error::Ensemble(EnsembleError::Resume { line, column, reason })) => (line, column, reason),
        _ => panic!("not refused"),
    };
    let fewer = Ensemble::from_fn(COUNT - 1, member);
    assert_eq!(reason(fewer.resume(&table)), (COUNT + 1, 1, "there is no such member"));
    assert_eq!(reason(ensemble().resume(&table.replace(",b,", ",c,"))), (1, 7, "its columns are others"));
    for (broken, column, why) in [
        ("x\n", 1, "a row starts with the index of a member"),
        ("3,7,7,7,1.0,1,2,3,4,5,6,7,true,fine,,,3\n", 14, "it cannot be read"),
        ("3,7,7,7,1.0,1,2,3,4.x,5,6,7,true,complete,,,3\n", 9, "it is no finite number"),
    ] {
        let rows = format!("{}{broken}", table.lines().next().unwrap().to_owned() + "\n");
        assert_eq!(reason(ensemble().resume(&rows)), (2, column, why));
    }
    let failed = format!("{COUNT},7,7,7{}\"why, no more\",,,{COUNT}\n", ",".repeat(10));
    assert_eq!(reason(ensemble().resume(&failed)), (1, 1, "there is no such member"));
}

#[test]
fn members_integrated_to_another_time_are_refused_where_they_belong_to_the_part() {
    let table = whole().get(4).unwrap().csv().to_string();
    let later = |part| {
        let resumed = ensemble().resume(&table).unwrap().shard(part, 3);
        resumed.integrate_on_lanes(END + 1.0, Dop853::default())
    };
    let differs =
        "the method, one of its settings, a sample, a quantity, an event, the tag or the end is another";
    assert_eq!(later(1).unwrap_err(), Error::Ensemble(EnsembleError::OtherRun { member: 4, differs }));
    assert!(later(0).is_ok());
}

/// What makes another member of one.
type Change = fn(&mut (DoublePendulum<f64>, State<f64, 2>));

/// What the members of a table are computed with, and what another run has instead.
#[test]
fn rows_of_another_run_are_refused_by_name() {
    let table = whole().csv().to_string();
    let resumed = |ensemble: Ensemble<'static, DoublePendulum<f64>>| ensemble.resume(&table).unwrap();
    let refused = |run: Result<Outcome<f64, Const<2>>, Error>| match run {
        Err(Error::Ensemble(EnsembleError::OtherRun { member, differs })) => (member, differs),
        other => panic!("{other:?}"),
    };
    const RUN: &str =
        "the method, one of its settings, a sample, a quantity, an event, the tag or the end is another";
    let method = Dop853::default();
    let others = [
        method.relative_tolerance(1e-10),
        method.absolute_tolerance(1e-10),
        method.max_step(0.1),
        method.first_step(0.01),
    ];
    for other in others.into_iter().chain([method.fixed_step(0.01)]) {
        assert_eq!(refused(resumed(ensemble()).integrate_on_lanes(END, other)), (0, RUN));
    }
    assert_eq!(refused(resumed(ensemble()).integrate_on_lanes(END, Dopri5::default())), (0, RUN));
    assert_eq!(refused(resumed(ensemble()).integrate(END, method)), (0, RUN));
    // The limits are no part of it.
    let free = method.max_steps(7_000_000).wall_time(std::time::Duration::from_secs(9));
    assert_eq!(resumed(ensemble()).integrate_on_lanes(END, free).unwrap(), whole());
    let start = "the start or the parameters of the member are others";
    let with = |change: Change| {
        let other = Ensemble::from_fn(COUNT, move |index| {
            let mut member = member(index);
            if index == 5 {
                change(&mut member);
            }
            member
        });
        refused(resumed(other).integrate_on_lanes(END, method))
    };
    let changes: [Change; 6] = [
        |(system, _)| system.m[1] = system.m[1].next_up(),
        |(system, _)| system.l[0] = system.l[0].next_down(),
        |(system, _)| system.g += 1.0,
        |(_, start)| start.q[1] = start.q[1].next_up(),
        |(_, start)| start.v[0] = -0.0,
        |(_, start)| start.t = 1e-300,
    ];
    for change in changes {
        assert_eq!(with(change), (5, start));
    }
    assert_eq!(
        resumed(ensemble()).integrate(END, method).unwrap_err().to_string(),
        "member 0 of the table to resume from is of another run: the method, one of its settings, a sample, a quantity, an event, the tag or the end is another; resume with what made the table, or begin a new one"
    );
}

#[test]
fn rows_given_twice_count_once() {
    let table = whole().csv().to_string();
    let twice = ensemble().resume(&table).unwrap().resume(&table).unwrap();
    assert_eq!(twice.integrate_on_lanes(END, Dop853::default()).unwrap(), whole());
}

/// The first row, which follows the header.
const OTHER_SYSTEM: Error = Error::Ensemble(EnsembleError::Resume {
    line: 2,
    column: 2,
    reason: "the system or its equations are others",
});

/// In single precision it is another system.
#[test]
fn rows_of_another_number_type_are_refused() {
    let single = Ensemble::from_fn(COUNT, |index| {
        let (DoublePendulum { m, l, g }, State { t, q, v }) = member(index);
        let system = DoublePendulum { m: m.map(|x| x as f32), l: l.map(|x| x as f32), g: g as f32 };
        (system, State { t: t as f32, q: q.map(|x| x as f32), v: v.map(|x| x as f32) })
    });
    let table = single.integrate(END as f32, Dop853::default()).unwrap().csv().to_string();
    assert_eq!(ensemble().resume(&table).unwrap_err(), OTHER_SYSTEM);
}

/// Functions that are given to it may differ, which no equation tells.
#[test]
fn rows_of_a_system_of_another_name_are_refused() {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2)]
    struct Free;
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2)]
    struct Loose;

    let start = State::new([0.0], [1.0]);
    let free = Ensemble::from_fn(2, |_| (Free, start)).integrate(END, Dop853::default()).unwrap();
    let loose = Ensemble::from_fn(2, |_| (Loose, start)).resume(&free.csv().to_string());
    assert_eq!(loose.unwrap_err(), OTHER_SYSTEM);
}

/// The same struct but for the sign of the weight.
mod upward {
    use lagrange_core::prelude::*;

    #[derive(Lagrangian, Clone, Copy)]
    #[coordinates(a, b)]
    #[lagrangian(
        (m[0] + m[1])/2*l[0]^2*a_dot^2 + m[1]/2*l[1]^2*b_dot^2 + m[1]*l[0]*l[1]*a_dot*b_dot*cos(a - b)
            - (m[0] + m[1])*g*l[0]*cos(a) + m[1]*g*l[1]*cos(b)
    )]
    pub(super) struct DoublePendulum<T> {
        pub(super) m: [T; 2],
        pub(super) l: [T; 2],
        pub(super) g: T,
    }
}

#[test]
fn rows_of_other_equations_are_refused() {
    let other = || {
        Ensemble::from_fn(COUNT, |index| {
            let (DoublePendulum { m, l, g }, start) = member(index);
            (upward::DoublePendulum { m, l, g }, start)
        })
    };
    let reason = "the system or its equations are others";
    let table = whole().csv().to_string();
    assert_eq!(other().resume(&table).unwrap_err(), OTHER_SYSTEM);
    assert_eq!(MemberTable::read::<upward::DoublePendulum<f64>>(&table).unwrap_err(), OTHER_SYSTEM);
    let outcome = other().integrate_on_lanes(END, Dop853::default()).unwrap();
    assert_eq!(whole().merge(outcome).unwrap_err(), Error::Ensemble(EnsembleError::Merge { reason }));
    let coarse = ensemble().integrate_on_lanes(END, Dop853::with_tolerance(1e-8)).unwrap();
    let reason =
        "the method, one of its settings, a sample, a quantity, an event, the tag or the end is another";
    assert_eq!(whole().merge(coarse.clone()).unwrap_err(), Error::Ensemble(EnsembleError::Merge { reason }));
    // Two runs in one table: the first row of the second is refused.
    let mixed = whole().csv().to_string() + &coarse.csv().to_string();
    let line = COUNT + 3;
    assert_eq!(
        ensemble().resume(&mixed).unwrap_err(),
        Error::Ensemble(EnsembleError::Resume { line, column: 3, reason })
    );
    let shifted = Ensemble::from_fn(COUNT, |index| member(index + 1));
    let shifted = shifted.integrate_on_lanes(END, Dop853::default()).unwrap();
    let reason = "the start or the parameters of the member are others";
    assert_eq!(whole().merge(shifted.clone()).unwrap_err(), Error::Ensemble(EnsembleError::Merge { reason }));
    let mixed = whole().csv().to_string() + &shifted.csv().to_string();
    assert_eq!(
        ensemble().resume(&mixed).unwrap_err(),
        Error::Ensemble(EnsembleError::Resume { line, column: 4, reason })
    );
}

#[test]
fn a_table_is_read_and_cleaned_without_a_run() {
    let whole = whole();
    let arrivals = whole.members().iter().filter_map(Member::arrival);
    let mut steps: Vec<_> = arrivals.map(|a| a.statistics.accepted + a.statistics.rejected).collect();
    steps.sort_unstable();
    let method = Dop853::default().max_steps(steps[COUNT / 2]);
    let limited = ensemble().integrate_on_lanes(END, method).unwrap();
    assert!(limited.failures().count() > 3 && limited.completed().count() > 0);
    let bad = |index| {
        let (system, start) = member(index);
        (system, if index == 2 { State::at_rest([f64::NAN, 0.0]) } else { start })
    };
    let bad = Ensemble::from_fn(COUNT, bad).integrate_on_lanes(END, Dop853::default()).unwrap();
    let read = |table: &str| MemberTable::read::<DoublePendulum<f64>>(table).unwrap();
    for outcome in [&limited, &whole, &bad] {
        let table = read(&outcome.csv().to_string());
        assert_eq!(table.to_string(), outcome.csv().to_string());
        for (row, member) in table.rows().iter().zip(outcome.members()) {
            assert_eq!((row.index, row.fingerprint), (member.index, member.fingerprint));
            let arrival = member.arrival();
            assert_eq!(row.state, arrival.map(|arrival| arrival.state));
            assert_eq!(row.statistics, arrival.map(|arrival| arrival.statistics).unwrap_or_default());
            assert_eq!(row.has_failed(), member.has_failed());
            if let MemberEnding::Failed(why) = &row.ending {
                assert_eq!(format!("member {}: {why}", row.index), member.to_string());
            }
        }
        assert_eq!(table.get(3).unwrap().index, 3);
        assert!(table.get(COUNT).is_none());
    }
    // Rows of both, in any order, twice, cut in the middle: those that arrived are kept.
    let rows: Vec<String> =
        limited.members().iter().chain(whole.members()).map(|m| m.csv().to_string()).collect();
    let shuffled: String = (0..rows.len()).map(|k| rows[k * 5 % rows.len()].as_str()).collect();
    for torn in [&rows[3][..20], &rows[7][..rows[7].len() - 2], ""] {
        let table = read(&format!("{shuffled}{torn}{}{}{shuffled}", rows[COUNT + 1], whole.csv()));
        assert_eq!(table.to_string(), whole.csv().to_string());
    }
}

#[test]
fn a_list_of_members_is_run_alone() {
    let of_whole = |indices: &[usize], outcome: Outcome<f64, Const<2>>| {
        let whole = whole();
        let expected: Vec<_> = indices.iter().map(|&index| whole.get(index).unwrap().clone()).collect();
        assert_eq!(outcome.members(), expected);
    };
    let few = || ensemble().members([17, 3, 8, 3, 12]);
    let mut seen = Vec::new();
    let watched = few().on_progress(|progress| {
        seen.push((progress.done, progress.of));
        ControlFlow::Continue(())
    });
    of_whole(&[3, 8, 12, 17], watched.integrate_on_lanes(END, Dop853::default()).unwrap());
    assert_eq!(seen, [(1, 4), (2, 4), (3, 4), (4, 4)]);
    of_whole(&[3, 12], few().shard(0, 2).integrate_on_lanes(END, Dop853::default()).unwrap());
    of_whole(&[8, 17], few().shard(1, 2).integrate_on_lanes(END, Dop853::default()).unwrap());
    of_whole(&[], ensemble().members([]).integrate_on_lanes(END, Dop853::default()).unwrap());
    // Of the table's rows only those in the list are taken.
    let table =
        ensemble().members([3, 4]).integrate_on_lanes(END, Dop853::default()).unwrap().csv().to_string();
    of_whole(
        &[3, 8, 12, 17],
        few().resume(&table).unwrap().integrate_on_lanes(END, Dop853::default()).unwrap(),
    );
    let error = ensemble().members([3, COUNT]).integrate_on_lanes(END, Dop853::default()).unwrap_err();
    assert_eq!(error, Error::Ensemble(EnsembleError::NoSuchMember { member: COUNT, count: COUNT }));
    assert_eq!(error.to_string(), "there is no member 19: the ensemble has 19, counted from 0");
}
