//! What the derive says to wrong input.
//!
//! One rule a file, and the messages beside it. After a change of messages, `TRYBUILD=overwrite cargo test
//! --test compile_fail` writes them anew; read the difference before you commit it.

#[test]
fn wrong_input_is_told_what_to_write_instead() {
    // All of them in one go of cargo, on all cores: a case that has to run would take that away.
    let cases = trybuild::TestCases::new();
    cases.compile_fail("tests/compile_fail/*.rs");
}
