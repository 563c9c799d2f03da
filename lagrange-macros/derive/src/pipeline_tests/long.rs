//! Long functions are split into parts; functions that are too long are errors.

use std::collections::BTreeSet;

use lagrange_random::{Random, cases};
use proc_macro2::{TokenStream, TokenTree};

use super::{bodies, systems, tokens};
use crate::expand;

/// A Lagrangian of squares of long sums without common terms.
fn flat(n: usize) -> String {
    let arm =
        |function: &str| format!("sum(j in 0..i+1, (i + j + 1)*l[j]*{function}(theta[j])*theta_dot[j])^2");
    format!(
        "#[coordinates(theta: [{n}])]
         #[lagrangian(sum(i in 0..{n}, m[i]/2*({} + {})))]
         struct Flat {{ m: [f64; {n}], l: [f64; {n}] }}",
        arm("cos"),
        arm("sin")
    )
}

/// Bodies of the functions whose names start with `start`.
fn functions(tokens: TokenStream, start: &str) -> Vec<TokenStream> {
    let (mut found, mut is_wanted, mut before) = (Vec::new(), false, String::new());
    for token in tokens {
        let text = token.to_string();
        if before == "fn" {
            is_wanted = text.starts_with(start);
        }
        if let TokenTree::Group(group) = token {
            match group.delimiter() {
                proc_macro2::Delimiter::Brace if std::mem::take(&mut is_wanted) => found.push(group.stream()),
                _ => found.extend(functions(group.stream(), start)),
            }
        }
        before = text;
    }
    found
}

/// Counts the infix operators in a function body.
fn operations(tokens: TokenStream) -> usize {
    let count = |token| match token {
        TokenTree::Punct(sign) => usize::from("+-*/".contains(sign.as_char())),
        TokenTree::Group(group) => operations(group.stream()),
        _ => 0,
    };
    tokens.into_iter().map(count).sum()
}

#[test]
fn a_long_function_is_cut_into_parts_of_a_thousand_operations_or_more() {
    let expansion = expand(tokens(&systems::chain(40)));
    let parts = functions(expansion.clone(), "__mass_matrix_");
    let lengths: Vec<usize> = parts.into_iter().map(operations).collect();
    assert!(
        lengths.len() >= 3 && lengths.iter().all(|length| (1_000..=2_000).contains(length)),
        "{lengths:?}"
    );
    assert!(expansion.to_string().contains(&format!("In {} parts.", lengths.len())));
    let main = functions(expansion, "mass_matrix");
    assert_eq!(main.into_iter().map(operations).collect::<Vec<_>>(), [0]);
}

/// Twice as many joints lengthen the code of an arm by less than a third: most are computed in the same loops.
#[test]
fn what_the_joints_of_an_arm_have_in_common_is_emitted_once() {
    let length = |joints: usize| {
        let arm = bodies::ARM.replace("[6]", &format!("[{joints}]")).replace("..6", &format!("..{joints}"));
        let expansion = expand(tokens(&arm.replace("; 6]", &format!("; {joints}]"))));
        let parts = functions(expansion, "__accelerations_unchecked_").into_iter();
        parts.map(|part| part.into_iter().count()).sum::<usize>()
    };
    let [short, long] = [12, 24].map(length);
    assert!(long < short + short / 3, "{short} tokens for 12 joints, {long} for 24");
}

#[test]
fn short_functions_stay_whole() {
    assert_eq!(functions(expand(tokens(&systems::chain(20))), "__").len(), 0);
}

#[test]
fn a_matrix_of_zeros_is_not_written_out() {
    let expansion = expand(tokens(&systems::rods(60)));
    let [mass] = &functions(expansion, "mass_matrix")[..] else { panic!("one mass matrix") };
    let mass = mass.to_string();
    assert!(mass.contains("[[0.0 ; 120usize] ; 120usize]"), "{mass}");
    assert_eq!(mass.matches("entries0 [").count(), 120);
}

#[test]
fn too_long_functions_are_refused_with_their_counts() {
    for size in (52..).take(cases([0, 1, 1])) {
        assert_refused_with_its_counts(&expand(tokens(&flat(size))).to_string());
    }
}

fn assert_refused_with_its_counts(expansion: &str) {
    let [refusal] = expansion.split("compile_error").skip(1).collect::<Vec<_>>()[..] else {
        panic!("one error: {expansion}")
    };
    for said in [
        "`mass_matrix` takes ",
        "`accelerations_unchecked` takes ",
        " operations (+ − × ÷ √), 104 elementary functions",
    ] {
        assert!(refusal.contains(said), "{said}: {refusal}");
    }
    assert!(
        refusal.contains("more than the 50000 that one function may have")
            && refusal.contains("#[define(…)]")
    );
}

/// A chain of links of two kinds, in the order of `kinds`. All lengths, axes, centres and inertias are fields.
fn unlike_links(kinds: &[bool]) -> String {
    let n = kinds.len();
    let frames = kinds.iter().enumerate().map(|(i, is_bent)| {
        let inside = if i == 0 { String::new() } else { format!(" in b{}", i - 1) };
        let steps = match is_bent {
            true => format!("translate([0, 0, l[{i}]]), rotate_x(al[{i}]*sin(q[{i}])), rotate_z(q[{i}]/2)"),
            false => format!("translate(d[{i}]), rotate(ax[{i}], q[{i}])"),
        };
        format!("#[frame(b{i}{inside}: {steps})]")
    });
    let energies: Vec<String> = (0..n).map(|i| format!("kinetic(b{i}, m[{i}], c[{i}], J[{i}])")).collect();
    format!(
        "#[coordinates(q: [{n}])] {} #[lagrangian({})]
         struct Chain {{
             l: [f64; {n}], al: [f64; {n}], d: [Vector3<f64>; {n}], ax: [Vector3<f64>; {n}],
             m: [f64; {n}], c: [Vector3<f64>; {n}], J: [Matrix3<f64>; {n}],
         }}",
        frames.collect::<String>(),
        energies.join(" + ")
    )
}

/// Collects generated locals, such as `r12`, `angle3` or `call4_0`, that a function body uses without declaring
/// them.
fn undeclared(tokens: TokenStream, declared: &mut BTreeSet<String>, found: &mut BTreeSet<String>) {
    let mut is_pattern = false;
    for token in tokens {
        match token {
            TokenTree::Ident(word) if word == "let" => is_pattern = true,
            TokenTree::Punct(sign) if "=:;".contains(sign.as_char()) => is_pattern = false,
            TokenTree::Ident(word) if is_local(&word.to_string()) => {
                let word = word.to_string();
                if is_pattern {
                    declared.insert(word);
                } else if !declared.contains(&word) {
                    found.insert(word);
                }
            }
            TokenTree::Group(group) if is_pattern => {
                let names = group.stream().into_iter().flat_map(|token| match token {
                    TokenTree::Group(group) => group.stream().into_iter().collect(),
                    token => vec![token],
                });
                declared.extend(names.map(|token| token.to_string()).filter(|word| is_local(word)));
            }
            TokenTree::Group(group) => undeclared(group.stream(), declared, found),
            _ => {}
        }
    }
}

fn is_local(word: &str) -> bool {
    let number = ["angle", "call", "r"].iter().find_map(|start| word.strip_prefix(start));
    number.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
}

fn assert_parts_see_their_own_locals(system: &str) {
    for body in functions(expand(tokens(system)), "") {
        let mut found = BTreeSet::new();
        undeclared(body, &mut BTreeSet::new(), &mut found);
        assert!(found.is_empty(), "{found:?} in {system}");
    }
}

/// With two of three links alike, a loop and the code outside of it compute the sine and the cosine of the same
/// angle. At the level `full`, further random chains have 15 to 32 links.
#[test]
fn parts_of_a_chain_of_unlike_links_see_their_own_locals_alone() {
    assert_parts_see_their_own_locals(&unlike_links(&std::array::from_fn::<_, 15, _>(|i| i % 3 < 2)));
    let mut random = Random(1);
    for _ in 0..cases([0, 0, 200]) {
        let (links, period) = (15 + random.below(18), 1 + random.below(5));
        let turn: Vec<bool> = (0..period).map(|_| random.once_in(2)).collect();
        let kinds: Vec<bool> = (0..links).map(|i| turn[i % period] != random.once_in(8)).collect();
        assert_parts_see_their_own_locals(&unlike_links(&kinds));
    }
}
