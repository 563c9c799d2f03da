//! The same struct expands to the same tokens, in one process and in two. Tokens depend on no order of a hash map,
//! no address and no time.

use std::process::Command;
use std::sync::LazyLock;

use lagrange_random::cases;

use super::{systems, tokens};
use crate::expand;

/// Prefix of the lines of the child process that are compared.
const MARK: &str = "expansion: ";

fn sources() -> [String; 6] {
    [
        systems::PENDULUM.to_owned(),
        systems::SPHERE.to_owned(),
        systems::chain(5),
        systems::chain(cases([10, 20, 20])),
        systems::rods(4),
        systems::TOP.to_owned(),
    ]
}

static EXPANSIONS: LazyLock<Vec<String>> = LazyLock::new(expansions);

fn expansions() -> Vec<String> {
    sources().iter().map(|source| expand(tokens(source)).to_string()).collect()
}

#[test]
fn one_process_expands_alike() {
    assert_eq!(*EXPANSIONS, expansions());
    for expansion in &*EXPANSIONS {
        assert!(!expansion.contains("compile_error"), "{expansion}");
    }
}

/// What the second process runs: it prints the expansions for the first to read.
#[test]
fn prints_its_expansions() {
    for expansion in &*EXPANSIONS {
        println!("\n{MARK}{expansion}");
    }
}

#[test]
fn two_processes_expand_alike() {
    let program = std::env::current_exe().expect("this test's path");
    let name = format!("{}::prints_its_expansions", module_path!().split_once("::").expect("a crate").1);
    let output =
        Command::new(program).args(["--exact", &name, "--nocapture"]).output().expect("another process");
    let text = String::from_utf8(output.stdout).expect("text");
    let there: Vec<_> = text.lines().filter_map(|line| line.strip_prefix(MARK)).collect();
    assert_eq!(*EXPANSIONS, there);
}
