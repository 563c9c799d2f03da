//! `LAGRANGE_PRINT=RollingSphere cargo build` shows what the derive emits.

use std::io::Write;
use std::process::{Command, Stdio};

use proc_macro2::TokenStream;

use crate::syntax::Declaration;

/// Prints the expansion to the standard error stream if `LAGRANGE_PRINT` names the struct, or is `all`.
pub(crate) fn if_asked(declaration: &Declaration, tokens: &TokenStream) {
    let name = declaration.ident.to_string();
    match std::env::var("LAGRANGE_PRINT") {
        Ok(wanted) if wanted == "all" || wanted == name => {}
        _ => return,
    }
    let text = tokens.to_string();
    match formatted(&text) {
        Some(formatted) => eprintln!("// the expansion of derive(Lagrangian) on {name}\n{formatted}"),
        None => {
            eprintln!("// the expansion of derive(Lagrangian) on {name} (rustfmt would format it)\n{text}");
        }
    }
}

/// The text as rustfmt prints it, where there is one.
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
