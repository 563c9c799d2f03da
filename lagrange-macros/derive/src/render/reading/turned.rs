//! Recognizes vectors multiplied by matrices, such as A c and Aᵀ f with the matrix A of a rotation, in sums of products of
//! components.

use std::collections::BTreeSet;

use num_traits::{One, Zero};
use rustc_hash::FxHashMap;

use super::super::formula::Formula;
use super::atoms::{Atoms, Meaning};
use super::relation::{Relation, reduce};
use crate::symbolic::{Atom, Monomial, Polynomial, Rational};
use crate::variables::Variable;

/// Matrices, the vectors of three that they may multiply, and the products found so far.
#[derive(Default)]
pub(super) struct Tensors {
    matrices: Vec<NamedMatrix>,
    vectors: Vec<NamedVector>,
    /// Matrix, row and column of each entry.
    entries: FxHashMap<Atom, Vec<[usize; 3]>>,
    /// Vector and index of each component.
    components: FxHashMap<Atom, [usize; 2]>,
    products: FxHashMap<TensorProduct, usize>,
}

struct NamedMatrix {
    written: Formula,
    entries: [[Atom; 3]; 3],
    is_rotation: bool,
}

struct NamedVector {
    written: Formula,
    components: [Atom; 3],
    /// True if the components are velocities, accelerations or multipliers.
    is_moving: bool,
    /// The product that the vector is, if it is one.
    product: Option<TensorProduct>,
}

/// TensorProduct of a product of a matrix and a vector.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct TensorProduct {
    matrix: usize,
    is_transposed: bool,
    vector: TurnedVector,
}

/// A vector that a matrix multiplies.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum TurnedVector {
    Vector(usize),
    /// v × w
    Cross(usize, usize),
    /// v × (v × w)
    DoubleCross(usize, usize),
}

/// A sum of products that is known: a component of a product, or an entry of A Aᵀ or AᵀA.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Known {
    Component(TensorProduct, usize),
    Unit { matrix: usize, is_transposed: bool, of: [usize; 2] },
}

impl Tensors {
    pub(super) fn add_matrix(&mut self, written: Formula, entries: [[Atom; 3]; 3], is_rotation: bool) {
        let matrix = self.matrices.len();
        for (i, row) in entries.iter().enumerate() {
            for (j, &entry) in row.iter().enumerate() {
                self.entries.entry(entry).or_default().push([matrix, i, j]);
            }
        }
        self.matrices.push(NamedMatrix { written, entries, is_rotation });
    }

    fn add(&mut self, vector: NamedVector) {
        let number = self.vectors.len();
        self.components.extend(vector.components.into_iter().zip(0..).map(|(atom, k)| (atom, [number, k])));
        self.vectors.push(vector);
    }

    /// Component of a vector as a sum of products.
    fn component(&self, vector: TurnedVector, of: usize) -> Option<Vec<(Monomial, Rational)>> {
        let one = Rational::one();
        let [b, c] = [(of + 1) % 3, (of + 2) % 3];
        let product = |x: Atom, y: Atom, z: Atom| Monomial::product(x, y).times(&Monomial::of(z, one));
        match vector {
            TurnedVector::Vector(v) => Some(vec![(Monomial::of(self.vectors[v].components[of], one), one)]),
            TurnedVector::Cross(v, w) => {
                let [v, w] = [v, w].map(|vector| self.vectors[vector].components);
                Some(vec![(Monomial::product(v[b], w[c]), one), (Monomial::product(v[c], w[b]), -one)])
            }
            // v (v·w) − w (v·v)
            TurnedVector::DoubleCross(v, w) => {
                let [v, w] = [v, w].map(|vector| self.vectors[vector].components);
                let both = |l: usize| {
                    let square = Monomial::of(v[l], one + one);
                    let along = square.times(&Monomial::of(w[of], one))?;
                    Some([(product(v[of], v[l], w[l])?, one), (along, -one)])
                };
                Some([both(b)?, both(c)?].concat())
            }
        }
    }

    fn written(&self, TensorProduct { matrix, is_transposed, vector }: TensorProduct) -> Formula {
        let matrix = self.matrices[matrix].written.clone();
        let matrix = if is_transposed { Formula::Transpose(Box::new(matrix)) } else { matrix };
        let name = |vector: usize| self.vectors[vector].written.clone();
        let cross = |v: Formula, w: Formula| Formula::Call("cross".to_owned(), vec![v, w]);
        let vector = match vector {
            TurnedVector::Vector(v) => match name(v) {
                Formula::Product(factors, _) => factors,
                vector => vec![vector],
            },
            TurnedVector::Cross(v, w) => vec![cross(name(v), name(w))],
            TurnedVector::DoubleCross(v, w) => vec![cross(name(v), cross(name(v), name(w)))],
        };
        Formula::Product([matrix].into_iter().chain(vector).collect(), Vec::new())
    }

    fn is_symmetric(&self, matrix: usize) -> bool {
        let entries = &self.matrices[matrix].entries;
        [[0, 1], [0, 2], [1, 2]].iter().all(|&[i, j]| entries[i][j] == entries[j][i])
    }

    /// Entries of a row, or of a column.
    fn row(&self, matrix: usize, is_transposed: bool, of: usize) -> [Atom; 3] {
        let entries = &self.matrices[matrix].entries;
        if is_transposed { entries.map(|row| row[of]) } else { entries[of] }
    }

    /// Sums that a monomial may be a term of.
    fn known_of(&self, monomial: &Monomial, known: &mut BTreeSet<Known>) {
        let factors = || monomial.factors().iter().filter(|(_, e)| e.is_integer() && *e >= Rational::one());
        let entries = factors().flat_map(|(atom, _)| self.entries.get(atom).into_iter().flatten().copied());
        let components: Vec<[usize; 2]> =
            factors().filter_map(|(atom, _)| self.components.get(atom).copied()).collect();
        let entries: Vec<[usize; 3]> = entries.collect();
        for &[matrix, i, j] in &entries {
            let others =
                entries.iter().filter(|other| other[0] == matrix && self.matrices[matrix].is_rotation);
            for &[_, k, l] in others {
                let is_square = [i, j] == [k, l]
                    && monomial.exponent(self.matrices[matrix].entries[i][j]) > Rational::one();
                if j == l && (i < k || is_square) {
                    known.insert(Known::Unit { matrix, is_transposed: false, of: [i, k] });
                }
                if i == k && (j < l || is_square) {
                    known.insert(Known::Unit { matrix, is_transposed: true, of: [j, l] });
                }
            }
            let ways = [(false, i, j), (true, j, i)];
            let ways = &ways[..if self.is_symmetric(matrix) { 1 } else { 2 }];
            for &(is_transposed, of, along) in ways {
                let operands = self.operands(monomial, &components, along);
                let factors = |vector| TensorProduct { matrix, is_transposed, vector };
                known.extend(operands.into_iter().map(|vector| Known::Component(factors(vector), of)));
            }
        }
    }

    /// Vectors whose component `along` the components in a monomial may belong to.
    fn operands(&self, monomial: &Monomial, components: &[[usize; 2]], along: usize) -> Vec<TurnedVector> {
        let mut operands = Vec::new();
        for &[v, k] in components {
            if k == along {
                operands.push(TurnedVector::Vector(v));
            }
            let is_square = monomial.exponent(self.vectors[v].components[k]) > Rational::one();
            for &[w, l] in components {
                if v != w && self.leads(v, w) && k != along {
                    operands.extend((l == 3 - along - k).then_some(TurnedVector::Cross(v, w)));
                    operands.extend((l == along && is_square).then_some(TurnedVector::DoubleCross(v, w)));
                }
            }
        }
        operands
    }

    /// Order of the factors of a cross product: moving ones lead, as in ω×c.
    fn leads(&self, one: usize, other: usize) -> bool {
        let place = |vector: usize| (!self.vectors[vector].is_moving, vector);
        place(one) < place(other)
    }
}

impl Atoms {
    /// The polynomial with products of matrices and vectors in it, where that leaves fewer terms.
    pub(super) fn turned(&mut self, polynomial: Polynomial) -> Option<Polynomial> {
        let mut read = polynomial;
        while !self.tensors.matrices.is_empty() {
            let (before, mut known) = (read.len(), BTreeSet::new());
            read.terms().for_each(|(monomial, _)| self.tensors.known_of(monomial, &mut known));
            for known in known {
                let relation = self.relation(known)?;
                reduce(&mut read, &relation)?;
            }
            if read.len() == before {
                break;
            }
        }
        Some(read)
    }

    fn relation(&mut self, known: Known) -> Option<Relation> {
        let one = Rational::one();
        match known {
            Known::Component(factors, of) => {
                let row = self.tensors.row(factors.matrix, factors.is_transposed, of);
                let mut parts = Vec::new();
                for (k, &entry) in row.iter().enumerate() {
                    for (monomial, c) in self.tensors.component(factors.vector, k)? {
                        parts.push((monomial.times(&Monomial::of(entry, one))?, c));
                    }
                }
                Some(Relation { parts, sum: self.component_of_product(factors, of)? })
            }
            Known::Unit { matrix, is_transposed, of: [i, j] } => {
                let [a, b] = [i, j].map(|of| self.tensors.row(matrix, is_transposed, of));
                let product = |k: usize| match i == j {
                    true => Monomial::of(a[k], Rational::from_integer(2)),
                    false => Monomial::product(a[k], b[k]),
                };
                let sum = if i == j { one } else { Rational::zero() };
                let parts = [0, 1, 2].map(|k| (product(k), one)).to_vec();
                Some(Relation { parts, sum: vec![(Monomial::default(), sum)] })
            }
        }
    }

    /// Component of matrix · vector: of the inner vector for Aᵀ (A c), else one that is an atom of its own.
    fn component_of_product(
        &mut self,
        factors: TensorProduct,
        of: usize,
    ) -> Option<Vec<(Monomial, Rational)>> {
        let TensorProduct { matrix, is_transposed, vector } = factors;
        let inner = match vector {
            TurnedVector::Vector(v) => self.tensors.vectors[v].product,
            _ => None,
        };
        let inner = inner.filter(|inner| {
            let is_inverse = inner.matrix == matrix && inner.is_transposed != is_transposed;
            is_inverse && self.tensors.matrices[matrix].is_rotation
        });
        if let Some(inner) = inner {
            return self.tensors.component(inner.vector, of);
        }
        let known = self.tensors.products.get(&factors).copied();
        let vector = known.unwrap_or_else(|| self.add_product(factors));
        self.tensors.component(TurnedVector::Vector(vector), of)
    }

    fn add_product(&mut self, factors: TensorProduct) -> usize {
        let tensors = &self.tensors;
        let written = tensors.written(factors);
        let of = match factors.vector {
            TurnedVector::Vector(v) => vec![v],
            TurnedVector::Cross(v, w) | TurnedVector::DoubleCross(v, w) => vec![v, w],
        };
        let of: Vec<[Atom; 3]> = of.into_iter().map(|vector| tensors.vectors[vector].components).collect();
        let components = [0, 1, 2].map(|k| {
            let variables = of.iter().flat_map(|components| self.moving_variables(components[k])).collect();
            let index = Formula::Number(Rational::from_integer(k as i128));
            let entry = Formula::Entry(Box::new(written.clone()), Box::new(index));
            self.atom(Meaning::Vector(entry, variables))
        });
        let is_moving = of.iter().any(|components| !self.moving_variables(components[0]).is_empty());
        let number = self.tensors.vectors.len();
        self.tensors.add(NamedVector { written, components, is_moving, product: Some(factors) });
        self.tensors.products.insert(factors, number);
        number
    }

    /// Velocities, accelerations and multipliers that an atom is, or is a product with.
    fn moving_variables(&self, atom: Atom) -> Vec<Variable> {
        let variables = match self.meaning(atom) {
            Meaning::Variable(variable) => std::slice::from_ref(variable),
            Meaning::Vector(_, variables) => variables,
            _ => &[],
        };
        let moves =
            |variable: &&Variable| !matches!(variable, Variable::Parameter(_) | Variable::Coordinate(_));
        variables.iter().filter(moves).copied().collect()
    }

    pub(super) fn add_vector(&mut self, written: Formula, components: [Atom; 3]) {
        let is_moving = !self.moving_variables(components[0]).is_empty();
        self.tensors.add(NamedVector { written, components, is_moving, product: None });
    }

    /// Writes a vector by this name if it is a product of a matrix and a vector, as n = Aᵀ e.
    pub(super) fn name_product(&mut self, values: [&Polynomial; 3], components: [Atom; 3]) {
        let atom = |value: &Polynomial| match value.single()? {
            (monomial, c) if c.is_one() => match monomial.factors() {
                [(atom, exponent)] if exponent.is_one() => Some(*atom),
                _ => None,
            },
            _ => None,
        };
        let place = |value| self.tensors.components.get(&atom(value)?).copied();
        let [Some([product, 0]), Some([second, 1]), Some([third, 2])] = values.map(place) else { return };
        let Some(factors) = self.tensors.vectors[product].product else { return };
        if let Some(&[name, 0]) = self.tensors.components.get(&components[0])
            && [second, third] == [product; 2]
        {
            self.tensors.vectors[name].product = Some(factors);
            self.tensors.products.insert(factors, name);
        }
    }
}
