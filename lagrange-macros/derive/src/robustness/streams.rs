//! Random token streams: words of the language in any order, or changed input.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use lagrange_random::Random;

/// Words and signs, some of the language and some not.
const TOKENS: &str = "x y r theta x_dot r_dot x_ddot t pi m k sin sqrt norm dot cross der lambda sum in i n rod \
    0 1 2 3 7 0.5 1e30 9.81 1_000_000 170141183460469231731687303715884105727 99999999999 \
    + - * / ^ = , : . .. ( ) [ ] (x) [1] (x, y) [x, y] (0) () [] {} (i in 0..3) r#fn self _ crate as fn 'a \"x\" 2m ; # & < !";

const ATTRIBUTES: [&str; 15] = [
    "coordinates",
    "define",
    "function",
    "frame",
    "lagrangian",
    "constraint",
    "force",
    "power",
    "dissipation",
    "observable",
    "conserved",
    "parameter",
    "lagrange",
    "derive",
    "doc",
];

pub(super) fn pool() -> Vec<TokenTree> {
    TOKENS.split_whitespace().filter_map(|word| word.parse::<TokenStream>().ok()).flatten().collect()
}

fn delimiter(random: &mut Random) -> Delimiter {
    random.one_of(&[Delimiter::Parenthesis, Delimiter::Bracket, Delimiter::None])
}

/// A struct with attributes of random content.
pub(super) fn arbitrary(pool: &[TokenTree], random: &mut Random) -> TokenStream {
    let attributes: String =
        (0..random.below(6)).map(|_| attribute(random.one_of(&ATTRIBUTES), pool, random)).collect();
    let fields = sequence(pool, random, 1);
    let bodies =
        ["{ m: f64, r: [f64; 3] }".to_owned(), ";".to_owned(), "{}".to_owned(), format!("{{ {fields} }}")];
    let body = random.one_of(&bodies);
    format!("#[coordinates(x, r: [3])] {attributes} struct System {body}").parse().unwrap_or_default()
}

fn attribute(name: &str, pool: &[TokenTree], random: &mut Random) -> String {
    format!("#[{name}({})]\n", sequence(pool, random, 3))
}

fn sequence(pool: &[TokenTree], random: &mut Random, depth: usize) -> TokenStream {
    (0..random.below(12))
        .map(|_| match depth {
            1.. if random.once_in(5) => {
                Group::new(delimiter(random), sequence(pool, random, depth - 1)).into()
            }
            _ => random.one_of(pool),
        })
        .collect()
}

/// Changes the input in one place: in the content of an attribute, or sometimes outside of it.
pub(super) fn mutated(input: TokenStream, pool: &[TokenTree], random: &mut Random) -> TokenStream {
    let mut trees: Vec<TokenTree> = input.into_iter().collect();
    let attributes: Vec<usize> = (1..trees.len())
        .filter(|&i| matches!(&trees[i - 1], TokenTree::Punct(p) if p.as_char() == '#'))
        .collect();
    if attributes.is_empty() || random.once_in(8) {
        change(&mut trees, pool, random);
        return trees.into_iter().collect();
    }
    let chosen = random.one_of(&attributes);
    if let TokenTree::Group(attribute) = &trees[chosen] {
        let mut inside: Vec<TokenTree> = attribute.stream().into_iter().collect();
        if let Some(TokenTree::Group(content)) = inside.get(1) {
            inside[1] = changed(content, pool, random);
        }
        trees[chosen] = Group::new(Delimiter::Bracket, inside.into_iter().collect()).into();
    }
    trees.into_iter().collect()
}

/// Changes one place in a group, or in a group inside of it.
fn changed(group: &Group, pool: &[TokenTree], random: &mut Random) -> TokenTree {
    let mut trees: Vec<TokenTree> = group.stream().into_iter().collect();
    let groups: Vec<usize> = (0..trees.len()).filter(|&i| matches!(&trees[i], TokenTree::Group(_))).collect();
    if !groups.is_empty() && random.once_in(2) {
        let i = random.one_of(&groups);
        if let TokenTree::Group(inner) = &trees[i] {
            trees[i] = changed(inner, pool, random);
        }
    } else {
        change(&mut trees, pool, random);
    }
    Group::new(group.delimiter(), trees.into_iter().collect()).into()
}

fn change(trees: &mut Vec<TokenTree>, pool: &[TokenTree], random: &mut Random) {
    let fresh = random.one_of(pool);
    let (i, j) = (random.below(trees.len() + 1), random.below(trees.len() + 1));
    match random.below(6) {
        0 if i < trees.len() => trees[i] = fresh,
        1 if i < trees.len() => drop(trees.remove(i)),
        2 if i < trees.len() && j < trees.len() => trees.swap(i, j),
        3 if i < trees.len() => trees.insert(j, trees[i].clone()),
        4 if i < j => {
            let inside: TokenStream = trees.drain(i..j).collect();
            trees.insert(i, Group::new(delimiter(random), inside).into());
        }
        _ => trees.insert(i, fresh),
    }
}
