//! Complementarity problems of a few contacts with friction, solved by trials: each contact opens, sticks or slides.

use alloc::vec;
use alloc::vec::Vec;

use super::lemke::{Exchange, Exchanged};
use super::newton::eliminate;
use crate::number::{Real, Scalar, larger};

/// Largest number of contacts for which everything that they may do is tried.
pub(super) const TRIED: usize = 4;

/// Largest number of trials. Each contact may do five things: it opens; it sticks, with a force of friction forwards or backwards; or it
/// slides forwards or backwards.
const CHOICES: usize = 5_usize.pow(TRIED as u32);

/// Number of times that the linear equations of a trial are solved: once, and once more for what round-off leaves of them.
const ROUNDS: usize = 2;

impl<T: Real> Exchange<T> {
    /// Tries one choice of each group after another, and returns the first solution. A choice is the list of unknowns of the group that
    /// may exceed zero. `None` if there are too many, or if none is a solution to this part of the terms of w.
    pub(super) fn by_choices(&self, groups: &[Vec<Vec<usize>>], accuracy: f64) -> Option<Exchanged<T>> {
        let count = groups.iter().try_fold(1_usize, |count, group| count.checked_mul(group.len()));
        let count = count.filter(|&count| count <= CHOICES)?;
        (0..count).find_map(|number| {
            let mut rest = number;
            let mut basic = Vec::new();
            for group in groups {
                basic.extend_from_slice(&group[rest % group.len()]);
                rest /= group.len();
            }
            self.with_basic(&basic).filter(|found| self.is_solved(found, accuracy))
        })
    }

    /// The z for which w of the basic unknowns is zero and z of all others. Entries that may not be negative, but are, are set to zero.
    fn with_basic(&self, basic: &[usize]) -> Option<Exchanged<T>> {
        let size = self.constant.len();
        let mut found = Exchanged { z: vec![T::constant(0.0); size], is_basic: vec![false; size] };
        basic.iter().for_each(|&k| found.is_basic[k] = true);
        for _ in 0..ROUNDS {
            let entries = basic.iter().flat_map(|&row| basic.iter().map(move |&column| (row, column)));
            let mut matrix: Vec<T> = entries.map(|(row, column)| self.matrix[row][column]).collect();
            let mut change: Vec<T> = basic.iter().map(|&row| -self.w(row, &found.z)[0]).collect();
            if !eliminate(&mut matrix, &mut change) {
                return None;
            }
            basic.iter().zip(&change).for_each(|(&k, &change)| found.z[k] += change);
        }
        for k in (0..size).filter(|&k| !self.is_free[k]) {
            found.z[k] = larger(found.z[k], T::constant(0.0));
        }
        Some(found)
    }

    /// Whether w of basic and free unknowns is zero, and that of all others not negative, to this part of its terms.
    pub(super) fn is_solved(&self, found: &Exchanged<T>, accuracy: f64) -> bool {
        (0..found.z.len()).all(|k| {
            let [w, terms] = self.w(k, &found.z);
            let allowed = self.noise[k] + T::constant(accuracy) * terms;
            w >= -allowed && (w <= allowed || !found.is_basic[k] && !self.is_free[k])
        })
    }

    /// w of an unknown, and the size of its terms.
    fn w(&self, k: usize, z: &[T]) -> [T; 2] {
        let constant = self.constant[k];
        self.matrix[k].iter().zip(z).fold([constant, Scalar::abs(constant)], |[sum, size], (&entry, &z)| {
            [sum + entry * z, size + Scalar::abs(entry * z)]
        })
    }
}
