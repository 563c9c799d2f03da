//! Truncated, concatenated, edited and foreign tables: read, or rejected with the line and the reason.

use nalgebra::Const;

use super::*;
use crate::ensemble::MemberCrossing;
use crate::error::Ending;
use crate::generic::State;
use crate::motion::Arrival;
use crate::{Crossing, Statistics};

const NAMES: &[&str] = &["x"];
const EVENTS: [&str; 2] = ["up, \"again\"\r\n", "down\\u000a"];

fn names() -> Arc<ColumnNames> {
    Arc::new(ColumnNames::new(NAMES, vec!["a, \"b\"\n\\".into(), "c".into()]))
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
    let entries = states.flat_map(|state| [state.t, state.q[0], state.v[0]]);
    entries.chain(values.iter().copied()).map(f64::to_bits).collect()
}

const MINE: Fingerprint = Fingerprint { system: 71, run: 4_294_967_295, start: 0 };

/// Complete table of the members 3 (one sample, no crossing), 12 (which failed) and 21 (seven samples, three crossings).
fn table() -> String {
    outcome().json_lines().to_string()
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

/// The rows of a table, ordered by member.
fn read(table: &str) -> Result<MemberTable<f64, Const<1>>, Error> {
    MemberTable::of(table, NAMES, MINE.system)
}

fn resume(table: &str) -> Result<Vec<Member<f64, Const<1>>>, Error> {
    let rows = read(table)?.into_rows().filter(|row| !row.has_failed());
    rows.map(|row| row.into_member(&EVENTS, &names())).collect()
}

fn taken(table: &str) -> Vec<Member<f64, Const<1>>> {
    resume(table).unwrap_or_else(|error| panic!("{error} in {table:?}"))
}

#[track_caller]
fn refused(table: &str, at: usize, why: &str) {
    match resume(table) {
        Err(Error::Ensemble(EnsembleError::Resume { line, reason })) => {
            assert_eq!(line, at, "{table:?}");
            assert!(reason.contains(why), "{reason} for {table:?}");
        }
        other => panic!("{other:?} for {table:?}"),
    }
}

/// Complete row of member 3, without samples and crossings.
const ROW: &str = r#"{"member":3,"fingerprint":{"system":71,"run":17,"start":5},"ending":"complete","end":{"t":1.0,"x":0.5,"x_dot":-0.25},"statistics":{"accepted":12,"rejected":3,"evaluations":123,"multipliers_are_unique":true},"samples":[],"crossings":[]}"#;

/// `ROW` with other text in place of this.
#[track_caller]
fn with(text: &str, other: &str) -> String {
    assert!(ROW.contains(text), "{text}");
    ROW.replacen(text, other, 1) + "\n"
}

/// A truncated table gives exactly the members whose rows are complete.
#[test]
fn a_table_cut_anywhere_loses_and_invents_nothing() {
    let table = table();
    let all = taken(&table);
    assert_eq!(all.iter().map(|member| member.index).collect::<Vec<_>>(), [3, 21]);
    for table in [table.clone(), table.replace('\n', "\r\n")] {
        let lines = table.split_inclusive('\n').scan(0, |end, line| {
            *end += line.len();
            Some(*end - (line.len() - line.trim_end().len()))
        });
        let ends: Vec<usize> = lines.collect();
        for cut in 0..=table.len() {
            let whole = usize::from(cut >= ends[0]) + usize::from(cut >= ends[2]);
            assert_eq!(taken(&table[..cut]), all[..whole], "cut at {cut}");
        }
    }
}

/// The row in the truncated line is lost, and is integrated again.
#[test]
fn what_is_appended_to_a_cut_table_counts_from_the_next_line_on() {
    let table = table();
    let (all, rows) = (taken(&table), read(&table).expect("a table"));
    for cut in 0..=table.len() {
        let joined = read(&format!("{}{table}", &table[..cut])).expect("a table");
        assert!(joined.rows().iter().all(|row| rows.get(row.index) == Some(row)), "cut at {cut}: {joined}");
        assert!(joined.get(12).is_some() && joined.get(21).is_some(), "cut at {cut}: {joined}");
        let twice = taken(&format!("{}{table}{table}", &table[..cut]));
        assert_eq!(twice, all, "cut at {cut}");
    }
}

#[test]
fn lines_twice_and_empty_lines_change_nothing() {
    let table = table();
    let twice: String = table.lines().map(|line| format!("{line}\n\n{line}\n")).collect();
    assert_eq!(taken(&twice), taken(&table));
}

#[test]
fn a_number_that_is_none_is_refused_with_its_line() {
    assert_eq!(taken(ROW).len(), 1);
    for (text, other, why) in [
        ("0.5", r#""NaN""#, "a number of a state is not finite"),
        ("1.0", r#""inf""#, "a number of a state is not finite"),
        ("-0.25", r#""-inf""#, "a number of a state is not finite"),
        ("0.5", r#""half""#, "invalid float"),
        ("0.5", "1e999", "number out of range"),
        ("0.5", "null", "expected a number"),
        ("0.5", "[0.5]", "expected a number"),
        ("71", "-1", "expected u32"),
        ("17", "4294967296", "expected u32"),
        ("12,", "1e3,", "expected usize"),
        ("true", "1", "expected a boolean"),
        ("3", "-3", "expected usize"),
        ("3", "99999999999999999999999", "expected usize"),
        (r#"{"t""#, r#"{"time""#, "its columns are others"),
        (r#","x_dot":-0.25"#, "", "its columns are others"),
        (r#""x_dot":-0.25"#, r#""y_dot":-0.25"#, "its columns are others"),
        (r#","samples":[]"#, "", "missing field `samples`"),
        (r#""complete""#, "null", "expected a string"),
    ] {
        refused(&(with("0.5", "1.5") + &with(text, other)), 2, why);
    }
    for line in ["[]", "3,71,17,5,1.0", "null", "member"] {
        refused(&format!("{ROW}\n{line}\n"), 2, "a row is an object of JSON");
    }
}

/// The message names the column of the line, but no line of its own.
#[test]
fn a_message_has_one_line_number() {
    let error = read(&(with("0.5", "0.75") + &with("0.5", "null"))).expect_err("no number");
    let said = "line 2 of the table of members does not belong there: invalid type: null, expected a number at column 102";
    assert_eq!(error.to_string(), said);
}

#[test]
fn numbers_of_every_size_are_read() {
    for number in
        ["-0", "0", "-0.0", "5e-324", "1e-400", "1.7976931348623157e308", "1", "1e23", "9007199254740993"]
    {
        let [member] = &taken(&with("0.5", number))[..] else { panic!("{number}") };
        let read = member.arrival().expect("it arrived").state.q[0];
        assert_eq!(read.to_bits(), number.parse::<f64>().unwrap().to_bits(), "{number}");
    }
}

/// Rows become members and rows again, as between processes.
#[test]
fn a_row_gives_the_member_that_gives_the_row() {
    let late = with("complete", "stopped, at last")
        .replace("17", "4294967295")
        .replace("\"start\":5", "\"start\":0");
    let table = read(&(table() + &late.replacen('3', "4", 1))).expect("a table");
    assert_eq!(table.rows().len(), 4);
    for row in table.rows() {
        let member = row.clone().into_member(&EVENTS, &names()).expect("a member");
        assert_eq!(
            (member.json_line().to_string(), member.has_failed()),
            (row.json_line().to_string(), row.has_failed())
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
    assert_eq!(table.lines().count(), 3, "names with line breaks make no lines:\n{table}");
    let all = read(&table).expect("a table");
    assert_eq!(all.to_string(), table);
    let alone = table.lines().next().map(|line| serde_json::from_str(line).expect("a row"));
    assert_eq!(alone.as_ref(), all.get(3));
    let row = all.get(21).expect("a row");
    let MemberCrossing { event, index, .. } = &row.crossings[2];
    assert_eq!((event.as_str(), *index), (EVENTS[0], 0));
    // The first row names no quantities.
    let lines: Vec<&str> = table.lines().collect();
    let turned = read(&format!("{}\n{}\n", lines[1], lines[0])).expect("a table");
    assert_eq!(turned.rows(), &all.rows()[..2]);
    assert_eq!(turned.get(12).expect("a row").quantity("c").expect("a quantity").count(), 0);
    let values = row.values.iter().skip(1).step_by(2).copied();
    assert!(row.quantity("c").expect("a quantity").eq(values));
}

/// JSON has neither NaN nor infinities.
#[test]
fn numbers_without_json_are_texts() {
    let mut outcome = outcome();
    let special = [f64::NAN, f64::NEG_INFINITY];
    let arrival = outcome.members[0].result.as_mut().expect("an arrival");
    arrival.values.copy_from_slice(&special);
    let table = outcome.json_lines().to_string();
    assert!(table.contains(r#"\\":"NaN","c":"-inf"}]"#), "{table}");
    let read = taken(&table)[0].arrival().expect("an arrival").values.clone();
    assert!(read[0].is_nan() && read[1] == special[1], "{read:?}");
}

/// Edited by hand: samples with other names, and what belongs to another run.
#[test]
fn samples_and_crossings_that_do_not_belong_together_are_refused() {
    let table = table();
    let line = table.lines().nth(2).expect("a row");
    for (text, other, why) in [
        (r#"[{"t":0.0,"x":-0.0,"#, r#"[{"t":0.0,"#, "its columns are others"),
        (r#""x_dot":5e-324,"#, r#""x_dot":"inf","#, "not finite"),
        (r#""c":"-inf"}"#, r#""c":"-inf","d":1.0}"#, "its columns are others"),
        (r#""index":0"#, r#""index":-1"#, "expected usize"),
        (r#""rising":true"#, r#""rising":1"#, "expected a boolean"),
        (r#""event":""#, r#""name":""#, "missing field `event`"),
    ] {
        assert!(line.contains(text), "{text} is not in {line}");
        refused(&line.replacen(text, other, 1), 1, why);
    }
    refused(&format!("{line}\n{}\n", line.replace(r#""c":"#, r#""d":"#)), 2, "its quantities are others");
    // Read, but not of a run with these events and quantities.
    for other in [line.replacen(r#""index":0"#, r#""index":1"#, 1), line.replace(r#""c":"#, r#""d":"#)] {
        let differs = "its quantities or events are others";
        assert_eq!(resume(&other), Err(Error::Ensemble(EnsembleError::OtherRun { member: 21, differs })));
    }
}

#[test]
fn a_member_with_two_results_is_refused() {
    let other = with("-0.25", "-0.26");
    refused(&format!("{ROW}\n{ROW}\n{other}"), 3, TWO_RESULTS);
    // An observer may end a member earlier or later.
    assert_eq!(taken(&format!("{ROW}\n{}", other.replace("complete", "cancelled"))).len(), 1);
}

/// Any character changed, left out or put in: read or refused, and every row that is read can be written and read again.
#[test]
fn an_edited_table_is_read_or_refused() {
    let table = table();
    let (mut kept, mut refused) = (0, 0);
    let step = lagrange_random::cases([4, 1, 1]);
    for at in (0..table.len()).step_by(step) {
        for edit in ["", "\"", ",", "[", "]", "{", "\\", "\\u", "\n", "1", "é"] {
            for until in [at, at + 1] {
                let edited = format!("{}{edit}{}", &table[..at], &table[until..]);
                match read(&edited) {
                    Ok(rows) => {
                        assert_eq!(read(&rows.to_string()).expect("a table").to_string(), rows.to_string());
                        kept += 1;
                    }
                    Err(Error::Ensemble(EnsembleError::Resume { .. })) => refused += 1,
                    Err(error) => panic!("{error}"),
                }
            }
        }
    }
    assert!(kept.min(refused) > 1000 / step, "{kept} read, {refused} refused");
}
