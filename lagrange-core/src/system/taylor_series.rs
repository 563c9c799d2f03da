//! The contract for Taylor series of the motion.

use core::fmt::Debug;

use nalgebra::SVector;

use super::lagrangian::Lagrangian;
use super::state::{Solution, State};
use crate::number::{FixedArray, PowerSeries};
use crate::system::Direction;

/// What the right-hand sides of the equations of motion are: in the places of h and of γ.
pub type RightHandSides<T, const N: usize, const M: usize> = (SVector<T, N>, SVector<T, M>);

/// A system whose motion can be expanded in a Taylor series, order by order: what [`Taylor`](crate::Taylor) integrates.
///
/// `#[derive(Lagrangian)]` implements it where everything in the equations has a Taylor series. The coefficients of
/// accelerations and multipliers of every order k solve one linear system, M x − Fᵀλ = h, F x = −γ with the M and F of the state
/// that is expanded about; only the right-hand sides differ. They and what the next order needs are linear in
/// the newest coefficients, made of numbers of the state, the [slopes](Self::series_slopes), and of sums Σ x_j y_{k−j} over
/// the coefficients before (Griewank and Walther, *Evaluating Derivatives*, 13.2).
#[diagnostic::on_unimplemented(
    message = "the Taylor series of the motion of `{Self}` is not known",
    label = "no `TaylorSeries`",
    note = "`#[derive(Lagrangian)]` gives it to every system but those whose equations of motion have `abs`, `min`, `max` or `clamp`, take third derivatives of a function of yours, or have a series of more than 50,000 operations: use `Dop853` there"
)]
pub trait TaylorSeries<const N: usize, const M: usize>: Lagrangian<N, M> {
    /// What an order is made of beside coefficients: plain numbers.
    type SeriesSlopes: Copy + Debug + AsRef<[Self::Scalar]>;
    /// One number for each sum, and zeros up to a multiple of four.
    type Sums: FixedArray<Self::Scalar>;
    /// What is known of the newest coefficients before the accelerations of their order.
    type SeriesTerms: Copy + Debug;

    /// For each root of something that moves, √x or x²ᐟ⁵, the place of a sum whose right factor it is, and of its value among the
    /// slopes. The series of a root goes on below zero, the root does not: that of √x² is ±x.
    const ROOTS: &'static [[usize; 2]] = &[];
    /// For each argument of a function that the user supplies, the place of a sum whose left factor it is, and of its value among
    /// the slopes.
    const ARGUMENTS: &'static [[usize; 2]] = &[];
    /// For each argument of exp, tanh, sinh and cosh and each base of a power of 16 or more, the place of a sum whose left factor it is, of
    /// its value among the slopes, and the exponent of the power or zero: such functions may be too small for a series at the
    /// start of a step, and large within. Where the exponent e is known at run time, the value is that of x/e, and the exponent 1.
    const STEEP: &'static [[usize; 3]] = &[];

    /// Coefficients that the recurrences of all orders share, at one state.
    fn series_slopes(
        &self,
        state: &State<Self::Scalar, N>,
        solution: &Solution<Self::Scalar, N, M>,
    ) -> Self::SeriesSlopes;

    /// Puts into their places among the sums what the functions that the user supplies add to this order, by the series of
    /// their arguments, in which the coefficients of that order are zero.
    fn series_functions(&self, order: usize, arguments: &[PowerSeries<Self::Scalar>], sums: &mut Self::Sums) {
        let _ = (order, arguments, sums);
    }

    /// What stands for h and γ where the coefficients of accelerations and multipliers are solved for, of an order k that is
    /// given as k, 1/k, c/(k + 1) and 1/c², where c is a multiple of all orders; `direction` has the coefficients of time, coordinates and velocities of that order. Beside
    /// that what is known by then of the factors of the sums.
    fn series_right_hand_sides(
        &self,
        slopes: &Self::SeriesSlopes,
        sums: &Self::Sums,
        order: &[Self::Scalar; 4],
        direction: &Direction<Self::Scalar, N>,
    ) -> (RightHandSides<Self::Scalar, N, M>, Self::SeriesTerms);

    /// The terms of that order of the two factors of each sum, by what was known of them and the accelerations and multipliers.
    fn series_factors(
        &self,
        slopes: &Self::SeriesSlopes,
        terms: &Self::SeriesTerms,
        order: &[Self::Scalar; 4],
        direction: &Direction<Self::Scalar, N>,
        accelerations: &SVector<Self::Scalar, N>,
        multipliers: &SVector<Self::Scalar, M>,
    ) -> [Self::Sums; 2];
}
