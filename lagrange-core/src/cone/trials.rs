//! Trials of all faces: whether the law has no solution, one or several, where few blocks make that a finite question. Friction that slides
//! may press bodies together, so that forces need not exist, nor be the only ones (Painlevé, *Comptes rendus* 121, 1895).

use alloc::vec;
use alloc::vec::Vec;

use super::{ConeSolver, Face, RowBlock, Set};
use crate::number::limits::HALF_THE_DIGITS;

/// Directions that friction along two velocities is tried in to begin with.
const DIRECTIONS: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];

impl ConeSolver {
    /// All solutions on faces of which there are at most so many combinations, `None` if there are more. A solution that is not
    /// isolated, as the shares of four legs, counts once. None are missed but those whose reactions cannot be told from round-off, and some
    /// of friction along two velocities.
    pub(crate) fn solutions(&mut self, most: usize) -> Option<Vec<Vec<f64>>> {
        let choices: Vec<Vec<Face>> = (0..self.blocks.len()).map(|k| self.choices(k)).collect();
        let combinations = choices.iter().try_fold(1_usize, |all, of| all.checked_mul(of.len()));
        let mut found: Vec<Vec<f64>> = vec![];
        for number in 0..combinations.filter(|&count| count <= most)? {
            let mut rest = number;
            let choose = |of: &Vec<Face>| {
                let face = of[rest % of.len()];
                rest /= of.len();
                face
            };
            let faces: Vec<Face> = choices.iter().map(choose).collect();
            // Friction of an open gap has one face.
            let used = self.without_idle(&faces);
            if (0..faces.len()).any(|k| used[k] == Face::Open && matches!(faces[k], Face::Slide(_))) {
                continue;
            }
            self.r.fill(0.0);
            self.refresh();
            if self.obeys_on(&faces, false) {
                let size = self.r.iter().fold(0.0, |most, r| f64::max(most, r.abs()));
                let is_near = |(one, other): (&f64, &f64)| (one - other).abs() <= HALF_THE_DIGITS * size;
                if !found.iter().any(|known| known.iter().zip(&self.r).all(is_near)) {
                    found.push(self.r.clone());
                }
            }
        }
        let unscaled = |r: Vec<f64>| r.iter().zip(&self.scale).map(|(r, scale)| r / scale).collect();
        Some(found.into_iter().map(unscaled).collect())
    }

    fn choices(&self, k: usize) -> Vec<Face> {
        let RowBlock { count, set, .. } = self.blocks[k];
        match set {
            Set::Line | Set::Ray { .. } => vec![Face::Stick],
            Set::HalfLine => vec![Face::Stick, Face::Open],
            Set::Disc(_) => {
                let directions = DIRECTIONS.iter().filter(|[_, y]| *y == 0.0 || count == 2);
                core::iter::once(Face::Stick).chain(directions.map(|d| Face::Slide(*d))).collect()
            }
        }
    }
}
