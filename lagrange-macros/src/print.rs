//! Prints the emitted code, for example with `LAGRANGE_PRINT=RollingSphere cargo build`.

use std::io::Write;
use std::process::{Command, Stdio};

use proc_macro2::{TokenStream, TokenTree};

/// Returns the name after `struct`, or nothing if the tokens have none.
pub(crate) fn name(input: &TokenStream) -> String {
    let mut tokens = input.clone().into_iter();
    tokens.find(|token| matches!(token, TokenTree::Ident(word) if word == "struct"));
    tokens.next().map_or(String::new(), |token| token.to_string())
}

/// Prints the expansion to standard error if `LAGRANGE_PRINT` is the name of the struct, or `all`.
pub(crate) fn if_asked(name: &str, tokens: &TokenStream) {
    if std::env::var("LAGRANGE_PRINT").is_ok_and(|wanted| is_wanted(&wanted, name)) {
        eprintln!("{}", expansion(name, &tokens.to_string()));
    }
}

fn is_wanted(wanted: &str, name: &str) -> bool {
    wanted == "all" || wanted == name
}

fn expansion(name: &str, text: &str) -> String {
    match formatted(text) {
        Some(formatted) => format!("// the expansion of derive(Lagrangian) on {name}\n{formatted}"),
        None => format!("// the expansion of derive(Lagrangian) on {name} (rustfmt would format it)\n{text}"),
    }
}

/// Formats the text with rustfmt. `None` if rustfmt is not installed or rejects the text.
fn formatted(text: &str) -> Option<String> {
    let mut rustfmt = Command::new("rustfmt")
        .args(["--edition", "2024", "--emit", "stdout"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
    rustfmt.stdin.take()?.write_all(text.as_bytes()).ok()?;
    let output = rustfmt.wait_with_output().ok()?;
    output.status.success().then(|| String::from_utf8(output.stdout).ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_struct_is_asked_for_by_its_name_or_with_all() {
        assert!(is_wanted("all", "Pendulum") && is_wanted("Pendulum", "Pendulum"));
        assert!(!is_wanted("Pendulum", "PendulumOnCart") && !is_wanted("", "Pendulum"));
    }

    #[test]
    fn the_expansion_is_formatted_and_what_rustfmt_refuses_is_shown_as_it_is() {
        let shown = expansion("Pendulum", "fn  f ( ) -> f64 { 1.0 }");
        assert!(shown.starts_with("// the expansion of derive(Lagrangian) on Pendulum\n"), "{shown}");
        assert!(shown.contains("fn f() -> f64 {\n    1.0\n}"), "{shown}");
        assert!(expansion("Pendulum", "fn (").ends_with("\nfn ("));
    }
}
