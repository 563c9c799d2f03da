//! Traits of user-supplied functions, one for each order of derivative.

use crate::number::{Dual, Scalar};

/// A function of `I` numbers with `O` results, written once for every scalar. Dual numbers supply its
/// derivatives.
///
/// ```
/// use lagrange_core::prelude::*;
///
/// /// The potential −k/r.
/// struct Newton { k: f64 }
///
/// impl Function<3, 1> for Newton {
///     fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
///         [S::constant(-self.k) / (x * x + y * y + z * z).sqrt()]
///     }
/// }
///
/// #[derive(Lagrangian)]
/// #[coordinates(r: [3])]
/// #[function(U(r) = potential)]
/// #[lagrangian(m/2 * dot(r_dot, r_dot) - U(r))]
/// struct Planet { m: f64, potential: Newton }
///
/// let planet = Planet { m: 2.0, potential: Newton { k: 4.0 } };
/// let force = planet.forcing(&State::at_rest([0.0, 2.0, 0.0]));
/// assert_eq!(force.as_slice(), [0.0, -1.0, 0.0]);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a function of {I} number(s) with {O} result(s) over every scalar",
    label = "not known over every scalar",
    note = "implement `lagrange_core::Function<{I}, {O}>` for it; `WithDerivatives` and `Table` are known over `f64` alone, which is enough for `Dop853`; `SmoothTable` also for Jacobians and `Radau`"
)]
pub trait Function<const I: usize, const O: usize> {
    /// Returns the values at `x`.
    fn eval<S: Scalar>(&self, x: [S; I]) -> [S; O];
}

/// A function with values over the scalar `S`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not known to be a function over `{S}` of {I} number(s) with {O} result(s)",
    label = "a field named in `#[function(…)]` must be one",
    note = "implement `lagrange_core::Function<{I}, {O}>` for it; for `f64` alone there are `WithDerivatives` and `Table`"
)]
pub trait Value<S, const I: usize, const O: usize> {
    /// Returns the values at `x`.
    fn value(&self, x: [S; I]) -> [S; O];
}

/// A function with first derivatives.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not known to be a function over `{S}` of {I} number(s) with {O} result(s) and first derivatives",
    label = "the equations need its first derivatives",
    note = "implement `lagrange_core::Function<{I}, {O}>` for it, from which all derivatives follow; for `f64` alone `WithDerivatives` and `Table` know the first and the second"
)]
pub trait First<S, const I: usize, const O: usize>: Value<S, I, O> {
    /// Returns ∂/∂x_i of each result at `x`.
    fn first(&self, x: [S; I], i: [usize; 1]) -> [S; O];
}

/// A function with second derivatives.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not known to be a function over `{S}` of {I} number(s) with {O} result(s) and second derivatives",
    label = "the equations need its second derivatives",
    note = "implement `lagrange_core::Function<{I}, {O}>` for it, from which all derivatives follow; for `f64` alone `WithDerivatives` and `Table` know the first and the second"
)]
pub trait Second<S, const I: usize, const O: usize>: First<S, I, O> {
    /// Returns ∂²/∂x_i ∂x_j of each result at `x`.
    fn second(&self, x: [S; I], ij: [usize; 2]) -> [S; O];
}

/// A function with third derivatives.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not known to be a function over `{S}` of {I} number(s) with {O} result(s) and third derivatives",
    label = "the equations need its third derivatives",
    note = "implement `lagrange_core::Function<{I}, {O}>` for it, from which all derivatives follow; over `f64` a `SmoothTable` knows the third, `WithDerivatives` and `Table` know none"
)]
pub trait Third<S, const I: usize, const O: usize>: Second<S, I, O> {
    /// Returns ∂³/∂x_i ∂x_j ∂x_k of each result at `x`.
    fn third(&self, x: [S; I], ijk: [usize; 3]) -> [S; O];
}

/// Returns `x` as dual numbers with slope 1 in argument `i`.
#[inline(always)]
fn seeded<S: Scalar, const I: usize>(x: [S; I], i: usize) -> [Dual<S>; I] {
    let mut x = x.map(|value| Dual { value, slope: S::constant(0.0) });
    if let Some(x) = x.get_mut(i) {
        x.slope = S::constant(1.0);
    }
    x
}

impl<F: Function<I, O>, S: Scalar, const I: usize, const O: usize> Value<S, I, O> for F {
    #[inline]
    fn value(&self, x: [S; I]) -> [S; O] {
        self.eval(x)
    }
}

impl<F: Function<I, O>, S: Scalar, const I: usize, const O: usize> First<S, I, O> for F {
    #[inline]
    fn first(&self, x: [S; I], [i]: [usize; 1]) -> [S; O] {
        self.eval(seeded(x, i)).map(|y| y.slope)
    }
}

impl<F: Function<I, O>, S: Scalar, const I: usize, const O: usize> Second<S, I, O> for F {
    #[inline]
    fn second(&self, x: [S; I], [i, j]: [usize; 2]) -> [S; O] {
        self.first(seeded(x, j), [i]).map(|y: Dual<S>| y.slope)
    }
}

impl<F: Function<I, O>, S: Scalar, const I: usize, const O: usize> Third<S, I, O> for F {
    #[inline]
    fn third(&self, x: [S; I], [i, j, k]: [usize; 3]) -> [S; O] {
        self.second(seeded(x, k), [i, j]).map(|y: Dual<S>| y.slope)
    }
}

/// A function of `f64` with hand-written gradient and Hessian. [`WithDerivatives`] makes it usable in a system,
/// and [`check_derivatives`](super::check_derivatives) compares its derivatives with finite differences.
pub trait FunctionWithDerivatives<const I: usize, const O: usize> {
    /// Returns the values at `x`.
    fn value(&self, x: [f64; I]) -> [f64; O];
    /// Returns the gradient of each result at `x`.
    fn gradient(&self, x: [f64; I]) -> [[f64; I]; O];
    /// Returns the Hessian of each result at `x`.
    fn hessian(&self, x: [f64; I]) -> [[[f64; I]; I]; O];
}

/// A function with hand-written derivatives, as a field of a system over `f64`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WithDerivatives<F>(pub F);

impl<F: FunctionWithDerivatives<I, O>, const I: usize, const O: usize> Value<f64, I, O>
    for WithDerivatives<F>
{
    fn value(&self, x: [f64; I]) -> [f64; O] {
        self.0.value(x)
    }
}

impl<F: FunctionWithDerivatives<I, O>, const I: usize, const O: usize> First<f64, I, O>
    for WithDerivatives<F>
{
    fn first(&self, x: [f64; I], [i]: [usize; 1]) -> [f64; O] {
        self.0.gradient(x).map(|gradient| gradient[i])
    }
}

impl<F: FunctionWithDerivatives<I, O>, const I: usize, const O: usize> Second<f64, I, O>
    for WithDerivatives<F>
{
    fn second(&self, x: [f64; I], [i, j]: [usize; 2]) -> [f64; O] {
        self.0.hessian(x).map(|hessian| hessian[i][j])
    }
}
