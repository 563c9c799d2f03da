//! Recognizes scalars that are products of vectors from their components: p·p in p₀² + p₁² + p₂².

use std::collections::BTreeMap;

use num_traits::Zero;

use super::super::formula::Formula;
use super::atoms::Meaning;
use super::collect::Collector;
use super::vectors::{Components, Products, Vector, VectorTerm, terms_of};
use crate::symbolic::{self, Monomial, Polynomial, Rational};
use crate::variables::Variable;

/// Sum of products of components, with a coefficient for each product.
type ComponentProducts = BTreeMap<Components, Rational>;

/// Components in a term, the entire monomial, and its coefficient.
type ComponentTerm = (Components, Monomial, Rational);

impl Collector<'_, '_> {
    /// Replaces sums over components by products of vectors; `None` if there are no such sums.
    pub(super) fn dotted_terms(&self, all: &Polynomial) -> Option<Vec<VectorTerm>> {
        let mut known: Vec<Vector> = Vec::new();
        let mut groups: BTreeMap<(Monomial, Vec<usize>), Vec<ComponentTerm>> = BTreeMap::new();
        for (monomial, &c) in all.terms() {
            let (scalar, components) = self.parted(monomial, &mut known);
            let vectors = components.iter().map(|&(vector, _)| vector).collect();
            groups.entry((scalar, vectors)).or_default().push((components, monomial.clone(), c));
        }
        let (mut terms, mut is_any) = (Vec::new(), false);
        for ((scalar, vectors), members) in groups {
            let products = members.iter().map(|(components, _, c)| (components.clone(), *c)).collect();
            let read = |vectors: &[usize], rows: &Vec<_>| self.product_of(vectors, &rows[0], &known);
            let found = terms_of(&scalar, (&vectors, &vec![products]), &known, &read);
            is_any |= found.is_some();
            let alone = |(_, scalar, coefficient)| VectorTerm { coefficient, scalar, factors: Vec::new() };
            match found {
                Some(found) => terms.extend(found),
                None => terms.extend(members.into_iter().map(alone)),
            }
        }
        is_any.then_some(terms)
    }

    /// Recognizes a·b, a·(b×c), (a·a) (b·b), (a·b)² or (a×b)·(a×b), or a combination of (a·a) (b·b) and (a·b)².
    fn product_of(
        &self,
        vectors: &[usize],
        products: &ComponentProducts,
        known: &[Vector],
    ) -> Option<Products> {
        let n = products.keys().flatten().map(|&(_, place)| place + 1).max()?;
        (n > 1 && vectors.iter().any(|&i| self.has_length(&known[i], n))).then_some(())?;
        let of = |components: &[(usize, usize)]| {
            let mut components = components.to_vec();
            components.sort_unstable();
            products.get(&components).copied().unwrap_or_default()
        };
        let name = |i: usize| known[i].written.clone();
        let meaning = |name: &str, sides: [Formula; 2], of: &[usize]| {
            let variables = of.iter().filter_map(|&i| known[i].of).collect();
            Meaning::Vector(Formula::Call(name.to_owned(), sides.to_vec()), variables)
        };
        let dot = |a, b| meaning("dot", [name(a), name(b)], &[a, b]);
        let cross = |a, b| Formula::Call("cross".to_owned(), vec![name(a), name(b)]);
        let (sum, found) = match *vectors {
            [a, b] => {
                let c = of(&[(a, 0), (b, 0)]);
                let [first, then] = moving_last([a, b], known);
                (scaled(dotted(a, b, n), c)?, vec![(c, vec![dot(first, then)])])
            }
            [a, b, c] if n == 3 && a != b && b != c => {
                let [a, b, c] = moving_last([a, b, c], known);
                let factor = of(&[(a, 0), (b, 1), (c, 2)]);
                let product = meaning("dot", [name(a), cross(b, c)], vectors);
                (scaled(mixed(a, b, c), factor)?, vec![(factor, vec![product])])
            }
            [a, other, b, last] if a == other && b == last && a != b => {
                let squares = of(&[(a, 0), (a, 0), (b, 1), (b, 1)]);
                let mixed = symbolic::times(of(&[(a, 0), (a, 1), (b, 0), (b, 1)]), Rational::new(1, 2))?;
                let [square, both] = [(a, a, b, b), (a, b, a, b)]
                    .map(|(a, b, c, d)| times(&dotted(a, b, n), &dotted(c, d, n)));
                let sum = plus(scaled(square?, squares)?, scaled(both?, mixed)?)?;
                let [first, then] = moving_last([a, b], known);
                let crossed = meaning("dot", [cross(first, then), cross(first, then)], vectors);
                match n == 3 && squares == -mixed {
                    true => (sum, vec![(squares, vec![crossed])]),
                    false => (
                        sum,
                        vec![(squares, vec![dot(a, a), dot(b, b)]), (mixed, vec![dot(a, b), dot(a, b)])],
                    ),
                }
            }
            _ => return None,
        };
        (sum == *products).then_some(found.into_iter().filter(|(c, _)| !c.is_zero()).collect())
    }
}

/// Orders vectors as texts do, with moving ones last: Ω·(r×p), Ω×r, E·r.
fn moving_last<const N: usize>(vectors: [usize; N], known: &[Vector]) -> [usize; N] {
    let mut sorted = vectors;
    sorted.sort_by_key(|&i| match known[i].of {
        Some(Variable::Coordinate(_)) => 1,
        Some(Variable::Velocity(_) | Variable::Momentum(_)) => 2,
        _ => 0,
    });
    sorted
}

fn product(components: &[(usize, usize)]) -> Components {
    let mut components = components.to_vec();
    components.sort_unstable();
    components
}

fn dotted(a: usize, b: usize, n: usize) -> ComponentProducts {
    (0..n).map(|k| (product(&[(a, k), (b, k)]), Rational::from_integer(1))).collect()
}

/// Triple product a·(b×c) by components.
fn mixed(a: usize, b: usize, c: usize) -> ComponentProducts {
    let sign = Rational::from_integer;
    let cyclic = (0..3).flat_map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        [(product(&[(a, k), (b, i), (c, j)]), sign(1)), (product(&[(a, k), (b, j), (c, i)]), sign(-1))]
    });
    cyclic.collect()
}

fn scaled(products: ComponentProducts, by: Rational) -> Option<ComponentProducts> {
    products.into_iter().map(|(components, c)| Some((components, symbolic::times(c, by)?))).collect()
}

fn plus(mut one: ComponentProducts, two: ComponentProducts) -> Option<ComponentProducts> {
    for (components, c) in two {
        let sum = one.entry(components).or_default();
        *sum = symbolic::plus(*sum, c)?;
    }
    one.retain(|_, c| !c.is_zero());
    Some(one)
}

fn times(one: &ComponentProducts, two: &ComponentProducts) -> Option<ComponentProducts> {
    let mut sum = ComponentProducts::new();
    for (components, &c) in one {
        let row = two.iter().map(|(others, &d)| (product(&[&components[..], others].concat()), c * d));
        sum = plus(sum, row.collect())?;
    }
    Some(sum)
}
