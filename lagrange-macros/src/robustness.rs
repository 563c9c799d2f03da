//! The derive never panics: right input, wrong input, and right input with something random done to it.

use std::panic::{AssertUnwindSafe, catch_unwind};

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use crate::expand;

/// Between them these use every attribute and every form of expression.
const SYSTEMS: [&str; 5] = [
    "#[coordinates(x, phi)]
    #[define(inertia = 2/5 * m * a^2)]
    #[lagrangian(m/2 * x_dot^2 + inertia/2 * phi_dot^2 + m*9.81*x*sin(alpha))]
    #[constraint(no_slip: x_dot - a*phi_dot = 0)]
    #[dissipation(c/2 * x_dot^2)]
    #[observable(friction = lambda(no_slip))]
    #[observable(push = m*x_ddot - der(x_dot))]
    struct Sphere { m: f64, a: f64, c: f64, alpha: f64 }",
    "#[coordinates(r: [3])]
    #[define(U(s) = k/norm(s) + exp(-abs(s[0])))]
    #[lagrangian(m/2 * dot(r_dot, r_dot) - U(r) + dot(omega, cross(r, A * r_dot)))]
    #[constraint(ball: dot(r, r)/2 = 1/2)]
    #[force(r: [0, -1, t])]
    #[force(r[1]: -2^-1 * r_dot[1])]
    #[parameter(k: 0..1_000)]
    #[lagrange(crate = lagrange_core, scalar = f64)]
    struct Ball { m: f64, k: f64, omega: [f64; 3], A: Matrix3<f64> }",
    "#[coordinates(theta: [3])]
    #[define(n = 3)]
    #[define(x[0] = sin(theta[0]))]
    #[define(x[i in 1..n] = x[i - 1] + l*sin(theta[i]))]
    #[lagrangian(sum(i in 0..n, der(x[i])^2/2 + theta_dot[i]^2) + sum(i in 0..n, atan2(theta[i], pi)))]
    #[constraint(rod[i in 0..2]: theta[i] = theta[i + 1])]
    #[observable(pulls = [lambda(rod)[0], lambda(rod[1])])]
    struct Chain<T> { l: T }",
    "#[coordinates(r: [2, 3], q: [2, 4])]
    #[frame(body[i in 0..2]: translate(r[i]), rotate(q[i]))]
    #[define(d[i in 0..2, j in 0..i] = norm(r[i] - r[j]))]
    #[define(a[i in 0..2] = b[i] + m)] #[define(b[i in 0..2] = sum(j in 0..i, a[j]))]
    #[lagrangian(sum(i in 0..2, kinetic(body[i], m, [0, 0, 0], identity(3)) + sum(j in 0..i, a[i]/d[i][j])))]
    #[force(r[k in 0..2, 1]: -r_dot[k][0])]
    #[power(i in 0..2, vector(body[i], r[1]), velocity(body[i]))]
    #[observable(turning[i in 0..2] = angular_velocity(body[i]))]
    struct Bodies { m: f64 }",
    "#[coordinates(x, y)]
    #[lagrangian((x_dot^2 + y_dot^2)/(2*x^0.5) - sqrt(x*y)^3 + x^y * ln(x) - tanh(1e-3 * x))]
    #[conserved(e = (x_dot^2 + y_dot^2)/(2*x^0.5) + sqrt(x*y)^3 - x^y * ln(x) + tanh(1e-3 * x))]
    struct Odd<'a> { t: String, other: &'a [u8] }",
];

/// What mutations insert.
const TOKENS: &str = "x y r theta x_dot r_dot x_ddot t pi m k sin sqrt norm dot cross der lambda sum in i n rod \
    0 1 2 3 7 0.5 1e30 9.81 1_000_000 170141183460469231731687303715884105727 99999999999 \
    + - * / ^ = , : . .. ( ) [ ] (x) [1] (x, y) [x, y] (0) () [] {} (i in 0..3) r#fn self _ crate as fn 'a \"x\" 2m ; # & < !";

/// Steele, Lea and Flood's SplitMix64: the same sequence in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }
}

fn tokens(text: &str) -> TokenStream {
    text.parse().expect("these are tokens")
}

fn pool() -> Vec<TokenTree> {
    TOKENS.split_whitespace().filter_map(|word| word.parse::<TokenStream>().ok()).flatten().collect()
}

/// The content of one attribute changed in one place; other tokens are left as they are.
fn mutated(input: TokenStream, pool: &[TokenTree], random: &mut Random) -> TokenStream {
    let mut trees: Vec<TokenTree> = input.into_iter().collect();
    let attributes: Vec<usize> = (1..trees.len())
        .filter(|&i| matches!(&trees[i - 1], TokenTree::Punct(p) if p.as_char() == '#'))
        .collect();
    let chosen = attributes[random.below(attributes.len())];
    if let TokenTree::Group(attribute) = &trees[chosen] {
        let mut inside: Vec<TokenTree> = attribute.stream().into_iter().collect();
        if let Some(TokenTree::Group(content)) = inside.get(1) {
            inside[1] = changed(content, pool, random);
        }
        trees[chosen] = Group::new(Delimiter::Bracket, inside.into_iter().collect()).into();
    }
    trees.into_iter().collect()
}

/// One change somewhere in a group, or in a group inside of it.
fn changed(group: &Group, pool: &[TokenTree], random: &mut Random) -> TokenTree {
    let mut trees: Vec<TokenTree> = group.stream().into_iter().collect();
    let groups: Vec<usize> = (0..trees.len()).filter(|&i| matches!(&trees[i], TokenTree::Group(_))).collect();
    if !groups.is_empty() && random.below(2) == 0 {
        let i = groups[random.below(groups.len())];
        if let TokenTree::Group(inner) = &trees[i] {
            trees[i] = changed(inner, pool, random);
        }
    } else {
        change(&mut trees, pool, random);
    }
    Group::new(group.delimiter(), trees.into_iter().collect()).into()
}

fn change(trees: &mut Vec<TokenTree>, pool: &[TokenTree], random: &mut Random) {
    let fresh = pool[random.below(pool.len())].clone();
    let (i, j) = (random.below(trees.len() + 1), random.below(trees.len() + 1));
    match random.below(6) {
        0 if i < trees.len() => trees[i] = fresh,
        1 if i < trees.len() => drop(trees.remove(i)),
        2 if i < trees.len() && j < trees.len() => trees.swap(i, j),
        3 if i < trees.len() => trees.insert(j, trees[i].clone()),
        4 if i < j => {
            let delimiters = [Delimiter::Parenthesis, Delimiter::Bracket, Delimiter::None];
            let inside: TokenStream = trees.drain(i..j).collect();
            trees.insert(i, Group::new(delimiters[random.below(3)], inside).into());
        }
        _ => trees.insert(i, fresh),
    }
}

/// Expands, and requires an implementation, or errors.
fn check(input: &TokenStream) {
    let Ok(expansion) = catch_unwind(AssertUnwindSafe(|| expand(input.clone()))) else {
        panic!("the derive panics on {input}")
    };
    assert!(is_error(&expansion) || expansion.to_string().contains("impl"), "no answer to {input}");
}

fn is_error(expansion: &TokenStream) -> bool {
    expansion.to_string().contains("compile_error")
}

#[test]
fn the_systems_are_accepted_as_they_are() {
    for system in SYSTEMS {
        let expansion = expand(tokens(system));
        assert!(!is_error(&expansion), "{system}: {expansion}");
    }
}

#[test]
fn random_changes_never_make_it_panic() {
    let mut random = Random(1);
    let pool = pool();
    let rounds = std::env::var("LAGRANGE_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(2_000);
    for round in 0..rounds {
        let mut input = tokens(SYSTEMS[round % SYSTEMS.len()]);
        for _ in 0..=random.below(3) {
            input = mutated(input, &pool, &mut random);
        }
        check(&input);
    }
}

/// `begin`, then `unit` of every number from 1 to `count`, then `end`, as a Lagrangian.
fn long(begin: &str, count: usize, unit: impl Fn(usize) -> String, end: &str) -> TokenStream {
    let middle: String = (1..=count).map(unit).collect();
    tokens(&format!("#[coordinates(x)] #[lagrangian(x_dot^2 {begin}{middle}{end})] struct System;"))
}

#[test]
fn long_input_ends_in_an_answer() {
    let same = |text: &'static str| move |_: usize| text.to_owned();
    assert!(!is_error(&expand(long("", 20_000, same("+ x"), ""))));
    assert!(!is_error(&expand(long("", 1_000, |i| format!("+ sin({i}*x)"), ""))));
    assert!(is_error(&expand(long("", 20_000, |i| format!("+ sin({i}*x)"), ""))));
    assert!(is_error(&expand(long("* x", 20_000, same("* (x + 1)"), ""))));
    assert!(is_error(&expand(long("+ sum(i in 0..100000, sum(j in 0..100000, x", 1, same("))"), ""))));
    assert!(is_error(&expand(long("+ x", 10_000, same("^x"), ""))));
    assert!(is_error(&expand(long("+ x", 10_000, same("[0]"), ""))));
    assert!(is_error(&expand(long("+", 10_000, same("-"), "x"))));
}

/// f1(a) = f0(f0(a)), f2(a) = f1(f1(a)), …: two to the fortieth calls.
#[test]
fn runaway_definitions_end_in_an_error() {
    let functions: String = (1..=40).map(|i| format!("#[define(f{i}(a) = f{0}(f{0}(a)))]", i - 1)).collect();
    let input = format!(
        "#[coordinates(x)] #[define(f0(a) = sin(a))] {functions} #[lagrangian(x_dot^2 - f40(x))] struct System;"
    );
    assert!(is_error(&expand(tokens(&input))));
}

/// v1 = [v0, v0], v2 = [v1, v1], …: two to the fortieth numbers.
#[test]
fn runaway_vectors_end_in_an_error() {
    let vectors: String = (1..=40).map(|i| format!("#[define(v{i} = [v{0}, v{0}])]", i - 1)).collect();
    let input =
        format!("#[coordinates(x)] #[define(v0 = x)] {vectors} #[lagrangian(x_dot^2)] struct System;");
    assert!(is_error(&expand(tokens(&input))));
}
