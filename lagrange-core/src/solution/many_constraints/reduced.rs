//! The equations for the multipliers, (F M⁻¹ Fᵀ) λ = r.
//!
//! M couples the coordinates of one element alone, so that M⁻¹ of all elements comes from as many divisions by M as an element has
//! coordinates: each of vectors with a one in every element. Which entries F M⁻¹ Fᵀ has follows from the coordinates in the rows; as long
//! as these are the same, only values change.

use alloc::collections::BTreeSet;
use alloc::vec::Vec;

use super::Correction;
use super::rows::{ConstraintRows, Pattern};
use crate::number::{Real, Scalar};
use crate::numerics::sparse::SparseLdl;
use crate::system::ManyBodies;

/// Equations for the multipliers at a state, and memory for the next ones.
pub(super) struct Reduced<T> {
    pub(super) stated: ConstraintRows<T>,
    layout: Layout,
    ldl: SparseLdl<T>,
    /// M⁻¹, as results of the divisions one behind the other.
    inverse: Vec<T>,
    /// Values of M⁻¹ Fᵀ.
    moved: Vec<T>,
}

/// Where each value comes from and goes to, for rows of one pattern.
#[derive(Default)]
struct Layout {
    pattern: Pattern,
    coordinates: usize,
    /// Coordinates with a one in each division by M.
    ones: Vec<Vec<usize>>,
    /// First entry of M⁻¹ Fᵀ of each row, and the number of all.
    starts: Vec<usize>,
    moved: Vec<Moved>,
    /// Products of a slope and an entry of M⁻¹ Fᵀ, in the order of the values of F M⁻¹ Fᵀ; first product of each value.
    products: Vec<(usize, usize)>,
    product_starts: Vec<usize>,
    /// The diagonal among these values.
    diagonal: Vec<usize>,
}

/// An entry of M⁻¹ Fᵀ: a slope times an entry of M⁻¹.
struct Moved {
    coordinate: usize,
    slope: usize,
    inverse: usize,
}

impl<T: Scalar> Default for Reduced<T> {
    fn default() -> Self {
        Self {
            stated: ConstraintRows::default(),
            layout: Layout::default(),
            ldl: SparseLdl::of(Vec::new()),
            inverse: Vec::new(),
            moved: Vec::new(),
        }
    }
}

impl<T: Scalar> Reduced<T> {
    /// Evaluates the rows at a state.
    pub(super) fn evaluate<L: ManyBodies<Scalar = T>>(&mut self, system: &L, (t, q, v): (T, &[T], &[T])) {
        self.stated.clear();
        system.constraints(t, q, v, &mut self.stated);
        if self.stated.pattern != self.layout.pattern || q.len() != self.layout.coordinates {
            self.ldl = self.layout.renew(&self.stated.pattern, q.len());
        }
    }

    /// Factorizes F M⁻¹ Fᵀ of the constraints that concern `target`. Returns the smallest ratio of a pivot to its
    /// diagonal entry.
    pub(super) fn factor<L: ManyBodies<Scalar = T>>(
        &mut self,
        system: &L,
        at: (T, &[T], &[T]),
        target: Correction,
    ) -> T {
        self.evaluate(system, at);
        self.invert(system, at);
        for (row, _) in self.stated.rows.iter().enumerate().filter(|(_, stated)| !target.concerns(stated)) {
            self.stated.slopes[self.layout.pattern.slopes(row)].fill(T::constant(0.0));
        }
        let slopes = &self.stated.slopes;
        self.moved.clear();
        self.moved.extend(self.layout.moved.iter().map(|at| slopes[at.slope] * self.inverse[at.inverse]));
        for (value, ends) in self.ldl.values().iter_mut().zip(self.layout.product_starts.windows(2)) {
            let products = self.layout.products[ends[0]..ends[1]].iter();
            *value = products
                .fold(T::constant(0.0), |sum, &(slope, moved)| sum + slopes[slope] * self.moved[moved]);
        }
        // A constraint that is left out has a row of its own, and a multiplier of zero.
        for (_, &value) in
            self.stated.rows.iter().zip(&self.layout.diagonal).filter(|(stated, _)| !target.concerns(stated))
        {
            self.ldl.values()[value] = T::constant(1.0);
        }
        self.ldl.factor()
    }

    /// Entries of M⁻¹.
    fn invert<L: ManyBodies<Scalar = T>>(&mut self, system: &L, (t, q, v): (T, &[T], &[T])) {
        let count = q.len();
        self.inverse.clear();
        self.inverse.resize(count * self.layout.ones.len(), T::constant(0.0));
        for (ones, x) in self.layout.ones.iter().zip(self.inverse.chunks_exact_mut(count.max(1))) {
            ones.iter().for_each(|&one| x[one] = T::constant(1.0));
            system.divide_by_masses(t, q, v, x);
        }
    }

    /// Corrects `x` by M⁻¹ Fᵀ λ, and writes the multipliers.
    pub(super) fn solve(&mut self, target: Correction, (x, multipliers): (&mut [T], &mut Vec<T>)) {
        multipliers.clear();
        let rows = self.stated.rows.iter().enumerate();
        multipliers.extend(rows.map(|(at, row)| target.right(row, || self.stated.along(at, x))));
        self.ldl.solve(multipliers);
        for (entries, &multiplier) in self.layout.starts.windows(2).zip(&*multipliers) {
            for entry in entries[0]..entries[1] {
                let coordinate = self.layout.moved[entry].coordinate;
                x[coordinate] = x[coordinate] + self.moved[entry] * multiplier;
            }
        }
    }

    /// Coordinate whose inverse mass is not finite.
    pub(super) fn massless(&self) -> Option<usize>
    where
        T: Real,
    {
        let at = self.inverse.iter().position(|inverse| !inverse.is_finite())?;
        Some(at % self.layout.coordinates)
    }

    /// Row that depends on others.
    pub(super) fn dependent(&self, is_trusted: impl Fn(T) -> bool) -> Option<usize> {
        self.ldl.dependent(is_trusted)
    }
}

impl Layout {
    /// Finds the layout of the values for a pattern of rows.
    fn renew<T: Scalar>(&mut self, pattern: &Pattern, coordinates: usize) -> SparseLdl<T> {
        *self = Self { pattern: pattern.clone(), coordinates, starts: alloc::vec![0], ..Self::default() };
        let rows = pattern.starts.len();
        // Slopes, and entries of M⁻¹ Fᵀ, at each coordinate, with their rows.
        let mut slopes = alloc::vec![Vec::new(); coordinates];
        let mut moved = slopes.clone();
        for row in 0..rows {
            for slope in pattern.slopes(row) {
                slopes[pattern.coordinate(slope)].push((row, slope));
                for (place, &coordinate) in pattern.element(slope).iter().enumerate() {
                    moved[coordinate].push((row, self.moved.len()));
                    let inverse = pattern.own[slope] * coordinates + coordinate;
                    self.moved.push(Moved { coordinate, slope, inverse });
                    self.add_one(place, coordinate);
                }
            }
            self.starts.push(self.moved.len());
        }
        let meetings = || {
            slopes.iter().zip(&moved).flat_map(|(slopes, moved)| {
                slopes.iter().flat_map(move |&one| moved.iter().map(move |&other| (one, other)))
            })
        };
        let mut neighbours = alloc::vec![BTreeSet::new(); rows];
        for ((row, _), (other, _)) in meetings().filter(|((row, _), (other, _))| row != other) {
            neighbours[row].insert(other);
            neighbours[other].insert(row);
        }
        let mut ldl = SparseLdl::of(neighbours);
        let mut products: Vec<(usize, (usize, usize))> = meetings()
            .filter(|((row, _), (other, _))| row >= other)
            .filter_map(|((row, slope), (other, entry))| Some((ldl.entry(row, other)?, (slope, entry))))
            .collect();
        products.sort_unstable();
        self.diagonal = (0..rows).filter_map(|row| ldl.entry(row, row)).collect();
        self.product_starts = (0..=ldl.values().len())
            .map(|value| products.partition_point(|(known, _)| *known < value))
            .collect();
        self.products = products.into_iter().map(|(_, product)| product).collect();
        ldl
    }

    fn add_one(&mut self, place: usize, coordinate: usize) {
        if self.ones.len() <= place {
            self.ones.resize(place + 1, Vec::new());
        }
        self.ones[place].push(coordinate);
    }
}
