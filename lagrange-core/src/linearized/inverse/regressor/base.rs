//! Base parameters: the combinations of inertial parameters that forces depend on.
//!
//! Columns of the regressors at several states are taken one after the other; one that is a combination of those before it
//! is regrouped into them (M. Gautier, "Numerical calculation of the base inertial parameters of robots", *Journal of
//! Robotic Systems* 8, 1991).

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::{self, Display, Formatter};

use nalgebra::{DMatrix, DVector};

use super::Regressor;
use crate::error::Error;
use crate::number::{Real, exceeds, larger, power_of_epsilon};

/// The combinations β = C π of inertial parameters that the forces at some states depend on, and no more.
///
/// Each is one parameter, plus multiples of others that are regrouped into it. Inertias are taken first, then first
/// moments, then masses, so that the coefficients are 1, lengths and squares of lengths. Whether a column is a combination
/// of those taken before is decided by what is left of it beside them, as a part of its length: below ε^¾ (2·10⁻¹²) it is
/// one, above ε^¼ (10⁻⁴) it is none. In between it is not decided, and the error asks for other states. The number is that
/// of the states given: what matters at none of them is not among the base parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseParameters<T> {
    /// C: one row for each base parameter, one column for each inertial parameter.
    pub combinations: DMatrix<T>,
    leading: Vec<usize>,
    names: Vec<String>,
}

impl<T: Real> BaseParameters<T> {
    /// Base parameters for motions through states with these regressors, all of the same bodies. Without regressors there are
    /// none.
    ///
    /// # Errors
    /// [`Error::BaseParametersUndecided`], with the parameter; [`Error::OtherBodies`].
    pub fn of(regressors: &[Regressor<T>]) -> Result<Self, Error> {
        let names = regressors.first().map_or(Vec::new(), |first| first.names.clone());
        if regressors.iter().any(|regressor| regressor.names != names) {
            return Err(Error::OtherBodies);
        }
        let parts: Vec<DMatrix<T>> = regressors.iter().map(|regressor| regressor.along_free().0).collect();
        let rows = parts.iter().map(DMatrix::nrows).sum();
        let mut stacked = DMatrix::zeros(rows, names.len());
        let mut row = 0;
        for part in &parts {
            stacked.rows_mut(row, part.nrows()).copy_from(part);
            row += part.nrows();
        }
        let mut basis =
            Basis { columns: Vec::new(), leading: Vec::new(), leaders: Vec::new(), rows: Vec::new() };
        let most = (0..names.len()).fold(T::constant(0.0), |most, j| larger(most, stacked.column(j).norm()));
        // Inertias, then first moments, then masses: what is regrouped has lengths of the system as coefficients.
        let of = |parts: core::ops::Range<usize>| (0..names.len()).filter(move |j| parts.contains(&(j % 10)));
        for j in of(4..10).chain(of(1..4)).chain(of(0..1)) {
            basis.add(j, stacked.column(j).into_owned(), most, &names[j])?;
        }
        Ok(Self { combinations: basis.combinations(names.len()), leading: basis.leading, names })
    }

    /// Number of base parameters.
    pub fn count(&self) -> usize {
        self.leading.len()
    }

    /// Index of the inertial parameter that leads each base parameter, whose coefficient is 1.
    pub fn leading(&self) -> &[usize] {
        &self.leading
    }

    /// Columns of Zᵀ Y for the base parameters: Zᵀ Y π is this times β.
    pub fn columns(&self, regressor: &Regressor<T>) -> DMatrix<T> {
        regressor.along_free().0.select_columns(&self.leading)
    }
}

/// Orthonormal columns so far.
struct Basis<T> {
    columns: Vec<DVector<T>>,
    /// Index of the parameter of each.
    leading: Vec<usize>,
    /// Components of each along these columns.
    leaders: Vec<Vec<T>>,
    /// Each parameter that was added, and its components along the columns.
    rows: Vec<(usize, Vec<T>)>,
}

impl<T: Real> Basis<T> {
    /// Adds a column, if it is no combination of those before.
    fn add(&mut self, j: usize, mut column: DVector<T>, most: T, name: &str) -> Result<(), Error> {
        let length = column.norm();
        let mut along = alloc::vec![T::constant(0.0); self.columns.len()];
        // Twice: what is left is orthogonal to round-off.
        for _ in 0..2 {
            for (part, known) in along.iter_mut().zip(&self.columns) {
                let shared = known.dot(&column);
                *part += shared;
                column.axpy(-shared, known, T::constant(1.0));
            }
        }
        let left = column.norm();
        // A column of round-off alone is zero.
        let is_zero = length <= most * power_of_epsilon::<T>(0.75);
        if is_zero || left <= length * power_of_epsilon::<T>(0.75) {
            if is_zero {
                along.fill(T::constant(0.0));
            }
            self.rows.push((j, along));
            return Ok(());
        }
        if exceeds(length * power_of_epsilon::<T>(0.25), left) {
            return Err(Error::BaseParametersUndecided {
                parameter: name.into(),
                left: (left / length).to_f64(),
            });
        }
        self.columns.push(column / left);
        along.push(left);
        self.leading.push(j);
        self.leaders.push(along.clone());
        self.rows.push((j, along));
        Ok(())
    }

    /// C: solves for the coefficients of each column in those of the leading parameters.
    fn combinations(&self, count: usize) -> DMatrix<T> {
        let base = self.leading.len();
        let mut combinations = DMatrix::zeros(base, count);
        for (j, along) in &self.rows {
            let mut rest = along.clone();
            for k in (0..rest.len()).rev() {
                let leader = &self.leaders[k];
                let coefficient = rest[k] / leader[k];
                combinations[(k, *j)] = coefficient;
                rest.iter_mut().zip(leader).for_each(|(x, y)| *x -= coefficient * *y);
            }
        }
        combinations
    }
}

/// One combination a line; coefficients below 10⁻⁹ are round-off and left out.
impl<T: Real> Display for BaseParameters<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (k, &leader) in self.leading.iter().enumerate() {
            write!(f, "{}", self.names[leader])?;
            for (j, name) in self.names.iter().enumerate().filter(|(j, _)| *j != leader) {
                let x = self.combinations[(k, j)].to_f64();
                if x.abs() > 1e-9 {
                    let sign = if x < 0.0 { '-' } else { '+' };
                    let coefficient = format!("{:.12}", x.abs());
                    let coefficient = coefficient.trim_end_matches('0').trim_end_matches('.');
                    write!(f, " {sign} {coefficient} {name}")?;
                }
            }
            writeln!(f)?;
        }
        Ok(())
    }
}
