//! Solves for the multipliers, by the Schur complement of the constraints.

use super::arithmetic::{Solver, Sparse, SparseEntry};
use super::order::Pattern;
use super::reduce::FormFactors;
use super::short;

/// Maximum number of constraints on a coordinate i for which the entry z_i z'_i / D_i of S = Z D⁻¹ Zᵀ is
/// computed as (z_i z'_i) / D_i, so that a pass can factor the sum. With more constraints, z_i / D_i is
/// computed first, once per row.
const FEW: usize = 2;

impl Solver<'_> {
    /// Factorizes the Schur complement S = Z D⁻¹ Zᵀ. `None` if this takes too many operations.
    pub(super) fn schur_factors(&mut self, factors: &FormFactors, rows: &[Sparse]) -> Option<FormFactors> {
        let schur = self.complement(factors, rows);
        let matrix = schur.iter().map(|row| row.iter().map(Option::is_some).collect()).collect();
        let order = short(&Pattern { matrix, definitions: Vec::new(), after: Vec::new() })?;
        Some(self.factor(schur, Vec::new(), &order, 0))
    }

    /// Solves S λ = −γ − Z D⁻¹L⁻¹b for the multipliers λ; `starts` is D⁻¹L⁻¹b.
    pub(super) fn multipliers(
        &mut self,
        schur: &FormFactors,
        starts: &[SparseEntry],
        rows: &[Sparse],
        bias: Vec<SparseEntry>,
    ) -> Vec<SparseEntry> {
        let target = rows.iter().zip(bias).map(|(row, bias)| {
            let reached = self.dot(row, starts);
            let sum = self.add(bias, reached);
            self.negate(sum)
        });
        let target = target.collect();
        let half = self.forward(schur, target);
        let starts = self.scaled(schur, half);
        self.backward(schur, starts, &vec![None; rows.len()], None)
    }

    /// S = Z D⁻¹ Zᵀ
    fn complement(&mut self, factors: &FormFactors, rows: &[Sparse]) -> Vec<Vec<SparseEntry>> {
        let m = rows.len();
        let mut sharing = vec![0; factors.reciprocals.len()];
        rows.iter().flatten().for_each(|&(i, _)| sharing[i] += 1);
        let mut schur = vec![vec![None; m]; m];
        for (a, row) in rows.iter().enumerate() {
            for (b, other) in rows.iter().enumerate().take(a + 1) {
                schur[a][b] = self.product(row, other, factors, &sharing);
                schur[b][a] = schur[a][b];
            }
        }
        schur
    }

    /// Entry Σ_i z_i z'_i / D_i of the Schur complement, for two rows z and z' of Z.
    fn product(
        &mut self,
        row: &Sparse,
        other: &Sparse,
        factors: &FormFactors,
        sharing: &[usize],
    ) -> SparseEntry {
        let mut sum = None;
        for &(i, z) in row {
            let Ok(position) = other.binary_search_by_key(&i, |&(j, _)| j) else { continue };
            let (other, reciprocal) = (Some(other[position].1), factors.reciprocals[i]);
            let part = if sharing[i] > FEW {
                let scaled = self.multiply(Some(z), reciprocal);
                self.multiply(scaled, other)
            } else {
                let both = self.multiply(Some(z), other);
                self.multiply(both, reciprocal)
            };
            sum = self.add(sum, part);
        }
        sum
    }
}
