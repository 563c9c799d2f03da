//! The span of rows of bodies that touch: which of them depend on others, and what they leave of a vector.

use alloc::vec;
use alloc::vec::Vec;

use super::Contacts;
use super::rows::TouchingRows;
use crate::number::Real;
use crate::number::limits::ACCUMULATED;
use crate::numerics::bare::{dot, sqrt};

/// The span of the rows of constraints and of others, by an orthonormal basis.
pub(super) struct RowSpan<'a, L> {
    rows: &'a TouchingRows<L>,
    basis: Vec<Vec<f64>>,
    /// The least change of x with the changes of rates that were asked for.
    pub(super) change: Vec<f64>,
}

impl<'a, L: Contacts<Scalar: Real>> RowSpan<'a, L> {
    pub(super) fn of(rows: &'a TouchingRows<L>, places: impl IntoIterator<Item = usize>) -> Self {
        let mut span = Self { rows, basis: Vec::new(), change: vec![0.0; rows.n] };
        (rows.count..rows.all.len()).chain(places).for_each(|place| {
            span.add(place);
        });
        span
    }

    /// What the span leaves of a vector.
    pub(super) fn rest(&self, mut x: Vec<f64>) -> Vec<f64> {
        // Twice, since the first time leaves round-off of the whole.
        for _ in 0..2 {
            for of in &self.basis {
                let along = dot(of, &x);
                x.iter_mut().zip(of).for_each(|(x, y)| *x -= along * y);
            }
        }
        x
    }

    /// Adds a row, if it does not depend on the others, and changes its rate by this, but not those of the others.
    pub(super) fn add_change(&mut self, place: usize, by: f64) {
        self.add_change_within(place, by, f64::INFINITY);
    }

    /// The same, if it changes x by no more than this.
    pub(super) fn add_change_within(&mut self, place: usize, by: f64, most: f64) {
        if !self.add(place) {
            return;
        }
        let (row, Some(along)) = (self.rows.row(place), self.basis.last()) else { return };
        let rest = by - dot(row, &self.change);
        let factor = rest / dot(row, along);
        if factor.abs() <= most {
            self.change.iter_mut().zip(along).for_each(|(x, y)| *x += factor * y);
        } else {
            self.basis.pop();
        }
    }

    /// What the change does to the rate of a row.
    pub(super) fn rate(&self, place: usize) -> f64 {
        dot(self.rows.row(place), &self.change)
    }

    /// Number of independent rows.
    pub(super) fn size(&self) -> usize {
        self.basis.len()
    }

    /// Takes out the rows beyond this number.
    pub(super) fn truncate(&mut self, size: usize) {
        self.basis.truncate(size);
    }

    /// Whether a row depends on those of the span: the elimination of a leg works with the square of what they leave of it, and has no digits
    /// of less.
    pub(super) fn depends(&self, place: usize) -> bool {
        let (row, rest) = (self.rows.row(place), self.rest(self.rows.row(place).to_vec()));
        dot(&rest, &rest) <= ACCUMULATED * L::Scalar::EPSILON * dot(row, row)
    }

    /// Adds a row, if it does not depend on the others. Returns whether it does not.
    pub(super) fn add(&mut self, place: usize) -> bool {
        if self.depends(place) {
            return false;
        }
        let rest = self.rest(self.rows.row(place).to_vec());
        let size = sqrt(dot(&rest, &rest));
        self.basis.push(rest.into_iter().map(|x| x / size).collect());
        true
    }
}
