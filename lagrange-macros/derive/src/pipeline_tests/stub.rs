//! The stub of a system with errors has the same interface as the system, so that the rest of the program compiles.

use std::collections::BTreeSet;

use proc_macro2::TokenStream;
use quote::quote;

use super::{declaration, systems, tokens};
use crate::{expand, stub};

/// Every form of expression that affects the interface: families, vectors, functions, unused fields.
const RICH: &str = "
    #[coordinates(r: [3], q: [4], z)]
    #[function(U(s: [3]): [2] = potential)]
    #[define(n = 3)]
    #[define(arm[0] = r[0])]
    #[define(arm[i in 1..n] = 2*arm[i - 1] + z*u[1])]
    #[define(speed(a) = der(a) * g)]
    #[define(turned = quat_rotate(q, r) + w)]
    #[lagrangian(m/2 * (dot(r_dot, r_dot) + dot(q_dot, q_dot) + z_dot^2) - z*U(r)[0])]
    #[constraint(unit: dot(q, q) = 1)]
    #[constraint(rod[i in 0..n - 1]: arm[i] - arm[i + 1] = l)]
    #[constraint(corner: [z, r[2]] = turned[0]*[1, 2])]
    #[force(z: -f * z_dot)]
    #[force(r: -k * r_dot)]
    #[dissipation(c/2 * z_dot^2)]
    #[observable(place = turned)]
    #[observable(swept = cross(r, r_dot) / g)]
    #[observable(pull = lambda(unit))]
    #[observable(pulls = [pull, z, b])]
    #[observable(thrust = speed(z_dot) + 1)]
    #[observable(alone = [z])]
    #[observable(shift = der(turned) * m)]
    #[parameter(w: [3])]
    pub struct Rich<'a, T, F> {
        m: T, g: T, u: [T; 2], l: T, f: T, k: T, c: &'a T, b: T, w: Three<T>, unused: [T; 9], potential: F, tag: &'a str,
    }
";

/// Traits and signatures in the implementations, as text. Functions that contain parts of long functions are
/// private.
fn promises(expansion: TokenStream) -> BTreeSet<String> {
    let file: syn::File = syn::parse2(expansion).expect("items");
    let blocks = file.items.into_iter().filter_map(|item| match item {
        syn::Item::Const(item) => Some(*item.expr),
        _ => None,
    });
    let items = blocks.flat_map(|block| match block {
        syn::Expr::Block(block) => block.block.stmts,
        _ => Vec::new(),
    });
    let mut promises = BTreeSet::new();
    for statement in items {
        let syn::Stmt::Item(syn::Item::Impl(item)) = statement else { continue };
        let of = item.trait_.map(|(path, _)| quote!(#path).to_string()).unwrap_or_default();
        // The stub has all marker traits, the system only those that are proved.
        if of.contains(":: structure ::") {
            continue;
        }
        promises.insert(of.clone());
        for item in item.items {
            let promise = match item {
                syn::ImplItem::Fn(syn::ImplItemFn { vis, sig, .. }) => quote!(#vis #sig),
                syn::ImplItem::Const(syn::ImplItemConst { vis, ident, ty, .. }) => quote!(#vis #ident: #ty),
                syn::ImplItem::Type(syn::ImplItemType { ident, ty, .. }) => quote!(#ident = #ty),
                _ => continue,
            };
            promises.insert(format!("{of} {promise}"));
        }
    }
    // Sizes that only a derived system knows: of the factorization, and of the lists of slopes, sums and series
    // terms.
    let counted = [" Factor = ", "Slopes = ", " Sums = ", " SeriesTerms = "];
    promises.retain(|promise| !counted.iter().any(|name| promise.contains(name)));
    // Items with a default in the trait, which the stub does not replace.
    let provided = [
        "constraint_integral",
        "CONSTRAINT_CLASSES",
        "INTEGRALS",
        "MOMENTA_ARE_LINEAR",
        "EQUATIONS",
        "DIGEST",
        "SUPPLIED",
        "ARGUMENTS",
        "ROOTS",
        "STEEP",
        "series_functions",
        "visit_parameters",
    ];
    promises.retain(|promise| !provided.iter().any(|name| promise.contains(name)));
    promises
}

fn given(source: &str) -> BTreeSet<String> {
    promises(expand(tokens(source)))
}

fn promised(source: &str) -> BTreeSet<String> {
    promises(stub(&declaration(source).0, Vec::new()))
}

#[test]
fn a_stub_promises_what_the_system_gives() {
    for source in [systems::PENDULUM, systems::SPHERE, &systems::chain(3), &systems::rods(3), RICH] {
        assert_eq!(promised(source), given(source), "{source}");
    }
}

/// Text that makes an attribute wrong: an unknown name, an unknown function, syntax errors.
const WRONG: [&str; 4] = [" * nothing", " * nothing(2, 3)", " nothing", " 2z"];

#[test]
fn a_stub_promises_the_same_where_something_is_wrong() {
    let words = ["define", "lagrangian", "constraint", "force", "dissipation", "observable"];
    let is_expression = |line: &str| words.iter().any(|word| line.trim().starts_with(&format!("#[{word}(")));
    let (given, lines) = (given(RICH), RICH.lines().collect::<Vec<_>>());
    for (index, line) in lines.iter().enumerate() {
        // If a number of elements is wrong, the intended number is unknown.
        if !is_expression(line) || line.contains("n = 3") {
            continue;
        }
        for wrong in WRONG {
            let line = line.replace(")]", &format!("{wrong})]"));
            let mut lines = lines.clone();
            lines[index] = &line;
            assert_eq!(promised(&lines.join("\n")), given, "{line}");
        }
    }
}
