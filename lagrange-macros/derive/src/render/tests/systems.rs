//! Systems that any test, example or page of documentation derives.

use std::path::Path;
use std::sync::{Mutex, mpsc};
use std::thread::JoinHandle;

use lagrange_random::cases;
use proc_macro2::{Delimiter, TokenStream, TokenTree};

use crate::diagnostics::Diagnostics;
use crate::mechanics::{self, Derived};
use crate::render::arrays::Arrays;
use crate::render::formula::Formula;
use crate::render::letters::Letters;
use crate::render::notation::Notation;
use crate::render::{Rendered, render};
use crate::resolve::{self, Problem};
use crate::symbolic::Graph;
use crate::syntax;

/// A system whose equations are checked.
pub(super) struct System {
    pub(super) graph: Graph,
    pub(super) problem: Problem,
    pub(super) derived: Derived,
    pub(super) forms: Forms,
    pub(super) arrays: Arrays,
    pub(super) letters: Letters,
}

/// A page in three forms, each as text, LaTeX and HTML.
pub(super) type Forms = [[String; 3]; 3];

pub(super) fn in_unicode(system: &System, formula: &Formula) -> String {
    system.notation(Notation::UNICODE).write(formula)
}

impl System {
    /// A notation with the arrays and letters of the page.
    pub(super) fn notation(&self, notation: Notation<'static>) -> Notation<'_> {
        notation.with(&self.arrays, &self.letters)
    }

    /// Resolves and derives a system; `None` after any error.
    pub(super) fn new(tokens: TokenStream) -> Option<Self> {
        let mut diagnostics = Diagnostics::default();
        let declaration = syntax::declaration(syn::parse2(tokens).ok()?, &mut diagnostics);
        diagnostics.is_empty().then_some(())?;
        let (mut graph, problem) = resolve::problem(&declaration, &mut diagnostics)?;
        // Systems of any number of bodies have tests of their own, beside the same system with a constant number.
        (!problem.many.is_open()).then_some(())?;
        let derived = mechanics::derive(&mut graph, &problem, &mut diagnostics)?;
        let Rendered { forms, .. } = render(&declaration, &graph, &problem, &derived);
        let letters = Letters::of(&declaration, &problem, &derived);
        let arrays = Arrays::of(&problem, &derived, &letters);
        Some(Self { graph, problem, derived, forms, arrays, letters })
    }
}

/// Finds all structs that derive a Lagrangian in these tokens, and in string literals among them.
fn structs(tokens: TokenStream, found: &mut Vec<TokenStream>) {
    let mut item: Vec<TokenTree> = Vec::new();
    let mut derives = false;
    for token in tokens {
        match &token {
            TokenTree::Group(group) if group.delimiter() == Delimiter::Bracket && is_attribute(&item) => {
                derives |= group.stream().to_string().contains("Lagrangian");
            }
            TokenTree::Group(group) => structs(group.stream(), found),
            TokenTree::Literal(literal) => {
                let text = syn::parse_str::<syn::LitStr>(&literal.to_string()).map(|literal| literal.value());
                let text = text.unwrap_or_default();
                if text.contains("#[coordinates") && !text.contains("{{") {
                    found.extend(text.parse::<TokenStream>());
                }
            }
            _ => {}
        }
        let ends = match &token {
            TokenTree::Punct(punct) => punct.as_char() == ';',
            TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
            _ => false,
        };
        item.push(token);
        if ends {
            if derives && item.iter().any(|token| token.to_string() == "struct") {
                found.push(item.drain(..).collect());
            }
            item.clear();
            derives = false;
        }
    }
}

fn is_attribute(item: &[TokenTree]) -> bool {
    matches!(item.last(), Some(TokenTree::Punct(punct)) if punct.as_char() == '#')
}

/// Code in a file, and code in its comments.
fn sources(text: &str) -> Vec<String> {
    let mut sources = vec![text.to_owned()];
    let comments = text.lines().map(str::trim).filter_map(|line| {
        line.strip_prefix("///")
            .or_else(|| line.strip_prefix("//!"))
            .map(|line| line.strip_prefix(' ').unwrap_or(line))
    });
    let comments: Vec<&str> = comments.map(|line| line.strip_prefix("# ").unwrap_or(line)).collect();
    sources.extend(
        comments
            .join("\n")
            .split("```")
            .skip(1)
            .step_by(2)
            .map(|block| block.split_once('\n').map_or(String::new(), |(_, code)| code.to_owned())),
    );
    sources
}

fn files(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        // What the comparison with other tools derives is large, and is printed like what is small.
        if path.ends_with("benches/peers") {
            continue;
        }
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Number of files of which the systems of one are checked.
pub(super) fn share() -> usize {
    cases([30, 30, 1])
}

/// Pages about the systems of some folders, which are derived once for several tests.
pub(super) struct Library {
    pub(super) pages: Vec<Forms>,
    checks: Mutex<Option<JoinHandle<()>>>,
}

impl Library {
    /// Derives the systems without errors in these folders, those of one file in [`share`], and checks each while other
    /// tests read the pages.
    pub(super) fn of(folders: &'static [&str], check: fn(&System)) -> Self {
        let (send, pages) = mpsc::channel();
        let work = move || {
            let systems: Vec<System> = tokens(folders).into_iter().filter_map(System::new).collect();
            send.send(systems.iter().map(|system| system.forms.clone()).collect()).expect("a test");
            systems.iter().for_each(check);
        };
        // Some systems nest deeply, so the thread needs a large stack. They stay in it: types of `syn` cannot leave.
        let thread = std::thread::Builder::new().stack_size(1 << 28).spawn(work).expect("a thread");
        Self { pages: pages.recv().expect("pages"), checks: Mutex::new(Some(thread)) }
    }

    /// Panics if a check fails.
    pub(super) fn pass(&self) {
        let thread = self.checks.lock().expect("no panic").take().expect("one test");
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    }
}

fn tokens(folders: &[&str]) -> Vec<TokenStream> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let (mut paths, mut found) = (Vec::new(), Vec::new());
    folders.iter().for_each(|folder| files(&root.join(folder), &mut paths));
    for path in paths.into_iter().step_by(share()) {
        let text = std::fs::read_to_string(path).expect("a text");
        sources(&text)
            .iter()
            .filter_map(|source| source.parse().ok())
            .for_each(|tokens| structs(tokens, &mut found));
    }
    found
}
