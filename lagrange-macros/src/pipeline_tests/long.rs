//! Long functions are cut into parts, and too long ones are refused.

use proc_macro2::{TokenStream, TokenTree};

use super::{bodies, systems, tokens};
use crate::expand;

/// Squares of long sums that have no term in common.
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

/// The functions whose names start so, and their bodies.
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

/// Infix operators in a body.
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

/// An arm of twice as many joints computes most of them in the same loops.
#[test]
fn what_the_joints_of_an_arm_have_in_common_is_emitted_once() {
    let length = |joints: usize| {
        let arm = bodies::ARM.replace("[6]", &format!("[{joints}]")).replace("..6", &format!("..{joints}"));
        let expansion = expand(tokens(&arm.replace("; 6]", &format!("; {joints}]"))));
        let parts = functions(expansion, "__accelerations_unchecked_").into_iter();
        parts.map(|part| part.into_iter().count()).sum::<usize>()
    };
    let [short, long] = [16, 32].map(length);
    assert!(long < short + short / 3, "{short} tokens for 16 joints, {long} for 32");
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
    let expansion = expand(tokens(&flat(52))).to_string();
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
