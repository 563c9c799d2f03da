//! Constraints of a system of any number of bodies at a state, row by row.

use alloc::vec::Vec;

use crate::number::Scalar;

/// Constraints of [`ManyBodies`](crate::ManyBodies) at a state: for each a row F of coefficients of the velocities, and how far the state is
/// off it. Rows are stated in the order of the names of the constraints.
#[derive(Debug)]
pub struct ConstraintRows<T> {
    pub(super) pattern: Pattern,
    pub(super) rows: Vec<StatedRow<T>>,
    pub(super) slopes: Vec<T>,
}

/// Which coordinates the rows contain.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Pattern {
    /// First slope of each row.
    pub(super) starts: Vec<usize>,
    /// First coordinate of the element of each slope.
    pub(super) element_starts: Vec<usize>,
    /// Coordinates that share entries of the mass matrix with that of a slope, itself included.
    pub(super) elements: Vec<usize>,
    /// Place of the slope's own coordinate in its element.
    pub(super) own: Vec<usize>,
}

/// A constraint without its coefficients.
#[derive(Clone, Copy, Debug)]
pub(super) struct StatedRow<T> {
    /// Φ, if the constraint is holonomic.
    pub(super) residual: Option<T>,
    /// F q̇ + b
    pub(super) rate: T,
    /// γ: the rate of change of F q̇ + b at q̈ = 0.
    pub(super) bias: T,
}

impl<T> Default for ConstraintRows<T> {
    fn default() -> Self {
        Self { pattern: Pattern::default(), rows: Vec::new(), slopes: Vec::new() }
    }
}

impl<T: Scalar> ConstraintRows<T> {
    /// Begins a row: Φ of a holonomic constraint, and for each constraint F q̇ + b and its rate of change at q̈ = 0.
    pub fn row(&mut self, residual: Option<T>, rate: T, bias: T) {
        self.pattern.starts.push(self.slopes.len());
        self.rows.push(StatedRow { residual, rate, bias });
    }

    /// Adds a coefficient to the row that was begun last: `slope` of the velocity of coordinate `element[own]`. The other coordinates of
    /// `element` are those that share entries of the mass matrix with it, in the same order whenever one of them has a coefficient.
    pub fn entry<const K: usize>(&mut self, element: [usize; K], own: usize, slope: T) {
        self.pattern.element_starts.push(self.pattern.elements.len());
        self.pattern.elements.extend(element);
        self.pattern.own.push(own);
        self.slopes.push(slope);
    }

    /// Indices of the rows.
    pub(super) fn indices(&self) -> core::ops::Range<usize> {
        0..self.rows.len()
    }

    /// Σ F x of a row.
    pub(super) fn along(&self, row: usize, x: &[T]) -> T {
        let terms =
            self.pattern.slopes(row).map(|slope| self.slopes[slope] * x[self.pattern.coordinate(slope)]);
        terms.fold(T::constant(0.0), |sum, term| sum + term)
    }

    pub(super) fn clear(&mut self) {
        let Pattern { starts, element_starts, elements, own } = &mut self.pattern;
        [starts, element_starts, elements, own].into_iter().for_each(Vec::clear);
        self.rows.clear();
        self.slopes.clear();
    }
}

impl Pattern {
    /// Indices of the slopes of a row.
    pub(super) fn slopes(&self, row: usize) -> core::ops::Range<usize> {
        self.starts[row]..self.starts.get(row + 1).copied().unwrap_or(self.own.len())
    }

    /// Element of a slope.
    pub(super) fn element(&self, slope: usize) -> &[usize] {
        let end = self.element_starts.get(slope + 1).copied().unwrap_or(self.elements.len());
        &self.elements[self.element_starts[slope]..end]
    }

    /// Coordinate of a slope.
    pub(super) fn coordinate(&self, slope: usize) -> usize {
        self.element(slope)[self.own[slope]]
    }
}
