//! No system is stated twice in the tests and benches, under whatever names. Left out is what has to spell a system its own
//! way: messages of the compiler, the comparison with other tools, examples and programs of the documentation, each of which
//! is read by itself, and unit tests of `lagrange-core`, on which the library of systems depends.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Folders of the repository with systems, and what is left out in them.
const FOLDERS: [&str; 3] = ["tests", "lagrange-core/benches", "lagrange-core/tests"];
const LEFT_OUT: [&str; 2] = ["tests/rustc", "lagrange-core/benches/peers"];

/// Systems that are another one with other names, or with fields of another type, because a test is about these.
const ON_PURPOSE: [&str; 2] = ["Bobs", "Renamed"];

/// Names with a meaning in attributes; a name before parentheses has one too.
const WORDS: [&str; 10] =
    ["t", "pi", "in", "for", "friction", "restitution", "limit", "sliding", "let", "as"];

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut paths: Vec<PathBuf> =
        folder.read_dir().expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    for path in paths.into_iter().filter(|path| !LEFT_OUT.iter().any(|folder| path.ends_with(folder))) {
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Attributes of a declaration whose names are replaced by their numbers, in the order of their first use.
#[derive(Default)]
struct NormalForm {
    text: String,
    names: Vec<String>,
}

impl NormalForm {
    fn read(&mut self, tokens: TokenStream) {
        let mut tokens = tokens.into_iter().peekable();
        while let Some(token) = tokens.next() {
            let is_called = matches!(tokens.peek(), Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis);
            match token {
                TokenTree::Group(group) => {
                    self.text += "(";
                    self.read(group.stream());
                    self.text += ")";
                }
                TokenTree::Ident(name) if !is_called => self.name(&name.to_string()),
                other => self.text += &format!("{other} "),
            }
        }
    }

    fn name(&mut self, name: &str) {
        let base = name.trim_end_matches("_ddot").trim_end_matches("_dot");
        let number = self.names.iter().position(|known| known == base).unwrap_or_else(|| {
            self.names.push(base.to_owned());
            self.names.len() - 1
        });
        match WORDS.contains(&base) {
            true => self.text += &format!("{base} "),
            false => write!(self.text, "#{number}{} ", &name[base.len()..]).expect("a text"),
        }
    }
}

/// Adds the normal form of each declaration in a file, with its place.
fn declarations(tokens: TokenStream, file: &str, found: &mut BTreeMap<String, Vec<String>>) {
    let mut open: Option<NormalForm> = None;
    let mut after_hash = false;
    let mut tokens = tokens.into_iter();
    while let Some(token) = tokens.next() {
        let was_hash = std::mem::take(&mut after_hash);
        match token {
            TokenTree::Punct(punct) if punct.as_char() == '#' => after_hash = true,
            TokenTree::Group(group) if was_hash => {
                let mut attribute = group.stream().into_iter();
                match attribute.next().map(|name| name.to_string()).as_deref() {
                    Some("derive") => {
                        let derives = group.stream().to_string();
                        open = derives.contains("Lagrangian").then(NormalForm::default);
                    }
                    Some("doc" | "allow" | "expect" | "serde" | "default") | None => {}
                    Some(_) => {
                        if let Some(form) = &mut open {
                            form.read(group.stream());
                        }
                    }
                }
            }
            TokenTree::Ident(word) if word == "struct" => {
                let name = tokens.next().map_or(String::new(), |name| name.to_string());
                if let Some(form) = open.take().filter(|_| !ON_PURPOSE.contains(&name.as_str())) {
                    found.entry(form.text).or_default().push(format!("{name} in {file}"));
                }
            }
            TokenTree::Group(group) => declarations(group.stream(), file, found),
            _ => {}
        }
    }
}

#[test]
fn no_system_is_stated_twice() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the repository");
    let (mut paths, mut found) = (Vec::new(), BTreeMap::new());
    FOLDERS.iter().for_each(|folder| files(&root.join(folder), &mut paths));
    for path in paths {
        let text = std::fs::read_to_string(&path).expect("a text");
        let file = path.strip_prefix(&root).expect("inside").display().to_string();
        declarations(text.parse().expect("tokens"), &file, &mut found);
    }
    assert!(found.len() > 100, "{} systems only", found.len());
    let twice: Vec<_> = found.iter().filter(|(_, places)| places.len() > 1).collect();
    assert!(
        twice.is_empty(),
        "{} systems are stated more than once, see tests/systems: {twice:#?}",
        twice.len()
    );
}
