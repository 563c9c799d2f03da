//! Recognizes rows that are the components of one vector equation.

use std::collections::BTreeMap;

use num_traits::{One, Signed};

use super::super::formula::Formula;
use super::arms::joined;
use super::atoms::Meaning;
use super::collect::Collector;
use crate::resolve::Problem;
use crate::symbolic::{Atom, Monomial, Polynomial, Rational};
use crate::variables::Variable;

/// A vector as written, the variable of its first component, and the components that were met.
pub(super) struct Vector {
    pub(super) written: Formula,
    pub(super) of: Option<Variable>,
    atoms: BTreeMap<usize, Atom>,
}

/// Product of vector components, sorted: index of each vector, and index of its component.
pub(super) type Components = Vec<(usize, usize)>;

/// Products of components in every row, keyed by their scalar factor and the set of vectors multiplied.
type Groups = BTreeMap<(Monomial, Vec<usize>), Rows>;

/// Products of components in each row.
type Rows = Vec<BTreeMap<Components, Rational>>;

/// Products of vectors with their coefficients.
pub(super) type Products = Vec<(Rational, Vec<Meaning>)>;

/// Term of a vector equation: coefficient, scalar factors, and vector factors.
#[derive(Clone)]
pub(super) struct VectorTerm {
    pub(super) coefficient: Rational,
    pub(super) scalar: Monomial,
    pub(super) factors: Vec<Meaning>,
}

impl Collector<'_, '_> {
    /// Vector equation of these rows; `None` if scalars, dot products and cross products of vectors do not produce
    /// them. The factors of a cross product stand in the order in which its coefficient has this sign, or is positive if
    /// there are accelerations in it.
    pub(super) fn vector_terms(&self, rows: &[Polynomial], sign: Rational) -> Option<Vec<VectorTerm>> {
        let mut known: Vec<Vector> = Vec::new();
        let mut groups = Groups::new();
        for (row, polynomial) in rows.iter().enumerate() {
            for (monomial, &c) in polynomial.terms() {
                let (scalar, components) = self.parted(monomial, &mut known);
                let vectors = components.iter().map(|&(vector, _)| vector).collect();
                let group =
                    groups.entry((scalar, vectors)).or_insert_with(|| vec![BTreeMap::new(); rows.len()]);
                group[row].insert(components, c);
            }
        }
        let is_multiplier = |vector: &Vector| matches!(vector.written, Formula::Multiplier(_));
        if rows.len() != 3 && known.iter().any(is_multiplier) {
            return None;
        }
        let terms = groups.into_iter().map(|((scalar, vectors), products)| {
            let read = |vectors: &[usize], rows: &Rows| in_vectors(vectors, rows, &known, sign);
            terms_of(&scalar, (&vectors, &products), &known, &read)
        });
        Some(joined(terms.collect::<Option<Vec<_>>>()?.concat()))
    }

    /// Splits a monomial into its scalar factors and the components of vectors.
    pub(super) fn parted(&self, monomial: &Monomial, known: &mut Vec<Vector>) -> (Monomial, Components) {
        let mut components = Components::new();
        let mut found = Vec::new();
        for &(atom, exponent) in monomial.factors() {
            let is_product = exponent.is_integer() && exponent >= Rational::one();
            let Some((vector, place)) = self.component(atom).filter(|_| is_product) else { continue };
            let is_it = |known: &Vector| known.written == vector.written && known.of == vector.of;
            let index = known.iter().position(is_it).unwrap_or(known.len());
            if index == known.len() {
                known.push(vector);
            }
            known[index].atoms.insert(place, atom);
            found.push(atom);
            components.extend((0..exponent.to_integer()).map(|_| (index, place)));
        }
        components.sort_unstable();
        (monomial.filtered(|atom| !found.contains(&atom)), components)
    }

    /// True for an element of an array of scalars, which is no component of a vector.
    fn is_element(&self, atom: Atom, formula: &Formula) -> bool {
        let Problem { many, parameters, .. } = self.page.problem;
        match self.variable(atom) {
            Some(
                Variable::Coordinate(k)
                | Variable::Velocity(k)
                | Variable::Acceleration(k)
                | Variable::Momentum(k),
            ) => many.slots.get_index(k).is_some_and(|slot| many.arrays[slot.array].lengths.is_empty()),
            _ => match formula {
                Formula::Name { base, indices, .. } => many.is_element(base, indices.len(), parameters),
                _ => false,
            },
        }
    }

    /// Vector that an atom is a component of, and index of the component.
    fn component(&self, atom: Atom) -> Option<(Vector, usize)> {
        let formula = self.atom(atom);
        if self.is_element(atom, &formula) {
            return None;
        }
        let (written, place) = component(&formula)?;
        if let Formula::Multiplier(constraint) = &written {
            self.is_of_space(constraint).then_some(())?;
        }
        let of = self.variable(atom).map(|variable| first(variable, place));
        Some((Vector { written, of, atoms: BTreeMap::new() }, place))
    }

    /// Returns whether a constraint has three components.
    fn is_of_space(&self, constraint: &str) -> bool {
        let labels = &self.page.problem.constraints;
        let has = |k: usize| labels.iter().any(|(label, _)| label.text == format!("{constraint}[{k}]"));
        has(0) && has(1) && has(2) && !has(3)
    }

    /// Norm |a|, |a − b| or |a + b − c| whose square this sum of squared components is, if there is one.
    pub(super) fn squared_norm(&self, sum: &Polynomial) -> Option<Formula> {
        let mut known: Vec<Vector> = Vec::new();
        let mut products: BTreeMap<Components, Rational> = BTreeMap::new();
        for (monomial, &c) in sum.terms() {
            let (scalar, components) = self.parted(monomial, &mut known);
            (scalar.is_one() && components.len() == 2).then_some(())?;
            products.insert(components, c);
        }
        let n = products.keys().flatten().map(|&(_, place)| place + 1).max()?;
        let is_it = known.iter().any(|vector| self.has_length(vector, n));
        (n > 1 && is_it).then_some(())?;
        let is_turned = |i: usize| products.get(&vec![(0, 0), (i, 0)]).is_some_and(Signed::is_negative);
        let signs: Vec<Rational> =
            (0..known.len()).map(|i| if is_turned(i) { -Rational::one() } else { Rational::one() }).collect();
        let (signs, count) = (&signs, known.len());
        let expected = (0..n).flat_map(|k| {
            let pairs = (0..count).flat_map(move |i| (i..count).map(move |j| (i, j)));
            pairs.map(move |(i, j)| {
                let twice = if i == j { Rational::one() } else { Rational::from_integer(2) };
                (vec![(i, k), (j, k)], twice * signs[i] * signs[j])
            })
        });
        let difference =
            known.iter().enumerate().map(|(i, vector)| vector.written.clone().signed(is_turned(i)));
        let norm = Formula::Call("norm".to_owned(), vec![Formula::sum(difference.collect())]);
        (expected.collect::<BTreeMap<_, _>>() == products).then_some(norm)
    }

    /// Returns whether a vector is known to have `n` components.
    pub(super) fn has_length(&self, vector: &Vector, n: usize) -> bool {
        match (vector.of, &vector.written) {
            (Some(Variable::Coordinate(i) | Variable::Velocity(i) | Variable::Momentum(i)), _) => {
                self.length_from(i) == n
            }
            (None, Formula::Name { .. }) => {
                self.page.vectors.iter().any(|(known, length)| *length == n && *known == vector.written)
            }
            // A matrix times a vector.
            (None, Formula::Product(..)) => n == 3,
            (None, Formula::Call(name, _)) => {
                let functions = &self.page.problem.functions;
                functions.iter().any(|function| function.name == *name && function.outputs == n)
            }
            _ => false,
        }
    }

    /// Number of components of the vector of coordinates that begins at `first`.
    fn length_from(&self, first: usize) -> usize {
        // Angular velocities stand beyond the coordinates.
        let Some(labels) = self.page.problem.coordinates.get(first..).filter(|labels| !labels.is_empty())
        else {
            return 3;
        };
        let Some((base, _)) = labels[0].text.rsplit_once('[') else { return 1 };
        labels
            .iter()
            .take_while(|label| label.text.rsplit_once('[').is_some_and(|(other, _)| other == base))
            .count()
    }
}

/// Products of vectors that a group of terms is made of, as `read` finds them. Where it finds none, components of an array of
/// parameters may be scalars, such as the masses m₀ and m₁.
pub(super) fn terms_of(
    scalar: &Monomial,
    (vectors, rows): (&[usize], &Rows),
    known: &[Vector],
    read: &dyn Fn(&[usize], &Rows) -> Option<Products>,
) -> Option<Vec<VectorTerm>> {
    if let Some(found) = read(vectors, rows) {
        let term = |(coefficient, factors)| VectorTerm { coefficient, scalar: scalar.clone(), factors };
        return Some(found.into_iter().map(term).collect());
    }
    let mut arrays = vectors.to_vec();
    arrays.dedup();
    arrays.retain(|&vector| matches!(known[vector].of, Some(Variable::Parameter(_))));
    arrays.into_iter().find_map(|array| {
        let others: Vec<usize> = vectors.iter().copied().filter(|&vector| vector != array).collect();
        let parts = apart(rows, array).into_iter().map(|(components, rows)| {
            let mut factors = components.iter().map(|(_, place)| known[array].atoms[place]);
            let scalar = factors.try_fold(scalar.clone(), |scalar, atom| {
                scalar.times(&Monomial::of(atom, Rational::one()))
            })?;
            terms_of(&scalar, (&others, &rows), known, read)
        });
        Some(parts.collect::<Option<Vec<_>>>()?.concat())
    })
}

/// Rows by the components of one vector in them.
fn apart(rows: &Rows, vector: usize) -> BTreeMap<Components, Rows> {
    let mut parts: BTreeMap<Components, Rows> = BTreeMap::new();
    for (row, products) in rows.iter().enumerate() {
        for (components, &c) in products {
            let (own, others) = components.iter().copied().partition(|&(of, _)| of == vector);
            parts.entry(own).or_insert_with(|| vec![BTreeMap::new(); rows.len()])[row].insert(others, c);
        }
    }
    parts
}

/// Vector that a formula is a component of, and index of the component.
fn component(formula: &Formula) -> Option<(Formula, usize)> {
    match formula {
        Formula::Name { base, dots, indices } => {
            let (last, others) = indices.split_last()?;
            let Formula::Number(place) = last else { return None };
            let whole = Formula::Name { base: base.clone(), dots: *dots, indices: others.to_vec() };
            Some((whole, usize::try_from(place.to_integer()).ok()?))
        }
        Formula::Entry(whole, index) => {
            let Formula::Number(place) = **index else { return None };
            Some(((**whole).clone(), usize::try_from(place.to_integer()).ok()?))
        }
        Formula::Multiplier(constraint) => {
            let (constraint, place) = constraint.strip_suffix(']')?.rsplit_once('[')?;
            Some((Formula::Multiplier(constraint.to_owned()), place.parse().ok()?))
        }
        Formula::Member(of, member) => {
            let (member, place) = component(member)?;
            Some((Formula::Member(of.clone(), Box::new(member)), place))
        }
        Formula::Call(name, arguments) => {
            let (name, place) = name.strip_suffix(']')?.rsplit_once('[')?;
            Some((Formula::Call(name.to_owned(), arguments.clone()), place.parse().ok()?))
        }
        Formula::Derivative { function, order, argument } => {
            let (function, place) = component(function)?;
            let (function, argument) = (Box::new(function), argument.clone());
            Some((Formula::Derivative { function, order: *order, argument }, place))
        }
        Formula::Partial { function, by, arguments } => {
            let [by] = &by[..] else { return None };
            let (by, place) = component(by)?;
            let (function, arguments) = (function.clone(), arguments.clone());
            Some((Formula::Partial { function, by: vec![by], arguments }, place))
        }
        _ => None,
    }
}

/// Variable of a vector's first component, from that of another component.
fn first(variable: Variable, place: usize) -> Variable {
    match variable {
        Variable::Coordinate(i) => Variable::Coordinate(i - place),
        Variable::Velocity(i) => Variable::Velocity(i - place),
        Variable::Acceleration(i) => Variable::Acceleration(i - place),
        Variable::Momentum(i) => Variable::Momentum(i - place),
        Variable::Multiplier(i) => Variable::Multiplier(i - place),
        // For parameters, only the kind of the variable matters.
        Variable::Parameter(_) => Variable::Parameter(0),
        other => other,
    }
}

/// Writes products of components, given row by row, as terms with a coefficient, a vector, and dot products that scale
/// it.
fn in_vectors(
    vectors: &[usize],
    rows: &[BTreeMap<Components, Rational>],
    known: &[Vector],
    sign: Rational,
) -> Option<Products> {
    let whole = |i: usize| Meaning::Vector(known[i].written.clone(), known[i].of.into_iter().collect());
    // A product is counted among the accelerations, but not among the velocities, that it contains.
    let accelerations = vectors.iter().filter_map(|&i| known[i].of);
    let accelerations =
        accelerations.filter(|of| matches!(of, Variable::Acceleration(_))).collect::<Vec<_>>();
    let call = |name: &str, i: Formula, j: Formula| {
        Meaning::Vector(Formula::Call(name.to_owned(), vec![i, j]), accelerations.clone())
    };
    let name = |i: usize| known[i].written.clone();
    let at = |row: usize, components: &[(usize, usize)]| {
        let mut components = components.to_vec();
        components.sort_unstable();
        rows[row].get(&components).copied().unwrap_or_default()
    };
    let candidates: Vec<(Rational, Vec<Meaning>, Product)> = match *vectors {
        [v] => vec![(at(0, &[(v, 0)]), vec![whole(v)], Product::Along(v, vec![]))],
        [v, w] if rows.len() == 3 => {
            let sign = if accelerations.is_empty() { sign } else { Rational::one() };
            let coefficient = at(0, &[(v, 1), (w, 2)]);
            let (v, w, c) = if coefficient * sign < Rational::default() {
                (w, v, -coefficient)
            } else {
                (v, w, coefficient)
            };
            vec![(c, vec![call("cross", name(v), name(w))], Product::Across(v, w))]
        }
        [u, v, w] if rows.len() > 1 => {
            let mut ways = vec![(u, v, w), (v, u, w), (w, u, v)];
            ways.dedup_by_key(|way| way.0);
            let along = ways.into_iter().map(|(a, b, c)| {
                let coefficient = at(0, &[(a, 0), (b, 1), (c, 1)]);
                (coefficient, vec![whole(a), call("dot", name(b), name(c))], Product::Along(a, vec![b, c]))
            });
            along.collect()
        }
        _ => return None,
    };
    let mut rest = rows.to_vec();
    for (coefficient, _, product) in &candidates {
        product.subtract(*coefficient, &mut rest);
    }
    rest.iter().all(|row| row.values().all(|c| *c == Rational::default())).then_some(())?;
    // a (a·b) − b (a·a) = a×(a×b)
    if let [(one, _, Product::Along(a, _)), (two, _, Product::Along(b, _))] = &candidates[..]
        && rows.len() == 3
        && *one == -*two
    {
        let (a, b, c) =
            if vectors.iter().filter(|&v| v == a).count() == 2 { (*a, *b, *one) } else { (*b, *a, *two) };
        let inner = Formula::Call("cross".to_owned(), vec![name(a), name(b)]);
        return Some(vec![(c, vec![call("cross", name(a), inner)])]);
    }
    Some(candidates.into_iter().map(|(c, factors, _)| (c, factors)).collect())
}

/// A product of vectors whose value is a vector.
enum Product {
    /// a, or a (b·c)
    Along(usize, Vec<usize>),
    /// a×b
    Across(usize, usize),
}

impl Product {
    /// Subtracts a multiple of this product from the products of components.
    fn subtract(&self, coefficient: Rational, rows: &mut [BTreeMap<Components, Rational>]) {
        let n = rows.len();
        for (k, row) in rows.iter_mut().enumerate() {
            let mut take = |mut components: Components, c: Rational| {
                components.sort_unstable();
                *row.entry(components).or_default() -= c;
            };
            match self {
                Self::Along(a, dotted) if dotted.is_empty() => take(vec![(*a, k)], coefficient),
                Self::Along(a, dotted) => (0..n).for_each(|j| {
                    let dotted = dotted.iter().map(|&vector| (vector, j));
                    take([(*a, k)].into_iter().chain(dotted).collect(), coefficient);
                }),
                Self::Across(a, b) => {
                    take(vec![(*a, (k + 1) % n), (*b, (k + 2) % n)], coefficient);
                    take(vec![(*a, (k + 2) % n), (*b, (k + 1) % n)], -coefficient);
                }
            }
        }
    }
}
