//! What the derive says to wrong input, and that it takes what is right.
//!
//! One rule a file, and the messages beside it. After a change of messages, `TRYBUILD=overwrite cargo test
//! --test compile_fail` writes them anew; read the difference before you commit it.

#[test]
fn wrong_input_is_told_what_to_write_instead() {
    let cases = trybuild::TestCases::new();
    cases.compile_fail("tests/compile_fail/*.rs");
    cases.pass("tests/compile_fail/accepted/*.rs");
}
