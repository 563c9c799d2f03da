//! Errors that only rustc can report: bounds on traits, constants, and the absence of errors that follow from another
//! one. The derive's own messages are in tables, `lagrange-macros/derive/tests/refused`.
//!
//! One rule a file, and the messages beside it. After a change of messages, `TRYBUILD=overwrite cargo test
//! -p lagrange-rustc` writes them anew; read the difference before you commit it.

use std::env;
use std::process::Command;

/// What the cases are compiled with.
const FLAGS: &str = "--cfg\x1ftrybuild\x1f--verbose\x1f-A\x1fdead_code\x1f--diagnostic-width=140";

/// By itself `trybuild` compiles what the cases depend on with other flags than the cases, and so all of it twice. These go before
/// its own, but only a new process can be given them.
#[test]
fn wrong_input_is_told_what_to_write_instead() {
    const NAME: &str = "CARGO_ENCODED_RUSTFLAGS";
    if env::var(NAME).is_ok_and(|flags| flags == FLAGS) {
        // All of them in one go of cargo, on all cores: a case that has to run would take that away.
        return trybuild::TestCases::new().compile_fail("cases/*.rs");
    }
    let mut again = Command::new(env::current_exe().expect("this test"));
    // What the compiler says, and not what another one in its place does.
    again.args(env::args().skip(1)).env(NAME, FLAGS).env_remove("RUSTC_WORKSPACE_WRAPPER");
    assert!(again.status().expect("it runs").success());
}
