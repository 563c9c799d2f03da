//! M and the constraints that may complete it.

use super::super::constraints::Constraints;
use crate::resolve::Problem;
use crate::symbolic::Id;

pub(super) struct System<'e> {
    pub(super) problem: &'e Problem,
    pub(super) mass: &'e [Vec<Id>],
    pub(super) constraints: &'e Constraints,
}

impl System<'_> {
    /// Indices of the constraints that always hold, sorted by the number of zeros of M that they fill in, then by the number of
    /// coordinates that they couple.
    pub(super) fn by_fill(&self) -> Vec<usize> {
        let jacobian = &self.constraints.jacobian;
        let fill = |row: &[Id]| {
            let tied = tied(row);
            let pairs = tied.iter().flat_map(|&i| tied.iter().map(move |&j| (i, j)));
            (pairs.filter(|&(i, j)| self.mass[i][j] == Id::ZERO).count(), tied.len())
        };
        let mut order: Vec<usize> =
            (0..jacobian.len()).filter(|&a| self.constraints.always_holds(a)).collect();
        order.sort_by_cached_key(|&a| fill(&jacobian[a]));
        order
    }
}

/// The coordinates that a constraint couples.
pub(super) fn tied(row: &[Id]) -> Vec<usize> {
    (0..row.len()).filter(|&i| row[i] != Id::ZERO).collect()
}
