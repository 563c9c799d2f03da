//! Taylor series of a motion about one of its states.

use alloc::vec;
use alloc::vec::Vec;
use core::convert::Infallible;

use super::last::{Last, exp2_roughly, log2_roughly};
use super::limits::{LAST, UNDERFLOW};
use super::sums::{Ends, SeriesFactors};
use crate::error::Error;
use crate::number::limits::ITERATIONS;
use crate::number::{PowerSeries, Real, Scalar, larger};
use crate::solution::kkt::{self, KktSystem, Rank};
use crate::solution::pivot::is_trustworthy;
use crate::solution::solve::{fault, not_finite, solve_near};
use crate::system::{Direction, Lagrangian, RightHandSides, Solution, State, TaylorSeries};
use crate::vector::{Array, Element, FixedArray, StaticLength, array, from_fn, rows, vector};

/// Common multiple c of all orders, scaled by a power of two to about 1, so that division by any order is
/// exact. Among such multiples, this one has the smallest relative rounding error of 1/c², 10⁻²⁰.
const MULTIPLE: f64 = 3_185_466_681_422_025.0 / (1_u64 << 51) as f64;

/// Accelerations and multipliers at a state, and the constraints that determine them.
#[derive(Clone, Debug)]
pub(crate) struct SolvedState<T: Element, N: StaticLength, M: StaticLength> {
    pub(crate) solution: Solution<T, N, M>,
    pub(crate) active: Array<bool, M>,
}

impl<T: Real, N: StaticLength, M: StaticLength> SolvedState<T, N, M> {
    pub(crate) fn at<L: Lagrangian<N = N, M = M, Scalar = T>>(
        system: &L,
        state: &State<T, N>,
    ) -> Result<Self, Error> {
        solve_near(system, state, None, |solution, active| Self { solution: *solution, active: *active })
    }

    /// True if the factorization by elimination is reliable enough for all orders.
    pub(crate) fn is_by_elimination(&self) -> bool {
        is_trustworthy(&self.solution) && self.solution.multipliers_are_unique()
    }
}

/// Taylor coefficients of coordinates and velocities about a state, in powers of (t − t₀)/unit.
#[derive(Clone, Debug)]
pub(crate) struct Expansion<S, T: Element, N: StaticLength> {
    pub(crate) start: T,
    /// Unit of time. One near the length of a step avoids overflow and underflow of the coefficients.
    pub(crate) unit: T,
    /// Coefficients from order 0 on; the coordinates have one order more than the velocities.
    pub(crate) q: Vec<Array<T, N>>,
    pub(crate) v: Vec<Array<T, N>>,
    /// Highest order that is summed; higher orders are left out if they are rounding errors.
    pub(crate) summed: usize,
    pub(super) factors: SeriesFactors<T, S>,
    /// Values of the roots at the start, in the order of [`TaylorSeries::ROOTS`].
    pub(crate) roots: Vec<T>,
    /// Values at the start of the arguments of steep functions, in the order of [`TaylorSeries::STEEP`].
    pub(crate) steep: Vec<T>,
    /// Series of the arguments of user-supplied functions, in the order of [`TaylorSeries::ARGUMENTS`].
    arguments: Vec<PowerSeries<T>>,
}

impl<S: FixedArray<T>, T: Scalar, N: StaticLength> Expansion<S, T, N> {
    /// Allocates a series of this order.
    pub(crate) fn new<L: TaylorSeries<N = N, Scalar = T, Sums = S>>(order: usize) -> Self {
        let zero = T::constant(0.0);
        Self {
            start: zero,
            unit: T::constant(1.0),
            q: vec![Array::filled(zero); order + 2],
            v: vec![Array::filled(zero); order + 1],
            summed: order,
            factors: SeriesFactors::new(order),
            roots: vec![zero; L::ROOTS.len()],
            steep: vec![zero; L::STEEP.len()],
            arguments: vec![PowerSeries::constant(0.0); L::ARGUMENTS.len()],
        }
    }

    pub(crate) fn order(&self) -> usize {
        self.v.len() - 1
    }

    /// Coefficients of the highest order. All others contribute to them: if these are finite, all are.
    pub(crate) fn last(&self) -> [&Array<T, N>; 2] {
        let order = self.order();
        [&self.q[order + 1], &self.v[order]]
    }

    /// Expands the motion about a state, given accelerations and multipliers there. `solve` returns those of a higher
    /// order, from the right-hand sides of that order.
    #[inline(always)]
    pub(crate) fn orders<L: TaylorSeries<N = N, Scalar = T, Sums = S>, E>(
        &mut self,
        system: &L,
        state: &State<T, N>,
        solution: &Solution<T, N, L::M>,
        unit: T,
        solve: impl Fn(&RightHandSides<T, N, L::M>) -> Result<Solution<T, N, L::M>, E>,
    ) -> Result<(), E> {
        (self.start, self.unit, self.summed) = (state.t, unit, self.order());
        (self.q[0], self.v[0]) = (state.q.into(), state.v.into());
        let (slopes, highest) = (system.series_slopes(state, solution), self.order());
        for (root, &[_, slope]) in self.roots.iter_mut().zip(L::ROOTS) {
            *root = slopes.as_ref()[slope];
        }
        for (value, &[_, slope, _]) in self.steep.iter_mut().zip(L::STEEP) {
            *value = slopes.as_ref()[slope];
        }
        for (argument, &[_, slope]) in self.arguments.iter_mut().zip(L::ARGUMENTS) {
            *argument = PowerSeries::new(&[slopes.as_ref()[slope], T::constant(0.0)]);
        }
        let (mut newest, mut ends, mut sums) = (*solution, Ends::new(), S::filled(T::constant(0.0)));
        for order in 1..=highest {
            let (this, next) = (order as f64, (order + 1) as f64);
            let numbers = [this, 1.0 / this, MULTIPLE / next, 1.0 / (MULTIPLE * MULTIPLE)].map(T::constant);
            let direction = self.advance(order, &newest);
            if order == highest {
                break;
            }
            self.factors.add_up(order, &ends, &mut sums);
            if const { !L::ARGUMENTS.is_empty() } {
                system.series_functions(order, &self.arguments, &mut sums);
            }
            let (sides, terms) = system.series_right_hand_sides(&slopes, &sums, &numbers, &direction);
            newest = solve(&sides)?;
            let Solution { accelerations, multipliers, .. } = &newest;
            let factors =
                system.series_factors(&slopes, &terms, &numbers, &direction, accelerations, multipliers);
            self.factors.put(order, &factors, &mut ends);
            for (argument, &[place, _]) in self.arguments.iter_mut().zip(L::ARGUMENTS) {
                argument.extend(factors[0].as_ref()[place]);
            }
        }
        self.q[highest + 1] = scaled(&self.v[highest], unit_over(self.unit, highest + 1));
        Ok(())
    }

    /// Sets the coefficients of this order, from the accelerations of the order before, and returns them.
    #[inline(always)]
    fn advance<M: StaticLength>(&mut self, order: usize, newest: &Solution<T, N, M>) -> Direction<T, N> {
        let factor = unit_over(self.unit, order);
        let q = scaled(&self.v[order - 1], factor);
        let v = scaled(&array(newest.accelerations), factor);
        (self.q[order], self.v[order]) = (q, v);
        let t = if order == 1 { self.unit } else { T::constant(0.0) };
        Direction { t, q: vector(q), v: vector(v) }
    }

    /// Reciprocal sizes of coordinates and velocities, in which coefficients are measured.
    pub(crate) fn scales(&self, slack: T) -> [Array<T, N>; 2] {
        [&self.q, &self.v].map(|x| x[0].map(|x| T::constant(1.0) / (x.abs() + slack)))
    }

    /// Largest coefficient of an order, in units of the sizes.
    pub(crate) fn size(&self, order: usize, scales: &[Array<T, N>; 2]) -> T {
        let [q, v] = [(&self.q[order], &scales[0]), (&self.v[order], &scales[1])].map(|(x, scales)| {
            (0..N::COUNT).fold(T::constant(0.0), |most, i| most.max(x[i].abs() * scales[i]))
        });
        q.max(v)
    }

    /// Sizes of the last coefficients.
    pub(crate) fn last_sizes(&self, slack: T) -> Last<T> {
        let (order, scales) = (self.order(), self.scales(slack));
        let sizes = from_fn(|i| self.size(order + 1 - LAST + i, &scales));
        Last { order, unit: self.unit, sizes }
    }

    /// Changes of coordinates and velocities over a step of this length, and the accelerations at its end.
    pub(crate) fn change(&self, length: T) -> [Array<T, N>; 3] {
        let (theta, order) = (length / self.unit, self.summed);
        let change =
            |coefficients: &[Array<T, N>]| scaled(&polynomial(coefficients.iter().copied(), theta), theta);
        let rates = (1..=order).map(|k| scaled(&self.v[k], T::constant(k as f64)));
        let rate = scaled(&polynomial(rates, theta), T::constant(1.0) / self.unit);
        [change(&self.q[1..order + 2]), change(&self.v[1..=order]), rate]
    }
}

impl<S: FixedArray<T>, T: Real, N: StaticLength> Expansion<S, T, N> {
    /// Expands the motion about a state, given the solution of the equations there. Returns the sizes of the last
    /// coefficients.
    pub(crate) fn about<L: TaylorSeries<N = N, Scalar = T, Sums = S>>(
        &mut self,
        system: &L,
        state: &State<T, N>,
        solved: &SolvedState<T, N, L::M>,
        [unit, slack]: [T; 2],
    ) -> Result<Last<T>, Error> {
        let solution = &solved.solution;
        if solved.is_by_elimination() {
            let factor = system.factor(state);
            let solve =
                |(forcing, bias): &RightHandSides<T, N, L::M>| Ok(system.solve_with(&factor, forcing, bias));
            let Ok::<(), Infallible>(()) = self.orders(system, state, solution, unit, solve);
            let last = self.last_sizes(slack);
            if self.is_finite(self.order()) && self.better_unit::<L>(&last, slack).is_none() {
                return Ok(last);
            }
        }
        self.about_in_general(system, state, solved, [unit, slack])
    }

    /// Like [`about`](Self::about), by the factors of the general solver. Used if the elimination is not reliable and
    /// gives NaN, and for other units of time, which are rare. A separate function, because the matrices are large.
    #[cold]
    #[inline(never)]
    fn about_in_general<L: TaylorSeries<N = N, Scalar = T, Sums = S>>(
        &mut self,
        system: &L,
        state: &State<T, N>,
        SolvedState { solution, active }: &SolvedState<T, N, L::M>,
        [unit, slack]: [T; 2],
    ) -> Result<Last<T>, Error> {
        let general = General::at(system, state, *active)?;
        let expand = |series: &mut Self, unit| {
            series.orders(system, state, solution, unit, |sides| general.solve::<L>(sides))
        };
        self.in_units::<L>(unit, slack, expand)
    }

    /// Expands the motion in this unit of time. Repeats the expansion in a better unit while the last
    /// coefficients overflow or underflow.
    #[cold]
    fn in_units<L: TaylorSeries>(
        &mut self,
        mut unit: T,
        slack: T,
        expand: impl Fn(&mut Self, T) -> Result<(), Error>,
    ) -> Result<Last<T>, Error> {
        for _ in 0..ITERATIONS {
            expand(self, unit)?;
            let last = self.last_sizes(slack);
            match self.better_unit::<L>(&last, slack) {
                None => return Ok(last),
                Some(better) => unit = better,
            }
        }
        Ok(self.last_sizes(slack))
    }

    /// Returns a better unit of time if the last coefficients overflow or underflow in this one.
    #[inline(always)]
    fn better_unit<L: TaylorSeries>(&self, last: &Last<T>, slack: T) -> Option<T> {
        let sum = last.sizes.iter().fold(T::constant(0.0), |sum, size| sum + *size);
        let are_numbers = sum.is_finite() && self.is_finite(self.order());
        // Coefficients that underflow with the length of the last step as unit do not matter in a step ten times as
        // long.
        if are_numbers && (sum > T::constant(0.0) || !is_linear::<L>()) {
            None
        } else {
            self.unit_by_the_highest(!are_numbers, slack)
        }
    }

    /// Time unit that scales the highest finite coefficient to the size of the state, and is at most half of the unit
    /// after an overflow. `None` if all further coefficients are zero because the series is a polynomial, not because
    /// they underflow.
    #[cold]
    fn unit_by_the_highest(&self, are_large: bool, slack: T) -> Option<T> {
        let (scales, order) = (self.scales(slack), self.order());
        let is_number =
            |&(k, size): &(usize, T)| self.is_finite(k) && size.is_finite() && size > T::constant(0.0);
        let (k, size) = (1..=order).rev().map(|k| (k, self.size(k, &scales))).find(is_number)?;
        let rate = log2_roughly(size.to_f64()) / k as f64;
        let rate = if are_large { larger(rate, 1.0) } else { rate };
        let are_small = rate < log2_roughly(T::SMALLEST) / order as f64 + UNDERFLOW;
        (are_large || are_small).then(|| self.unit * T::constant(exp2_roughly(-rate)))
    }

    fn is_finite(&self, order: usize) -> bool {
        [&self.q[order + 1], &self.v[order]].into_iter().flatten().all(|x| x.is_finite())
    }

    /// True if all of the last coefficients are zero.
    pub(crate) fn ends(&self) -> bool {
        let (first, zero) = (self.order() + 1 - LAST, T::constant(0.0));
        let last = [&self.v[first..], &self.q[first..=self.order()]];
        last.into_iter().flatten().flatten().all(|x| *x == zero)
    }
}

/// Factor unit/order of the integration from the order before to this one. A division, not a product with
/// 1/order: the rounding error of 1/order has the same sign in every step, and made the energy drift.
fn unit_over<T: Scalar>(unit: T, order: usize) -> T {
    unit / T::constant(order as f64)
}

#[inline(always)]
fn scaled<T: Scalar, N: StaticLength>(x: &Array<T, N>, factor: T) -> Array<T, N> {
    from_fn(|i| factor * x[i])
}

/// Sums c₀ + c₁ θ + c₂ θ² + …, even and odd powers in parallel: in a single chain, each term waits for the one before.
#[inline(always)]
fn polynomial<T: Scalar, N: StaticLength>(
    coefficients: impl DoubleEndedIterator<Item = Array<T, N>>,
    theta: T,
) -> Array<T, N> {
    let (zero, square) = (Array::filled(T::constant(0.0)), theta * theta);
    let (mut odd, mut even) = (zero, zero);
    for coefficient in coefficients.rev() {
        (odd, even) = (even, horner(&odd, square, &coefficient));
    }
    horner(&odd, theta, &even)
}

#[inline(always)]
fn horner<T: Scalar, N: StaticLength>(sum: &Array<T, N>, theta: T, coefficient: &Array<T, N>) -> Array<T, N> {
    from_fn(|i| sum[i].multiply_add(theta, coefficient[i]))
}

/// Factors of the general solver at a state, for the constraints that are independent there.
pub(crate) struct General<T: Element, N: StaticLength, M: StaticLength> {
    factors: kkt::Factors<T, N, M>,
    active: Array<bool, M>,
    time: f64,
}

impl<T: Real, N: StaticLength, M: StaticLength> General<T, N, M> {
    #[cold]
    pub(crate) fn at<L: Lagrangian<N = N, M = M, Scalar = T>>(
        system: &L,
        state: &State<T, N>,
        active: Array<bool, M>,
    ) -> Result<Self, Error> {
        let zero = T::constant(0.0);
        let (m, mut f): (_, Array<Array<T, N>, M>) =
            (system.mass_matrix(state).into(), rows(&system.constraint_jacobian(state)));
        for a in (0..M::COUNT).filter(|&a| !active[a]) {
            f[a] = Array::filled(zero);
        }
        let (equations, time) =
            (KktSystem { m, h: Array::filled(zero), f, gamma: Array::filled(zero) }, state.t.to_f64());
        if let Some(row) = not_finite::<L>(&equations) {
            return Err(Error::EquationsNotFinite { row, time });
        }
        let factors = kkt::Factors::of(&equations.m, &equations.f, Rank::off_constraints());
        Ok(Self { factors, active, time })
    }

    pub(crate) fn solve<L: Lagrangian<N = N, M = M, Scalar = T>>(
        &self,
        (forcing, bias): &RightHandSides<T, N, M>,
    ) -> Result<Solution<T, N, M>, Error> {
        let bias = from_fn(|a| if self.active[a] { bias[a] } else { T::constant(0.0) });
        let solution = self.factors.solve(&(*forcing).into(), &bias);
        solution.map_err(|found| fault::<L>(&found, self.time))
    }
}

/// True if the equations are linear with constant coefficients, so that there are no products of series: the start of a
/// motion then determines all of it.
pub(super) const fn is_linear<L: TaylorSeries>() -> bool {
    size_of::<L::Sums>() == 0 && L::ARGUMENTS.is_empty()
}

#[cfg(test)]
mod tests {
    use super::MULTIPLE;
    use crate::number::ROOM;

    #[test]
    fn a_multiple_of_all_orders_is_divided_without_rounding() {
        let whole = |x: f64| (x * (1_u64 << 62) as f64) as u128;
        for k in 1..ROOM as u64 {
            assert_eq!(whole(MULTIPLE / k as f64) * u128::from(k), whole(MULTIPLE), "{k}");
        }
    }
}
