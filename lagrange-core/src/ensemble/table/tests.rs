//! Truncated, concatenated, edited and foreign tables: read, or rejected with line and column.

use nalgebra::Const;

use super::row::entry;
use super::*;
use crate::solution::crossing::Crossing;
use crate::statistics::Statistics;
use crate::system::State;

const NAMES: &[&str] = &["x"];
const EVENTS: [&str; 2] = ["up, \"again\"\r\n", "down\\u000a"];

fn names() -> Arc<ColumnNames> {
    Arc::new(ColumnNames { coordinates: NAMES, quantities: vec!["a, \"b\"\n\\".into(), "c".into()] })
}

/// Samples and crossings of a member; numbers of every kind but NaN, which does not equal itself.
fn kept(count: usize) -> (Vec<State<f64, Const<1>>>, Vec<f64>, Vec<Crossing<f64, Const<1>>>) {
    let states: Vec<_> = (0..count).map(|k| State::new([-0.0], [5e-324]).at_time(k as f64 / 3.0)).collect();
    let numbers = [f64::INFINITY, f64::NEG_INFINITY, -0.0, f64::MAX, 5e-324, 1e23, 0.1 + 0.2];
    let values = numbers.into_iter().cycle().take(2 * count).collect();
    let crossing = |k: usize| Crossing {
        event: EVENTS[k % 2],
        index: k % 2,
        count: 1 + k / 2,
        rising: k.is_multiple_of(3),
        state: states[k],
    };
    let crossings = (0..count / 2).map(crossing).collect();
    (states, values, crossings)
}

/// The bits of the numbers of a member.
fn bits(member: &Member<f64, Const<1>>) -> Vec<u64> {
    let Some(Arrival { state, samples, values, crossings, .. }) = member.arrival() else { return vec![] };
    let states = [state].into_iter().chain(samples).chain(crossings.iter().map(|crossing| &crossing.state));
    let entries = states.flat_map(|state| (0..3).map(|place| entry(state, place)));
    entries.chain(values.iter().copied()).map(f64::to_bits).collect()
}

const COUNT: usize = 30;
const MINE: Fingerprint = Fingerprint { system: 71, run: 4_294_967_295, start: 0 };

/// Complete table of the members 3 (one sample, no crossing), 12 (which failed) and 21 (seven samples, three crossings).
fn table() -> String {
    outcome().csv().to_string()
}

fn outcome() -> Outcome<f64, Const<1>> {
    let member = |index, result| Member { index, fingerprint: MINE, names: names(), result };
    let arrived = |index: usize, time: f64, ending| {
        let (samples, values, crossings) = kept(index / 3);
        let arrival = Arrival {
            state: State::new([-1.0 / 3.0], [2e-300]).at_time(time),
            ending,
            statistics: Statistics {
                accepted: 12,
                rejected: 3,
                evaluations: 123,
                multipliers_are_unique: true,
            },
            samples,
            values,
            crossings,
            transitions: Vec::new(),
        };
        member(index, Ok(arrival))
    };
    let failed = member(12, Err(Error::Setting { name: "a \"setting\",\n 12", value: f64::NAN }));
    let complete = arrived(3, 1.0, Ending::Complete { time: 1.0 });
    let members = vec![complete, failed, arrived(21, 0.25, Ending::Cancelled { time: 0.25 })];
    Outcome::new(members, names(), (1.0, MINE))
}

fn resume(table: &str) -> Result<Vec<Member<f64, Const<1>>>, Error> {
    let rows = MemberTable::of(table, NAMES, MINE.system, COUNT)?.into_rows().filter(|row| !row.has_failed());
    rows.map(|row| row.into_member(&EVENTS, &names())).collect()
}

fn taken(table: &str) -> Vec<Member<f64, Const<1>>> {
    resume(table).unwrap_or_else(|error| panic!("{error} in {table:?}"))
}

#[track_caller]
fn refused(table: &str, place: (usize, usize)) {
    match resume(table) {
        Err(Error::Ensemble(EnsembleError::Resume { line, column, .. })) => {
            assert_eq!((line, column), place, "{table:?}");
        }
        other => panic!("{other:?} for {table:?}"),
    }
}

/// A truncated table gives exactly the members whose rows are complete.
#[test]
fn a_table_cut_anywhere_loses_and_invents_nothing() {
    let table = table();
    let all = taken(&table);
    assert_eq!(all.iter().map(|member| member.index).collect::<Vec<_>>(), [3, 21]);
    for table in [table.clone(), table.replace('\n', "\r\n"), format!("\u{feff}{table}")] {
        let mut lines = table.split_inclusive('\n').scan(0, |end, line| {
            *end += line.len();
            Some((*end - (line.len() - line.trim_end().len()), line))
        });
        let ends: Vec<usize> =
            lines.by_ref().filter(|(_, line)| !line.contains("member")).map(|(end, _)| end).collect();
        for cut in (0..=table.len()).filter(|&cut| table.is_char_boundary(cut)) {
            let whole = usize::from(cut >= ends[0]) + usize::from(cut >= ends[2]);
            assert_eq!(taken(&table[..cut]), all[..whole], "cut at {cut}");
        }
    }
}

#[test]
fn what_is_appended_to_a_cut_table_counts_from_the_next_line_on() {
    let table = table();
    let all = taken(&table);
    for cut in 0..=table.len() {
        let joined = taken(&format!("{}{table}", &table[..cut]));
        // If a row is complete in both halves, the first counts; that is decided later.
        assert!(joined.iter().all(|member| all.contains(member)), "cut at {cut}: {joined:?}");
        assert!(all.iter().all(|member| joined.contains(member)), "cut at {cut}: {joined:?}");
        // Rows without a header: the row in the truncated line is lost, and is integrated again.
        let rows = table.split_once('\n').unwrap().1;
        let joined = taken(&format!("{}{rows}", &table[..cut]));
        assert!(joined.iter().all(|member| all.contains(member)) && joined.contains(&all[1]), "cut at {cut}");
    }
}

#[test]
fn lines_twice_and_empty_lines_change_nothing() {
    let table = table();
    let twice: String = table.lines().map(|line| format!("{line}\n\n{line}\n")).collect();
    let mut members = taken(&twice);
    members.dedup();
    assert_eq!(members, taken(&table));
}

const ROW: &str = "3,71,17,5,1.0,0.5,-0.25,12,3,123,true,complete,,,3";

/// `ROW` with another cell in this column.
fn with(column: usize, cell: &str) -> String {
    let mut cells: Vec<&str> = ROW.split(',').collect();
    cells[column - 1] = cell;
    cells.join(",") + "\n"
}

#[test]
fn a_number_that_is_none_is_refused_with_its_place() {
    assert_eq!(taken(ROW).len(), 1);
    for number in [
        "NaN", "inf", "-inf", "infinity", "1e999", "-1e999", " 1.0", "1.0 ", "1,0", "", "0x1", "1.0f64",
        "--1",
    ] {
        for column in [5, 6, 7] {
            if !number.contains(',') {
                refused(&(with(6, "1.5") + &with(column, number)), (2, column));
            }
        }
    }
    for (column, cell) in [
        (2, ""),
        (3, "4294967296"),
        (4, "-1"),
        (8, "-1"),
        (8, "1e3"),
        (9, "99999999999999999999999"),
        (10, ""),
        (11, "True"),
        (12, "fine"),
        (12, "complete "),
    ] {
        refused(&with(column, cell), (1, column));
    }
}

#[test]
fn numbers_of_every_size_are_read() {
    for number in ["-0", "0", "-0.0", "5e-324", "1e-400", "1.7976931348623157e308", "007", "1", "+1.5"] {
        let [member] = &taken(&with(6, number))[..] else { panic!("{number}") };
        let read = member.arrival().expect("it arrived").state.q[0];
        assert_eq!(read.to_bits(), number.parse::<f64>().unwrap().to_bits(), "{number}");
    }
}

#[test]
fn an_index_that_is_none_is_refused() {
    let index = |index: &str| format!("{index},71,17,5,1.0,0.5,-0.25,12,3,123,true,complete,,,{index}\n");
    for wrong in ["30", "99999999999999999999999", "-0", "+3", " 3", "3 ", "", "x", "3.0"] {
        refused(&index(wrong), (1, 1));
    }
    assert_eq!(taken(&index("29")).len(), 1);
}

#[test]
fn other_columns_are_refused() {
    let header = header(&names());
    for (other, column) in [
        (header.replace(",x,", ",y,"), 6),
        (header.replace("x_dot,", ""), 7),
        (header.replace("x,x_dot", "x,y,x_dot,y_dot"), 7),
        (header.replace(",t,", ",time,"), 5),
        (header.clone() + ",more", 15),
        (header.replace(',', ";"), 1),
    ] {
        refused(&format!("{other}\n{ROW}\n"), (1, column));
    }
    refused(&format!("\"member\",\"t\"\n{ROW}\n"), (1, 1));
}

/// The message of a failure was truncated, and the member was integrated again.
#[test]
fn a_failure_that_ran_into_the_next_row_of_its_member_is_no_row() {
    let table = table();
    let failed = format!("{}\n", table.lines().nth(2).expect("a row"));
    let arrived = ROW.replacen('3', "12", 1).strip_suffix('3').expect("a row").to_owned() + "12\n";
    assert_eq!(taken(&arrived).len(), 1);
    for next in [&arrived, &failed] {
        for cut in 1..failed.len() {
            let joined = format!("{}{next}{arrived}", &failed[..cut]);
            assert_eq!(taken(&joined.replace(",17,5,", ",4294967295,0,")).len(), 1, "{joined}");
            assert_eq!(all(&format!("{}{next}", &failed[..cut])).len(), 0, "cut at {cut}");
        }
    }
}

/// All rows, including those of failed members.
fn all(table: &str) -> Vec<MemberRow<f64, Const<1>>> {
    MemberTable::of(table, NAMES, MINE.system, COUNT).expect("a table").rows().to_vec()
}

/// Rows become members and rows again, as between processes.
#[test]
fn a_row_gives_the_member_that_gives_the_row() {
    let table = table();
    let late =
        table.lines().nth(1).expect("a row").replacen(",complete,", ",\"stopped, at last\",", 1) + "\n";
    let rows = all(&(table + &late.replacen('3', "4", 1).replace(",3\n", ",4\n")));
    assert_eq!(rows.len(), 4);
    for row in rows {
        let member = row.clone().into_member(&EVENTS, &names()).expect("a member");
        assert_eq!(
            (member.csv().to_string(), member.has_failed()),
            (row.csv().to_string(), row.has_failed())
        );
        assert_eq!(member.arrival().is_some(), row.state.is_some());
    }
}

#[test]
fn samples_quantities_and_crossings_come_back_to_the_bit() {
    let (outcome, table) = (outcome(), table());
    for member in taken(&table) {
        let original = outcome.get(member.index).expect("a member");
        assert_eq!(&member, original);
        assert_eq!(bits(&member), bits(original));
    }
    assert_eq!(table.lines().count(), 4, "names with line breaks make no lines:\n{table}");
    let read = MemberTable::<f64, Const<1>>::of(&table, NAMES, MINE.system, COUNT).expect("a table");
    assert_eq!(read.to_string(), table);
    let row = read.get(21).expect("a row");
    let MemberCrossing { event, index, .. } = &row.crossings[2];
    assert_eq!((event.as_str(), *index), (EVENTS[0], 0));
    // The first row names no quantities.
    let lines: Vec<&str> = table.lines().collect();
    let turned = format!("{}\n{}\n", lines[2], lines[1]);
    let turned = MemberTable::<f64, Const<1>>::of(&turned, NAMES, MINE.system, COUNT).expect("a table");
    assert_eq!(turned.rows(), &read.rows()[..2]);
    assert_eq!(turned.get(12).expect("a row").quantity("c").expect("a quantity").count(), 0);
    let values = row.values.iter().skip(1).step_by(2).copied();
    assert!(row.quantity("c").expect("a quantity").eq(values));
}

/// JSON has no NaN.
#[test]
fn no_number_is_null() {
    let mut outcome = outcome();
    let arrival = outcome.members[0].result.as_mut().expect("an arrival");
    arrival.values[1] = f64::NAN;
    let table = outcome.csv().to_string();
    assert!(table.contains(r#"""c"":[null]}"#), "{table}");
    assert!(taken(&table)[0].arrival().expect("an arrival").values[1].is_nan());
}

/// Edited by hand: other names, lists of other lengths, states that are none, what is no JSON.
#[test]
fn lists_that_do_not_belong_together_are_refused_with_their_place() {
    let table = table();
    let line = table.lines().nth(3).expect("a row");
    for (text, other, column) in [
        (r#"{""t"":[0.0,"#, r#"{""t"":["#, 13),
        (r#"""x_dot"":[5e-324,"#, r#"""x_dot"":[null,"#, 13),
        (r#"""x_dot"":[5e-324,"#, r#"""x_dot"":[1e999,"#, 13),
        (r#"""x_dot"":[5e-324,"#, r#"""y_dot"":[5e-324,"#, 13),
        (r#"""c"":["#, r#"""c"":[1.0,"#, 13),
        (r#"""c"":["#, r#"""c"":"#, 13),
        (r#"""c"":["#, r#"""c"":[one,"#, 13),
        (r#"""event_index"":[0,"#, r#"""event_index"":[-1,"#, 14),
        (r#"""event_rising"":[true,"#, r#"""event_rising"":[1,"#, 14),
        (r#"""event"":["#, r#"""event"":[up,"#, 14),
        (r#"""event_count"":["#, r#"""count"":["#, 14),
    ] {
        assert!(line.contains(text), "{text} is not in {line}");
        refused(&line.replacen(text, other, 1), (1, column));
    }
    let other = format!("{line}\n{}\n", line.replace(r#"""c"":["#, r#"""d"":["#));
    refused(&other, (2, 13));
    // Read, but not of a run with these events and quantities.
    for (text, other) in
        [(r#"""event_index"":[0,1"#, r#"""event_index"":[1,1"#), (r#"""c"":["#, r#"""d"":["#)]
    {
        let error = resume(&line.replacen(text, other, 1)).expect_err(other);
        assert_eq!(
            error,
            Error::Ensemble(EnsembleError::OtherRun {
                member: 21,
                differs: "its quantities or events are others"
            })
        );
    }
}

/// Rows without the columns of samples are not taken silently.
#[test]
fn rows_of_tables_that_kept_no_samples_are_done_again() {
    assert!(taken("3,71,17,5,1.0,0.5,-0.25,12,3,123,true,complete,3\n").is_empty());
    let header = header(&names()).replace(",samples,crossings", "");
    refused(&format!("{header}\n"), (1, 13));
}

#[test]
fn a_member_with_two_results_is_refused() {
    let other = ROW.replace("-0.25", "-0.26");
    refused(&format!("{ROW}\n{ROW}\n{other}\n"), (3, 1));
    // An observer may end a member earlier or later.
    assert_eq!(taken(&format!("{ROW}\n{}\n", other.replace("complete", "cancelled"))).len(), 1);
}

/// Any character changed, left out or put in: read or refused, and every row that is read can be written and read again.
#[test]
fn an_edited_table_is_read_or_refused() {
    let table = table();
    let (mut read, mut refused) = (0, 0);
    let step = lagrange_random::cases([4, 1, 1]);
    for at in (0..table.len()).step_by(step) {
        for edit in ["", "\"", ",", "[", "]", "{", "\\", "\\u", "\n", "1", "é"] {
            for until in [at, at + 1] {
                let edited = format!("{}{edit}{}", &table[..at], &table[until..]);
                match MemberTable::<f64, Const<1>>::of(&edited, NAMES, MINE.system, COUNT) {
                    Ok(rows) => {
                        let again =
                            MemberTable::<f64, Const<1>>::of(&rows.to_string(), NAMES, MINE.system, COUNT);
                        assert_eq!(again.expect("a table").to_string(), rows.to_string());
                        read += 1;
                    }
                    Err(Error::Ensemble(EnsembleError::Resume { .. })) => refused += 1,
                    Err(error) => panic!("{error}"),
                }
            }
        }
    }
    assert!(read.min(refused) > 1000 / step, "{read} read, {refused} refused");
}
