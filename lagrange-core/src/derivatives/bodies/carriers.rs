//! Columns of the joints that carry a joint, in blocks of four for vector instructions.

use super::Tree;
use super::spatial::Spatial;
use crate::number::Scalar;

/// Columns in a block.
pub(super) const LANES: usize = 4;

/// S, Ṡ and S̈ of the columns in a block, by components.
type ColumnBlock<T> = [[T; LANES]; 18];

/// Columns of the joints that carry a joint and of itself, from the fixed frame on, in at most `P` blocks.
pub(super) struct Carriers<T, const P: usize, const C: usize> {
    pub(super) blocks: [ColumnBlock<T>; P],
    pub(super) coordinates: [usize; C],
    /// Column in each place; `None` if there is none yet.
    columns: [Option<usize>; C],
}

impl<T: Scalar, const P: usize, const C: usize> Carriers<T, P, C> {
    pub(super) fn new() -> Self {
        Self { blocks: [[[T::constant(0.0); LANES]; 18]; P], coordinates: [0; C], columns: [None; C] }
    }

    /// Replaces the columns of the joints that carry the last joint by those for another one. From joint to joint in depth-first
    /// order, each column is written once.
    pub(super) fn lead_to(&mut self, tree: &Tree, joint: usize, columns: &[[Spatial<T>; 3]; C]) {
        let mut at = Some(joint);
        while let Some(number) = at {
            let joint = &tree.joints[number];
            for (place, column) in (joint.depth..).zip(joint.columns[0]..joint.columns[1]) {
                if self.columns[place] == Some(column) {
                    return;
                }
                self.put(place, column, tree.columns[column].coordinate, &columns[column]);
            }
            at = joint.before;
        }
    }

    fn put(&mut self, place: usize, column: usize, coordinate: usize, entries: &[Spatial<T>; 3]) {
        (self.columns[place], self.coordinates[place]) = (Some(column), coordinate);
        let (block, lane) = (&mut self.blocks[place / LANES], place % LANES);
        for (k, entry) in entries.iter().enumerate() {
            for i in 0..3 {
                block[6 * k + i][lane] = entry.turning[i];
                block[6 * k + 3 + i][lane] = entry.moving[i];
            }
        }
    }
}

/// Factors of S, Ṡ and S̈ of the columns that carry a column, in the derivatives that couple it with them.
pub(super) struct Weights<T> {
    pub(super) momentum: Spatial<T>,
    pub(super) twice: Spatial<T>,
    pub(super) gyroscopic: [T; 3],
    pub(super) by_q: Spatial<T>,
    pub(super) by_v: Spatial<T>,
}

impl<T: Scalar> Weights<T> {
    /// Derivatives of the force along the column by the coordinates and velocities of a block, and of the forces along the
    /// columns of the block by the coordinate and velocity of the column.
    #[inline(always)]
    pub(super) fn entries(&self, block: &ColumnBlock<T>) -> [[T; LANES]; 4] {
        let [s, first, second] = [0, 6, 12];
        let q = self.momentum.along(block, second, [T::constant(0.0); LANES]);
        let v = self.twice.along(block, first, [T::constant(0.0); LANES]);
        [
            along(self.gyroscopic, block, first, q),
            along(self.gyroscopic, block, s, v),
            self.by_q.along(block, s, [T::constant(0.0); LANES]),
            self.by_v.along(block, s, [T::constant(0.0); LANES]),
        ]
    }
}

impl<T: Scalar> Spatial<T> {
    #[inline(always)]
    fn along(self, block: &ColumnBlock<T>, first: usize, sum: [T; LANES]) -> [T; LANES] {
        along(self.moving, block, first + 3, along(self.turning, block, first, sum))
    }
}

/// Adds the products of a vector with the components of a block from `first` on.
#[inline(always)]
fn along<T: Scalar>(
    weights: [T; 3],
    block: &ColumnBlock<T>,
    first: usize,
    mut sum: [T; LANES],
) -> [T; LANES] {
    for (weight, lanes) in weights.into_iter().zip(&block[first..first + 3]) {
        for lane in 0..LANES {
            sum[lane] = weight.multiply_add(lanes[lane], sum[lane]);
        }
    }
    sum
}
