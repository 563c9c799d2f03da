//! Derivative of the state at the end of a stretch of motion by the state at its start, and its eigenvalues.

use alloc::vec::Vec;
use core::fmt::{self, Display, Formatter};

use nalgebra::{Complex, DMatrix};

use super::digits::{Printed, printed, rounded};
use super::form::{phase_derivatives, symplectic_form};
use super::multipliers::{logarithm, modulus, of_product, paired};
use crate::StateOf;
use crate::error::Error;
use crate::generic::StaticLength;
use crate::linearized::{Linearized, Stability, StateSensitivity};
use crate::number::{Real, Scalar, power_of_epsilon};
use crate::system::lookup;

/// Derivative ∂(q, q̇)/∂(q, q̇) of the state at the end of a stretch of motion by the state at its start.
///
/// With constraints the derivatives live in the tangent space of {Φ = 0, F q̇ + b = 0}, on which the symplectic form is not degenerate:
/// rows and columns are components along the orthonormal columns of [`basis`](Self::basis), the tangent space at the start. For a
/// closed orbit the tangent space at the end is the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Monodromy<T> {
    /// Derivatives of (q, q̇) at the end along each column of the basis.
    columns: DMatrix<T>,
    basis: DMatrix<T>,
    duration: T,
    /// Ω at the start and at the end.
    forms: [DMatrix<T>; 2],
    /// ∂(q, p)/∂(q, q̇) at the start and at the end.
    phase: [DMatrix<T>; 2],
    /// Factors Φ_m, …, Φ_1 first to last, of which the multipliers other than the trivial ones are computed.
    factors: Vec<DMatrix<T>>,
    trivial: usize,
    /// Norm of the monodromy matrix. Coordinates and velocities of a periodic orbit are divided by its size.
    pub(super) norm: T,
}

/// Derivatives by the initial state as one matrix, of the coordinates above those of the velocities.
pub(super) fn stacked<T: Real, N: StaticLength>(at: &StateSensitivity<T, N>, columns: usize) -> DMatrix<T> {
    DMatrix::from_fn(
        2 * N::COUNT,
        columns,
        |i, j| {
            if i < N::COUNT { at.q[(i, j)] } else { at.v[(i - N::COUNT, j)] }
        },
    )
}

impl<T: Real> Monodromy<T> {
    /// Monodromy of a motion from `start` to `end`, by its derivatives along the columns of the basis.
    pub(super) fn of<L: Linearized<Scalar = T>>(
        system: &L,
        [start, end]: [&StateOf<L>; 2],
        basis: DMatrix<T>,
        columns: DMatrix<T>,
    ) -> Self {
        let factors = alloc::vec![basis.tr_mul(&columns)];
        Self {
            forms: [symplectic_form(system, start), symplectic_form(system, end)],
            phase: [phase_derivatives(system, start), phase_derivatives(system, end)],
            duration: end.t - start.t,
            columns,
            basis,
            norm: factors[0].norm(),
            factors,
            trivial: 0,
        }
    }

    /// Sets the factors whose product has the multipliers, without `trivial` ones that are 1 exactly.
    pub(super) fn with_factors(self, factors: Vec<DMatrix<T>>, trivial: usize, norm: T) -> Self {
        Self { factors, trivial, norm, ..self }
    }

    /// The matrix: 2N × 2N, in the order (q, q̇), without constraints; with constraints the components along the
    /// [`basis`](Self::basis).
    pub fn matrix(&self) -> DMatrix<T> {
        self.basis.tr_mul(&self.columns)
    }

    /// The matrix in coordinates and momenta, ∂(q, p)/∂(q, p). With constraints, in an orthonormal basis of the tangent space in
    /// (q, p).
    ///
    /// It takes ∂p/∂q from extrapolated differences of the momenta, about 11 digits; neither
    /// [`multipliers`](Self::multipliers) nor [`symplectic_error`](Self::symplectic_error) do.
    ///
    /// # Errors
    /// [`Error::EigenvaluesNotFound`] if the momenta do not determine the velocities at the start.
    pub fn matrix_in_momenta(&self) -> Result<DMatrix<T>, Error> {
        let start = &self.phase[0] * &self.basis;
        let frame = match self.basis.is_square() {
            true => DMatrix::identity(start.nrows(), start.ncols()),
            false => start.clone().qr().q(),
        };
        let back = frame.tr_mul(&start).try_inverse().ok_or(Error::EigenvaluesNotFound)?;
        Ok(frame.tr_mul(&(&self.phase[1] * &self.columns)) * back)
    }

    /// Orthonormal basis of the tangent space at the start, one row for each coordinate, then for each velocity; the identity
    /// without constraints.
    pub fn basis(&self) -> &DMatrix<T> {
        &self.basis
    }

    /// Time from start to end.
    pub fn duration(&self) -> T {
        self.duration
    }

    /// How far the matrix is from symplectic: the largest entry of Φᵀ Ω₁ Φ − Ω₀, relative to the largest sum of the magnitudes of
    /// its terms. Ω is the matrix of Σ dp_i ∧ dq_i on the tangent space.
    ///
    /// For a motion without dissipation it is the error of the method, down to round-off, whether or not a force depends on the
    /// time; friction or control in the motion show as a number of the size of their effect.
    pub fn symplectic_error(&self) -> T {
        let form = |omega: &DMatrix<T>, x: &DMatrix<T>| x.tr_mul(&(omega * x));
        let [start, end] = &self.forms;
        let off = form(end, &self.columns) - form(start, &self.basis);
        let terms = form(&end.map(Scalar::abs), &self.columns.map(Scalar::abs));
        if terms.amax() > T::constant(0.0) { off.amax() / terms.amax() } else { off.amax() }
    }

    /// True if the [`symplectic_error`](Self::symplectic_error) is below √ε. Multipliers are then paired, which changes them by about
    /// that error at most.
    pub fn is_symplectic(&self) -> bool {
        self.symplectic_error() <= power_of_epsilon(0.5) && self.basis.ncols().is_multiple_of(2)
    }

    /// Floquet multipliers: the eigenvalues, in descending order of the modulus. If the motion is
    /// [symplectic](Self::is_symplectic), they come in pairs (λ, 1/λ), the larger first, and exact reciprocals; pairs on the unit
    /// circle have the modulus 1.
    ///
    /// Eigenvalues of a symplectic matrix that meet on the unit circle are found to the square root of the matrix's error only, as
    /// the four of a Jordan block. Those that a [periodic orbit](super::PeriodicOrbit) must have, 1 for the shift along the orbit
    /// and 1 for its energy, are split off beforehand, and come last.
    ///
    /// # Errors
    /// [`Error::EigenvaluesNotFound`] if an entry is not finite.
    pub fn multipliers(&self) -> Result<Vec<Complex<T>>, Error> {
        let mut found = self.nontrivial()?;
        let one = Complex::new(T::constant(1.0), T::constant(0.0));
        found.extend(core::iter::repeat_n(one, self.trivial));
        Ok(found)
    }

    /// Multipliers without those that are 1 for every orbit of the kind.
    pub(super) fn nontrivial(&self) -> Result<Vec<Complex<T>>, Error> {
        let found = of_product(&self.factors)?;
        Ok(if self.is_symplectic() { paired(found) } else { found })
    }

    /// Matrix of the multipliers that are not 1 for every orbit of the kind.
    pub(super) fn nontrivial_product(&self) -> DMatrix<T> {
        let count = self.factors.first().map_or(0, DMatrix::ncols);
        self.factors.iter().fold(DMatrix::identity(count, count), |product, factor| factor * product)
    }

    /// Number of multipliers that are 1 because of the kind of orbit: 1 for a shift along an orbit without a clock, and 1 for the
    /// energy if it is conserved.
    pub fn trivial(&self) -> usize {
        self.trivial
    }

    /// Floquet exponents ln λ/T, in the order of the [`multipliers`](Self::multipliers). Imaginary parts are known up to multiples
    /// of 2π/T; these are the ones between −π/T and π/T.
    ///
    /// # Errors
    /// [`Error::Setting`] if the stretch has no length, and those of [`multipliers`](Self::multipliers).
    pub fn exponents(&self) -> Result<Vec<Complex<T>>, Error> {
        if self.duration == T::constant(0.0) {
            return Err(Error::Setting { name: "duration of the motion", value: 0.0 });
        }
        let per_time = |x| {
            let Complex { re, im } = logarithm(x);
            Complex::new(re / self.duration, im / self.duration)
        };
        Ok(self.multipliers()?.into_iter().map(per_time).collect())
    }

    /// Stability of a periodic motion, from its multipliers other than the trivial ones, as far as the linear part decides
    /// ([`Stability::Undecided`] if all are on the unit circle, or inside with some on it).
    ///
    /// A modulus counts as 1 within ε^(1/3) (6·10⁻⁶ for `f64`), since round-off moves a triple multiplier that far.
    ///
    /// # Errors
    /// Those of [`multipliers`](Self::multipliers).
    pub fn stability(&self) -> Result<Stability, Error> {
        let (one, resolution) = (T::constant(1.0), power_of_epsilon::<T>(1.0 / 3.0));
        let largest = self.nontrivial()?.into_iter().map(modulus).next();
        Ok(match largest {
            Some(largest) if largest > one + resolution => Stability::Unstable,
            Some(largest) if largest >= one - resolution => Stability::Undecided,
            _ => Stability::AsymptoticallyStable,
        })
    }
}

/// Prints how symplectic the matrix is, and the multipliers in pairs with their moduli.
impl<T: Real> Display for Monodromy<T> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let error = self.symplectic_error().to_f64();
        let is = if self.is_symplectic() { "symplectic" } else { "not symplectic" };
        let duration = rounded(self.duration.to_f64(), printed::<T>() * self.duration.to_f64());
        writeln!(f, "monodromy over {duration}: {is}, by an error of {error:.1e}")?;
        let Ok(multipliers) = self.nontrivial() else { return writeln!(f, "multipliers not found") };
        let mut rest = &multipliers[..];
        while let [first, others @ ..] = rest {
            let (x, size) = (Printed(*first), modulus(*first).to_f64());
            let size = rounded(size, size * printed::<T>());
            rest = others;
            match others {
                [second, others @ ..] if self.is_symplectic() || is_conjugate(*first, *second) => {
                    rest = others;
                    writeln!(f, "multipliers {x} and {}, |λ| = {size}", Printed(*second))?;
                }
                _ => writeln!(f, "multiplier {x}, |λ| = {size}")?,
            }
        }
        match self.trivial {
            0 => Ok(()),
            1 => writeln!(f, "multiplier 1 of the shift along the orbit"),
            _ => writeln!(f, "multipliers 1 and 1 of the shift along the orbit and of its energy"),
        }
    }
}

fn is_conjugate<T: Real>(x: Complex<T>, y: Complex<T>) -> bool {
    x.im != T::constant(0.0) && x.re == y.re && x.im == -y.im
}

/// See [`PeriodicMotion::monodromy_across`](super::PeriodicMotion::monodromy_across).
pub(super) fn across<L: Linearized<Scalar: Real>>(
    system: &L,
    start: &StateOf<L>,
    end: &StateSensitivity<L::Scalar, L::N>,
) -> Result<Monodromy<L::Scalar>, Error> {
    let names = lookup::entries::<L>();
    let known: Vec<_> = end.arguments().iter().map(alloc::string::ToString::to_string).collect();
    let order = names.iter().map(|name| lookup::index::<L>(&known, "argument of these derivatives", name));
    let order = order.collect::<Result<Vec<_>, _>>()?;
    let all = stacked(end, known.len());
    let by_state = DMatrix::from_fn(all.nrows(), order.len(), |i, j| all[(i, order[j])]);
    let basis = system.linearize(start, &[])?.basis;
    let columns = by_state * &basis;
    Ok(Monodromy::of(system, [start, &end.state], basis, columns))
}
