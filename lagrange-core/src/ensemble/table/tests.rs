//! Truncated, concatenated, edited and foreign tables: read, or rejected with line and column.

use nalgebra::Const;

use super::*;
use crate::statistics::Statistics;
use crate::system::State;

const NAMES: &[&str] = &["x"];
const COUNT: usize = 30;
const MINE: Fingerprint = Fingerprint { system: 71, run: 4_294_967_295, start: 0 };

/// Complete table of the members 3, 12 (which failed) and 21.
fn table() -> String {
    let arrived = |index: usize, time: f64, ending| Member {
        index,
        fingerprint: MINE,
        result: Ok(Arrival {
            state: State::new([-1.0 / 3.0], [2e-300]).at_time(time),
            ending,
            statistics: Statistics {
                accepted: 12,
                rejected: 3,
                evaluations: 123,
                multipliers_are_unique: true,
            },
            samples: Vec::new(),
            values: Vec::new(),
            crossings: Vec::new(),
        }),
    };
    let failed = Member {
        index: 12,
        fingerprint: MINE,
        result: Err(Error::Setting { name: "a \"setting\", 12", value: f64::NAN }),
    };
    let complete = arrived(3, 1.0, Ending::Complete { time: 1.0 });
    let members = vec![complete, failed, arrived(21, 0.25, Ending::Cancelled { time: 0.25 })];
    Outcome::new(members, NAMES, Vec::new(), (1.0, MINE)).csv().to_string()
}

fn resume(table: &str) -> Result<Vec<Member<f64, Const<1>>>, Error> {
    let rows = MemberTable::of(table, NAMES, MINE.system, COUNT)?.into_rows().filter(|row| !row.has_failed());
    Ok(rows.map(|row| row.into_member(&[])).collect())
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

const ROW: &str = "3,71,17,5,1.0,0.5,-0.25,12,3,123,true,complete,3";

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
    let index = |index: &str| format!("{index},71,17,5,1.0,0.5,-0.25,12,3,123,true,complete,{index}\n");
    for wrong in ["30", "99999999999999999999999", "-0", "+3", " 3", "3 ", "", "x", "3.0"] {
        refused(&index(wrong), (1, 1));
    }
    assert_eq!(taken(&index("29")).len(), 1);
}

#[test]
fn other_columns_are_refused() {
    let header = header(NAMES);
    for (other, column) in [
        (header.replace(",x,", ",y,"), 6),
        (header.replace("x_dot,", ""), 7),
        (header.replace("x,x_dot", "x,y,x_dot,y_dot"), 7),
        (header.replace(",t,", ",time,"), 5),
        (header.clone() + ",more", 13),
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
        let member = row.clone().into_member(&[]);
        assert_eq!(
            (member.csv().to_string(), member.has_failed()),
            (row.csv().to_string(), row.has_failed())
        );
        assert_eq!(member.arrival().is_some(), row.state.is_some());
    }
}
