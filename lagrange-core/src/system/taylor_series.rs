//! The trait of systems whose motion has a Taylor series.

use core::fmt::Debug;

use super::lagrangian::Lagrangian;
use crate::number::PowerSeries;
use crate::system::{Direction, SolutionOf, StateOf};
use crate::vector::{FixedArray, Vector};

/// Right-hand sides (h, γ) of the linear system M x − Fᵀλ = h, F x = −γ for one Taylor order.
pub type RightHandSides<T, N, M> = (Vector<T, N>, Vector<T, M>);

/// A system whose motion can be expanded in a Taylor series, order by order, as [`Taylor`](crate::Taylor) does.
///
/// `#[derive(Lagrangian)]` implements it if every function in the equations has a Taylor series. The
/// coefficients of accelerations and multipliers of every order k solve one linear system, M x − Fᵀλ = h, F x
/// = −γ. M and F are those of the expansion point; only the right-hand sides depend on k. The right-hand
/// sides, and the coefficients of intermediate expressions, are linear in the coefficients of order k. Their
/// other factors and terms are numbers of the state, the [slopes](Self::series_slopes), and convolutions Σ
/// x_j y_{k−j} of coefficients of lower orders (Griewank and Walther, *Evaluating Derivatives*, 13.2).
#[diagnostic::on_unimplemented(
    message = "the Taylor series of the motion of `{Self}` is not known",
    label = "no `TaylorSeries`",
    note = "`#[derive(Lagrangian)]` gives it to every system but those whose equations of motion have `abs`, `min`, `max` or `clamp`, take third derivatives of a function of yours, or have a series of more than 50,000 operations: use `Dop853` there"
)]
pub trait TaylorSeries: Lagrangian {
    /// Coefficients at a state that the recurrences of all orders share.
    type SeriesSlopes: Copy + Debug + AsRef<[Self::Scalar]>;
    /// One number for each convolution sum, padded with zeros to a multiple of four.
    type Sums: FixedArray<Self::Scalar>;
    /// Parts of the coefficients of one order that are known before the accelerations and multipliers of this
    /// order.
    type SeriesTerms: Copy + Debug;

    /// For each root of a varying quantity, √x or x²ᐟ⁵: index of a sum whose right factor is the root, and
    /// index of its value among the slopes. The series of a root may become negative, but the root cannot:
    /// the series of √x² is ±x.
    const ROOTS: &'static [[usize; 2]] = &[];
    /// For each argument of a user-supplied function: index of a sum whose left factor is the argument, and
    /// index of its value among the slopes.
    const ARGUMENTS: &'static [[usize; 2]] = &[];
    /// For each argument of exp, tanh, sinh and cosh, and each base of a power with exponent 16 or more: index
    /// of a sum whose left factor it is, index of its value among the slopes, and the exponent of the power or
    /// zero. Such functions may be too small for the series at the start of a step, and large within the step.
    /// If the exponent e is known only at run time, the value is that of x/e, and the exponent 1.
    const STEEP: &'static [[usize; 3]] = &[];

    /// Returns the coefficients that the recurrences of all orders share, at one state.
    fn series_slopes(&self, state: &StateOf<Self>, solution: &SolutionOf<Self>) -> Self::SeriesSlopes;

    /// Stores in `sums` the contributions of the user-supplied functions to this order. `arguments` holds the
    /// series of their arguments, with zeros for the coefficients of this order.
    fn series_functions(&self, order: usize, arguments: &[PowerSeries<Self::Scalar>], sums: &mut Self::Sums) {
        let _ = (order, arguments, sums);
    }

    /// Returns the right-hand sides h and γ of the linear system for the accelerations and multipliers of
    /// order k, and the parts of the factors of the sums that do not depend on these. `order` holds k, 1/k,
    /// c/(k + 1) and 1/c², where c is a common multiple of all orders. `direction` holds the coefficients of
    /// order k of the time, the coordinates and the velocities.
    fn series_right_hand_sides(
        &self,
        slopes: &Self::SeriesSlopes,
        sums: &Self::Sums,
        order: &[Self::Scalar; 4],
        direction: &Direction<Self::Scalar, Self::N>,
    ) -> (RightHandSides<Self::Scalar, Self::N, Self::M>, Self::SeriesTerms);

    /// Returns the coefficients of order k of the two factors of each sum, from their known parts `terms` and
    /// from the accelerations and multipliers of order k.
    fn series_factors(
        &self,
        slopes: &Self::SeriesSlopes,
        terms: &Self::SeriesTerms,
        order: &[Self::Scalar; 4],
        direction: &Direction<Self::Scalar, Self::N>,
        accelerations: &Vector<Self::Scalar, Self::N>,
        multipliers: &Vector<Self::Scalar, Self::M>,
    ) -> [Self::Sums; 2];
}
