//! Blocks of a page that show what a program has found: compared with it by the tests, and written by them where asked.

use std::path::{Path, PathBuf};
use std::{env, fs};

/// Checks that the block after the line `<!-- name -->` in this page of the book is `text`. With `UPDATE_BOOK=1` in the
/// environment it is made so; tests that write to one page must not run at once (`--test-threads=1`).
///
/// # Panics
/// Where the block is not there, or says something else.
pub(crate) fn check(book: &Path, page: &str, name: &str, text: &str) {
    let path: PathBuf = book.join("src").join(page);
    let old = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let new = with_block(&old, name, text).unwrap_or_else(|| panic!("{page} has no block `<!-- {name} -->`"));
    if env::var_os("UPDATE_BOOK").is_some() {
        fs::write(&path, new).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    } else {
        assert!(
            old == new,
            "{page} shows something else as `{name}` than\n\n{text}\n\nUPDATE_BOOK=1 writes it"
        );
    }
}

/// The page with this text in the block of this name: one of code, or of HTML, which an empty line ends.
fn with_block(page: &str, name: &str, text: &str) -> Option<String> {
    let mark = format!("<!-- {name} -->\n");
    let start = page.find(&mark)? + mark.len();
    let block = &page[start..];
    let [first, last] = match block.starts_with("```") {
        true => [block.find('\n')? + 1, block.find("\n```\n")? + 1],
        false => [0, block.find("\n\n")? + 1],
    };
    Some(format!("{}{}\n{}", &page[..start + first], text.trim_end(), &page[start + last..]))
}
