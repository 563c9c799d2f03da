//! General solution of the equations of motion, where the elimination of the emitted code is not to be trusted or would be too long.

use lagrange_core::generated::trust;
use lagrange_core::nalgebra::{DMatrix, DVector, FullPivLU};

/// M by rows, h, F by rows and γ, of M x = h + Fᵀλ and F x + γ = 0.
pub(crate) struct DenseEquations<'a> {
    pub(crate) mass: &'a [f64],
    pub(crate) forcing: &'a [f64],
    pub(crate) jacobian: &'a [f64],
    pub(crate) bias: &'a [f64],
}

impl DenseEquations<'_> {
    /// Solves for x and λ, one behind the other, by elimination with full pivoting of the KKT matrix, whose rows and columns are scaled to
    /// masses of one and to constraints of one. `None` if the matrix is singular to half of the digits.
    pub(crate) fn solve(&self) -> Option<DVector<f64>> {
        let (n, m) = (self.forcing.len(), self.bias.len());
        let scales = self.scales();
        let entry = |i: usize, j: usize| match (i < n, j < n) {
            (true, true) => self.mass[i * n + j],
            (true, false) => -self.jacobian[(j - n) * n + i],
            (false, true) => self.jacobian[(i - n) * n + j],
            (false, false) => 0.0,
        };
        let matrix = DMatrix::from_fn(n + m, n + m, |i, j| scales[i] * entry(i, j) * scales[j]);
        let right = self.forcing.iter().copied().chain(self.bias.iter().map(|bias| -bias));
        let right = DVector::from_iterator(n + m, right.zip(&scales).map(|(right, scale)| right * scale));
        let factored = FullPivLU::new(matrix);
        let pivots = factored.u().diagonal().abs();
        let is_regular = trust(pivots.min(), pivots.max()) == 1.0;
        let solved = is_regular.then(|| factored.solve(&right)).flatten()?;
        Some(solved.component_mul(&DVector::from_vec(scales)))
    }

    /// 1/√M_ii of each coordinate, and for each constraint the reciprocal of its largest coefficient times these.
    fn scales(&self) -> Vec<f64> {
        let n = self.forcing.len();
        let reciprocal = |size: f64| if size > 0.0 && size.is_finite() { 1.0 / size } else { 1.0 };
        let mut scales: Vec<f64> = (0..n).map(|i| reciprocal(self.mass[i * n + i].abs().sqrt())).collect();
        let rows = (0..self.bias.len()).map(|a| &self.jacobian[a * n..(a + 1) * n]);
        let largest =
            |row: &[f64]| row.iter().zip(&scales).map(|(f, scale)| (f * scale).abs()).fold(0.0, f64::max);
        let of_constraints: Vec<f64> = rows.map(|row| reciprocal(largest(row))).collect();
        scales.extend(of_constraints);
        scales
    }
}
