//! Messages on wrong input: tables of systems, with the message below each token at fault.
//!
//! A case is a heading `== name` and a struct with its attributes. Carets under a line mark the tokens at fault, and the
//! message stands beside them. Tokens on several lines have carets under each, and the message beside the last ones.
//! `UPDATE_EXPECT=1 cargo test -p lagrange-derive --test refused` writes the marks and messages anew; read the
//! difference before you commit it.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

use lagrange_derive::{Diagnostic, System};

/// Mark of the first line of a case, before its name.
const HEADING: &str = "== ";

#[test]
fn wrong_input_is_refused_with_the_message_in_the_table() {
    let (mut cases, mut wrong) = (0, String::new());
    for file in tables() {
        let table = fs::read_to_string(&file).expect("a text");
        let (introduction, first) = table.split_at(table.find(HEADING).expect("a case"));
        let mut found = introduction.to_owned();
        for case in
            first.split_inclusive('\n').collect::<Vec<_>>().chunk_by(|_, next| !next.starts_with(HEADING))
        {
            let (case, again) = (case.concat(), marked(&unmarked(case)));
            found += &again;
            cases += 1;
            if again != case {
                write!(wrong, "{}\nexpected: {case}found: {again}", file.display()).expect("a string");
            }
        }
        if env::var_os("UPDATE_EXPECT").is_some() && found != table {
            fs::write(&file, found).expect("a file");
        }
    }
    assert!(cases > 200, "only {cases} cases were found");
    assert!(wrong.is_empty() || env::var_os("UPDATE_EXPECT").is_some(), "{wrong}");
}

fn tables() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/refused");
    let files = folder.read_dir().expect("a folder").map(|entry| entry.expect("a file").path());
    let mut files: Vec<_> = files.collect();
    files.sort();
    files
}

/// Returns the lines of a case without marks and messages.
fn unmarked(lines: &[&str]) -> String {
    lines.iter().filter(|line| !line.trim_start().starts_with('^')).copied().collect()
}

/// Returns the case with the errors of its struct marked.
fn marked(case: &str) -> String {
    let (heading, source) = case.split_once('\n').expect("lines");
    let refusal = System::parse(source).expect_err(heading);
    let diagnostics = refusal.diagnostics().iter();
    let all = diagnostics.flat_map(|diagnostic| [diagnostic].into_iter().chain(diagnostic.notes()));
    let mut marks: Vec<_> = all.flat_map(|diagnostic| marks(diagnostic, heading)).collect();
    // A stable sort: messages at one place stay in the order in which they are reported.
    marks.sort_by_key(|(line, column, _)| (*line, *column));
    // rustc, too, prints equal messages once.
    marks.dedup();
    let mut marked = format!("{heading}\n");
    for (number, line) in (1..).zip(source.split_inclusive('\n')) {
        marked += line;
        marked.extend(marks.iter().filter(|mark| mark.0 == number).map(|mark| &*mark.2));
    }
    marked
}

/// Returns the line, the column and the text of each mark of a message.
fn marks(diagnostic: &Diagnostic, heading: &str) -> Vec<(usize, usize, String)> {
    let message = diagnostic.message();
    assert!(!message.contains('\n'), "{heading}: a message of one line: {message}");
    let location = diagnostic.location().unwrap_or_else(|| panic!("{heading}: it is at no token: {message}"));
    let mut marks = Vec::new();
    for (number, text) in location.text.split('\n').enumerate() {
        let first = if number == 0 { location.column - 1 } else { 0 };
        let column = first + text.len() - text.trim_start().len();
        let carets = "^".repeat(text.trim().chars().count().max(1));
        marks.push((location.line + number, column, format!("{}{carets}\n", " ".repeat(column))));
    }
    let (_, _, last) = marks.last_mut().expect("a line");
    last.insert_str(last.len() - 1, &format!(" {message}"));
    marks
}
