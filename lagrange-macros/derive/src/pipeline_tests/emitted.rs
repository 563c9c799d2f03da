//! Properties of the emitted code.

use std::collections::BTreeMap;

use expect_test::expect_file;
use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;

use super::{systems, tokens};
use crate::expand;

/// Shows reviewers how a change of the code generator changes the emitted code. `UPDATE_EXPECT=1 cargo test`
/// accepts the change.
#[test]
fn the_expansion_of_a_pendulum_is_as_reviewed() {
    let file = syn::parse2(expand(tokens(systems::PENDULUM))).expect("items");
    expect_file!["emitted/pendulum.rs"].assert_eq(&prettyplease::unparse(&file));
}

/// Arguments of the sines and cosines in each emitted function, one entry per evaluation.
#[derive(Default)]
struct Circular {
    function: String,
    arguments: BTreeMap<String, Vec<String>>,
}

impl Circular {
    fn read(&mut self, tokens: TokenStream) {
        let mut before = [String::new(), String::new()];
        for token in tokens {
            let text = token.to_string();
            if before[1] == "fn" {
                self.function = text.clone();
            }
            if let TokenTree::Group(group) = token {
                let taken = self.arguments.entry(self.function.clone()).or_default();
                match before[1].as_str() {
                    "sin" | "cos" | "sin_cos" if before[0] == ":" => taken.push(group.stream().to_string()),
                    "sin_cos_of_small" => taken.extend(angles(group.stream())),
                    _ => {}
                }
                self.read(group.stream());
            }
            before = [std::mem::take(&mut before[1]), text];
        }
    }
}

/// Returns `a` and `b` of `[a, b]`.
fn angles(argument: TokenStream) -> Vec<String> {
    let array: syn::ExprArray = syn::parse2(argument).expect("an array");
    array.elems.iter().map(|angle| angle.to_token_stream().to_string()).collect()
}

#[test]
fn sines_of_many_angles_are_called_for() {
    let paths = |links| {
        let emitted = expand(tokens(&systems::chain(links))).to_string();
        ["Scalar", "generated"].map(|path| emitted.contains(&format!("{path} :: sin_cos_of_small")))
    };
    assert_eq!((paths(7), paths(8)), ([true, false], [false, true]));
}

#[test]
fn the_sine_and_the_cosine_of_an_angle_are_computed_once() {
    let mut circular = Circular::default();
    circular.read(expand(tokens(&systems::chain(12))));
    let all = circular.arguments.get_mut("accelerations_unchecked").expect("sines");
    assert_eq!(all.len(), 12, "one for each angle: {all:?}");
    for (function, mut arguments) in circular.arguments {
        let computed = arguments.len();
        arguments.sort_unstable();
        arguments.dedup();
        assert_eq!(arguments.len(), computed, "one argument twice in `{function}`: {arguments:?}");
    }
}
