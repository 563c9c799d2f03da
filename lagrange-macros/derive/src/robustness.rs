//! The derive never panics: on correct input, wrong input, randomly changed input, and random combinations of the
//! language's forms.
//!
//! Inputs that once caused a panic are kept in `robustness/corpus`, with systems that together use every attribute
//! and every form of expression. Random changes start from these.

mod grammar;
mod streams;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use proc_macro2::TokenStream;

use crate::expand;
use lagrange_random::{cases, rounds};

fn tokens(text: &str) -> TokenStream {
    text.parse().expect("these are tokens")
}

/// Reads the sources in a folder of the corpus.
fn corpus(folder: &str) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/robustness/corpus").join(folder);
    let mut files: Vec<_> =
        folder.read_dir().expect("a folder").map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    files.into_iter().map(|file| std::fs::read_to_string(file).expect("a text")).collect()
}

/// Expands the input. The result must be Rust code with an implementation, or errors.
fn check(input: &TokenStream) -> TokenStream {
    let Ok(expansion) = catch_unwind(AssertUnwindSafe(|| expand(input.clone()))) else {
        panic!("the derive panics on {input}")
    };
    assert!(is_error(&expansion) || expansion.to_string().contains("impl"), "no answer to {input}");
    if let Err(error) = syn::parse2::<syn::File>(expansion.clone())
        && is_item(input)
    {
        panic!("no Rust is made of {input}: {error}");
    }
    expansion
}

/// Returns true if the input is an item that rustc accepts and hands to a derive. syn is laxer: it also parses
/// `struct Chain<_>`, so type parameters named `_` are rejected here.
fn is_item(input: &TokenStream) -> bool {
    let item = syn::parse2::<syn::DeriveInput>(input.clone());
    item.is_ok_and(|item| item.generics.type_params().all(|parameter| parameter.ident != "_"))
}

fn is_error(expansion: &TokenStream) -> bool {
    expansion.to_string().contains("compile_error")
}

#[test]
fn the_systems_are_accepted_as_they_are() {
    for system in corpus("accepted").iter().step_by(cases([4, 2, 1])) {
        let expansion = check(&tokens(system));
        assert!(!is_error(&expansion), "{system}: {expansion}");
    }
}

#[test]
fn what_is_wrong_is_refused() {
    for system in corpus("refused") {
        assert!(is_error(&check(&tokens(&system))), "{system}");
    }
}

#[test]
fn random_changes_never_make_it_panic() {
    let (pool, systems) = (streams::pool(), [corpus("accepted"), corpus("refused")].concat());
    rounds("changes", [50, 300, 200_000], |random| {
        let mut input = tokens(&random.one_of(&systems));
        for _ in 0..=random.below(3) {
            input = streams::mutated(input, &pool, random);
        }
        check(&input);
    });
}

#[test]
fn random_tokens_never_make_it_panic() {
    let pool = streams::pool();
    rounds("tokens", [50, 500, 200_000], |random| {
        check(&streams::arbitrary(&pool, random));
    });
}

/// Random forms reach the later stages: some of the systems are accepted.
#[test]
fn random_forms_never_make_it_panic() {
    let (mut all, mut accepted) = (0, 0);
    rounds("forms", [5, 12, 20_000], |random| {
        all += 1;
        accepted += usize::from(!is_error(&check(&tokens(&grammar::system(random)))));
    });
    println!("{accepted} of {all} systems are accepted");
    assert!(all < 20 || 40 * accepted > all, "{accepted} of {all} are accepted");
}

/// A Lagrangian of `begin`, then `unit` of every number from 1 to `count`, then `end`.
fn long(begin: &str, count: usize, unit: impl Fn(usize) -> String, end: &str) -> TokenStream {
    let middle: String = (1..=count).map(unit).collect();
    tokens(&format!("#[coordinates(x)] #[lagrangian(x_dot^2 {begin}{middle}{end})] struct System;"))
}

#[test]
fn long_input_ends_in_an_answer() {
    let same = |text: &'static str| move |_: usize| text.to_owned();
    assert!(!is_error(&expand(long("", cases([5_000, 10_000, 20_000]), same("+ x"), ""))));
    assert!(!is_error(&expand(long("", cases([200, 500, 1_000]), |i| format!("+ sin({i}*x)"), ""))));
    assert!(is_error(&expand(long("", 20_000, |i| format!("+ sin({i}*x)"), ""))));
    assert!(is_error(&expand(long("* x", 20_000, same("* (x + 1)"), ""))));
    assert!(is_error(&expand(long("+ sum(i in 0..100000, sum(j in 0..100000, x", 1, same("))"), ""))));
    assert!(is_error(&expand(long("+ x", 10_000, same("^x"), ""))));
    assert!(is_error(&expand(long("+ x", 10_000, same("[0]"), ""))));
    assert!(is_error(&expand(long("+", 10_000, same("-"), "x"))));
}

/// f1(a) = f0(f0(a)), f2(a) = f1(f1(a)), …: 2⁴⁰ calls.
#[test]
fn runaway_definitions_end_in_an_error() {
    let functions: String = (1..=40).map(|i| format!("#[define(f{i}(a) = f{0}(f{0}(a)))]", i - 1)).collect();
    let input = format!(
        "#[coordinates(x)] #[define(f0(a) = sin(a))] {functions} #[lagrangian(x_dot^2 - f40(x))] struct System;"
    );
    assert!(is_error(&expand(tokens(&input))));
}

/// v1 = [v0, v0], v2 = [v1, v1], …: 2⁴⁰ numbers.
#[test]
fn runaway_vectors_end_in_an_error() {
    let vectors: String = (1..=40).map(|i| format!("#[define(v{i} = [v{0}, v{0}])]", i - 1)).collect();
    let input =
        format!("#[coordinates(x)] #[define(v0 = x)] {vectors} #[lagrangian(x_dot^2)] struct System;");
    assert!(is_error(&expand(tokens(&input))));
}
