//! Parts of an ensemble, stopped and resumed, make the whole.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use lagrange_core::ensemble::{Arrival, EnsembleError, MemberEnding, MemberTable, Outcome};
use lagrange_core::{nalgebra::Const, prelude::*};
use lagrange_random::cases;
use lagrange_systems::DoublePendulum;
use serde_json::{Value, from_str, json, to_value};

use crate::{COUNT, END, Pendulum, arrival, ensemble, member, on_lanes, on_threads, steps};

fn whole() -> Outcome<f64, Const<2>> {
    on_lanes(ensemble())
}

const RUN: &str =
    "the method, one of its settings, a sample, a quantity, an event, the tag or the end is another";
const MEMBER: &str = "the start or the parameters of the member are others";
#[cfg(feature = "thorough")]
const SYSTEM: &str = "the system or its equations are others";

/// Line and reason of the row that an ensemble does not take over.
fn refused<L: Lagrangian>(resumed: Result<Ensemble<'_, L>, Error>) -> (usize, String)
where
    L::Scalar: lagrange_core::Real,
{
    match resumed {
        Err(Error::Ensemble(EnsembleError::Resume { line, reason })) => (line, reason),
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("not refused"),
    }
}

#[test]
fn the_parts_are_the_whole() {
    for parts in [COUNT + 3, 2, 5].into_iter().take(cases([1, 3, 3])) {
        let outcomes: Vec<_> = (0..parts).map(|k| on_lanes(ensemble().shard(k, parts))).collect();
        let sizes = || outcomes.iter().map(|part| part.members().len());
        assert!(sizes().sum::<usize>() == COUNT && sizes().max().unwrap() <= COUNT.div_ceil(parts));
        assert_eq!(outcomes.into_iter().rev().reduce(|a, b| a.merge(b).unwrap()).unwrap(), whole());
    }
}

/// Other code, or a library with other roundings, may have made one of them.
#[test]
fn two_results_of_a_member_are_not_merged() {
    let table = whole().json_lines().to_string();
    let line = table.lines().nth(2).unwrap();
    let number = arrival(&whole(), 2).state.q[0];
    let edited = line.replacen(&format!("{number:?}"), &format!("{:?}", number.next_up()), 1);
    let other = on_lanes(ensemble().resume(&table.replace(line, &edited)).unwrap());
    assert!(other != whole() && whole().merge(whole()).is_ok());
    let error = whole().merge(other).unwrap_err().to_string();
    assert!(error.contains("two results"), "{error}");
}

/// Any program that reads JSON finds the numbers by name.
#[test]
fn rows_name_their_numbers() {
    let failing = Ensemble::from_fn(COUNT, |index| {
        let (system, start) = member(index);
        (DoublePendulum { g: if index == 4 { f64::NAN } else { system.g }, ..system }, start)
    });
    let times = [0.0, END];
    let outcome = on_lanes(failing.samples_at(times).quantity("late", |s| (s.time() - END).recip()));
    let table = outcome.json_lines().to_string();
    let rows: Vec<Value> = table.lines().map(|line| from_str(line).unwrap()).collect();
    assert_eq!(rows.len(), COUNT);
    for (row, member) in rows.iter().zip(outcome.members()).filter(|(_, member)| member.index != 4) {
        let Arrival { state, samples, statistics, .. } = arrival(&outcome, member.index);
        let numbers = |s: &State<f64, 2>| json!({ "t": s.t, "a": s.q[0], "b": s.q[1], "a_dot": s.v[0], "b_dot": s.v[1] });
        let mut written: Vec<_> = samples.iter().map(numbers).collect();
        written.iter_mut().zip([json!(-1.0), json!("inf")]).for_each(|(sample, late)| sample["late"] = late);
        let expected = json!({
            "member": member.index, "fingerprint": to_value(member.fingerprint).unwrap(), "ending": "complete",
            "end": numbers(state), "statistics": to_value(statistics).unwrap(), "samples": written, "crossings": [],
        });
        assert_eq!(*row, expected);
    }
    let said = rows[4]["ending"].as_str().unwrap();
    assert!(rows[4]["end"].is_null() && said.starts_with("the parameter `g` is NaN"), "{said}");
}

#[test]
fn progress_never_goes_back() {
    for threads in [1, 4] {
        let mut seen = Vec::new();
        let watched = ensemble().on_progress(|progress| {
            seen.push((progress.done, progress.of));
            ControlFlow::Continue(())
        });
        on_threads(threads, || on_lanes(watched));
        assert_eq!(seen, (1..=COUNT).map(|done| (done, COUNT)).collect::<Vec<_>>());
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
fn parts_of_different_ensembles_are_not_put_together() {
    let bob = Pendulum { m: 1.0, g: 9.81, l: 1.0, u: 0.0 };
    let free = Ensemble::from_fn(2, |_| (bob, State::at_rest([0.0, -1.0])));
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
fn a_table_of_another_ensemble_is_refused() {
    let table = whole().json_lines().to_string();
    let fewer = Ensemble::from_fn(COUNT - 1, member).resume(&table).unwrap_err();
    assert_eq!(fewer, Error::Ensemble(EnsembleError::NoSuchMember { member: COUNT - 1, count: COUNT - 1 }));
    let renamed = table.replace(r#""b":"#, r#""c":"#);
    assert_eq!(refused(ensemble().resume(&renamed)), (1, "its columns are others".into()));
    // Not a table: nothing in it looks like a row that was cut off.
    let other = ensemble().resume("member,t,a,b\n0,1.0,0.5,0.25\n");
    assert_eq!(refused(other), (1, "a row is an object of JSON".into()));
}

#[test]
fn members_integrated_to_another_time_are_refused_where_they_belong_to_the_part() {
    let table = whole().get(4).unwrap().json_line().to_string();
    let later = |part| {
        let resumed = ensemble().resume(&table).unwrap().shard(part, 3);
        resumed.integrate_on_lanes(END + 1.0, Dop853::default())
    };
    assert_eq!(later(1).unwrap_err(), Error::Ensemble(EnsembleError::OtherRun { member: 4, differs: RUN }));
    assert!(later(0).is_ok());
}

/// What makes another member of one.
type Change = fn(&mut (DoublePendulum<f64>, State<f64, 2>));

/// What the members of a table are computed with, and what another run has instead.
#[test]
fn rows_of_another_run_are_refused_by_name() {
    let table = whole().json_lines().to_string();
    let resumed = |ensemble: Ensemble<'static, DoublePendulum<f64>>| ensemble.resume(&table).unwrap();
    let refused = |run: Result<Outcome<f64, Const<2>>, Error>| match run {
        Err(Error::Ensemble(EnsembleError::OtherRun { member, differs })) => (member, differs),
        other => panic!("{other:?}"),
    };
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
        assert_eq!(with(change), (5, MEMBER));
    }
    assert_eq!(
        resumed(ensemble()).integrate(END, method).unwrap_err().to_string(),
        format!(
            "member 0 of the table to resume from is of another run: {RUN}; resume with what made the table, or begin a new one"
        )
    );
}

/// Tables of parts one after the other, in one file, and twice.
#[test]
fn several_tables_are_taken_and_rows_given_twice_count_once() {
    let tables = [2, 0].map(|k| on_lanes(ensemble().shard(k, 3)).json_lines().to_string());
    let apart = tables.iter().fold(ensemble(), |ensemble, table| ensemble.resume(table).unwrap());
    let together = ensemble().resume(&tables.concat()).unwrap();
    let twice = ensemble().resume(&tables.concat()).unwrap().resume(&tables[1]).unwrap();
    for rest in [apart, together, twice] {
        let mut done = Vec::new();
        let rest = rest.on_progress(|progress| {
            done.push(progress.member.index);
            ControlFlow::Continue(())
        });
        assert_eq!(on_threads(1, || on_lanes(rest)), whole());
        done.sort_unstable();
        assert!(done.into_iter().eq((1..COUNT).step_by(3)));
    }
}

/// In single precision it is another system.
#[cfg(feature = "thorough")]
#[test]
fn rows_of_another_number_type_are_refused() {
    let single = Ensemble::from_fn(COUNT, |index| {
        let (DoublePendulum { m, l, g }, State { t, q, v }) = member(index);
        let system = DoublePendulum { m: m.map(|x| x as f32), l: l.map(|x| x as f32), g: g as f32 };
        (system, State { t: t as f32, q: q.map(|x| x as f32), v: v.map(|x| x as f32) })
    });
    let table = single.integrate(END as f32, Dop853::default()).unwrap().json_lines().to_string();
    assert_eq!(refused(ensemble().resume(&table)), (1, SYSTEM.into()));
}

/// The same struct with other equations.
#[cfg(feature = "thorough")]
mod other {
    #[derive(lagrange_core::Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 - k*x^3/3)]
    pub(super) struct Runaway<T> {
        pub(super) k: T,
    }
}

/// Functions that are given to a system of another name may differ, which no equation tells.
#[cfg(feature = "thorough")]
#[test]
fn rows_of_another_system_are_refused() {
    use crate::Runaway;

    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 + k*x^3/3)]
    struct Renamed<T> {
        k: T,
    }
    let (start, method) = (State::new([0.0], [0.1]), Dop853::default());
    let outcome = Ensemble::from_fn(2, |_| (Runaway { k: 1.0 }, start)).integrate(END, method).unwrap();
    let table = outcome.json_lines().to_string();
    let renamed = || Ensemble::from_fn(2, |_| (Renamed { k: 1.0 }, start));
    let other = || Ensemble::from_fn(2, |_| (other::Runaway { k: 1.0 }, start));
    assert_eq!(refused(renamed().resume(&table)), (1, SYSTEM.into()));
    assert_eq!(refused(other().resume(&table)), (1, SYSTEM.into()));
    let error = MemberTable::read::<other::Runaway<f64>>(&table).unwrap_err();
    assert_eq!(error, Error::Ensemble(EnsembleError::Resume { line: 1, reason: SYSTEM.into() }));
    let other = other().integrate(END, method).unwrap();
    let error = outcome.merge(other).unwrap_err();
    assert_eq!(error, Error::Ensemble(EnsembleError::Merge { reason: SYSTEM }));
}

/// Two runs in memory, and in one table, of which the first row of the second is refused.
#[test]
fn two_runs_are_not_put_together() {
    let coarse = ensemble().integrate_on_lanes(END, Dop853::with_tolerance(1e-8)).unwrap();
    let shifted = on_lanes(Ensemble::from_fn(COUNT, |index| member(index + 1)));
    for (other, reason) in [(coarse, RUN), (shifted, MEMBER)] {
        let mixed = whole().json_lines().to_string() + &other.json_lines().to_string();
        assert_eq!(refused(ensemble().resume(&mixed)), (COUNT + 1, reason.into()));
        let error = whole().merge(other).unwrap_err();
        assert_eq!(error, Error::Ensemble(EnsembleError::Merge { reason }));
    }
}

#[test]
fn a_table_is_read_and_cleaned_without_a_run() {
    let whole = whole();
    let taken = |index| steps(arrival(&whole, index)).iter().sum::<usize>();
    let mut taken: Vec<_> = (0..COUNT).map(taken).collect();
    taken.sort_unstable();
    let method = Dop853::default().max_steps(taken[COUNT / 2]);
    let limited = ensemble().integrate_on_lanes(END, method).unwrap();
    assert!(limited.failures().count() > 3 && limited.completed().count() > 0);
    let bad = |index| {
        let (system, start) = member(index);
        (system, if index == 2 { State::at_rest([f64::NAN, 0.0]) } else { start })
    };
    let bad = on_lanes(Ensemble::from_fn(COUNT, bad));
    let read = |table: &str| MemberTable::read::<DoublePendulum<f64>>(table).unwrap();
    for outcome in [&limited, &whole, &bad] {
        let table = read(&outcome.json_lines().to_string());
        assert_eq!(table.to_string(), outcome.json_lines().to_string());
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
        limited.members().iter().chain(whole.members()).map(|m| m.json_line().to_string()).collect();
    let shuffled: String = (0..rows.len()).map(|k| rows[k * 5 % rows.len()].as_str()).collect();
    for torn in [&rows[3][..20], &rows[7][..rows[7].len() - 2], ""] {
        let table = read(&format!("{shuffled}{torn}{}{}{shuffled}", rows[COUNT + 1], whole.json_lines()));
        assert_eq!(table.to_string(), whole.json_lines().to_string());
    }
}

#[test]
fn a_list_of_members_is_run_alone() {
    let whole = whole();
    let of_whole = |indices: &[usize], outcome: Outcome<f64, Const<2>>| {
        let expected: Vec<_> = indices.iter().map(|&index| whole.get(index).unwrap().clone()).collect();
        assert_eq!(outcome.members(), expected);
    };
    let few = || ensemble().members([17, 3, 8, 3, 12]);
    let mut seen = Vec::new();
    let watched = few().on_progress(|progress| {
        seen.push((progress.done, progress.of));
        ControlFlow::Continue(())
    });
    of_whole(&[3, 8, 12, 17], on_lanes(watched));
    assert_eq!(seen, [(1, 4), (2, 4), (3, 4), (4, 4)]);
    of_whole(&[3, 12], on_lanes(few().shard(0, 2)));
    of_whole(&[8, 17], on_lanes(few().shard(1, 2)));
    of_whole(&[], on_lanes(ensemble().members([])));
    // Of the table's rows only those in the list are taken.
    let table = on_lanes(ensemble().members([3, 4])).json_lines().to_string();
    of_whole(&[3, 8, 12, 17], on_lanes(few().resume(&table).unwrap()));
    let error = ensemble().members([3, COUNT]).integrate_on_lanes(END, Dop853::default()).unwrap_err();
    assert_eq!(error, Error::Ensemble(EnsembleError::NoSuchMember { member: COUNT, count: COUNT }));
    assert_eq!(error.to_string(), "there is no member 19: the ensemble has 19, counted from 0");
}
