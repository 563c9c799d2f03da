//! The trait [`Scheme`]: one step of a method as a map of coordinates and velocities.

use core::fmt::{self, Debug};

use super::settle::NotSettled;
use crate::number::{Parts, Scalar};
use crate::system::{ConstraintKind, Lagrangian, State, StateOf, System};
use crate::vector::{
    Array, Element, Length, Numbers, PhaseVector, StaticLength, Vector, VectorOf, array, is_constant, vector,
};

/// A one-step method, for any number type: a map (q, q̇) → (q, q̇) over a given time.
///
/// The same code maps numbers, and dual numbers to differentiate the map. A type that implements this trait and `Default`
/// is a [`Method`](crate::Method) as [`FixedStep`](super::FixedStep), with dense output, events and derivatives:
///
/// ```
/// use core::fmt;
/// use lagrange_core::StateOf;
/// use lagrange_core::motion::{CompensatedState, FixedStep, NotSettled, Parts, Scheme};
/// use lagrange_core::prelude::*;
/// use lagrange_core::structure::{ConstantMassMatrix, Unconstrained, VelocityFreeForces};
///
/// /// Half a step of the coordinates, a step of the velocities, half a step of the coordinates.
/// #[derive(Clone, Copy, Debug, Default)]
/// struct DriftKickDrift;
///
/// impl<L> Scheme<L> for DriftKickDrift
/// where
///     L: Lagrangian<Scalar: Parts> + ConstantMassMatrix + VelocityFreeForces + Unconstrained,
/// {
///     type Carried = ();
///     const ORDER: usize = 2;
///
///     fn identify(to: &mut dyn fmt::Write) -> fmt::Result {
///         to.write_str("drift, kick, drift")
///     }
///
///     fn start(_: &L, _: &StateOf<L>) {}
///
///     fn advance(
///         system: &L,
///         point: &mut CompensatedState<L::Scalar, L::N>,
///         _: &mut (),
///         (h, to): (L::Scalar, L::Scalar),
///     ) -> Result<usize, NotSettled> {
///         let half = L::Scalar::constant(0.5) * h;
///         point.set_time(point.state().t + half);
///         point.change_coordinates(|state, i| half * state.v[i]);
///         let forces = system.accelerations_unchecked(point.state());
///         point.change_velocities(|_, i| h * forces.accelerations[i]);
///         point.change_coordinates(|state, i| half * state.v[i]);
///         point.set_time(to);
///         Ok(1)
///     }
/// }
///
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(x_dot^2/2 - x^2/2)]
/// struct Spring;
///
/// let method = FixedStep::<DriftKickDrift>::with_step(0.01);
/// let path = Spring.integrate(State::at_rest([1.0]), 10.0, method)?;
/// assert!((path.end().coordinate("x")? - 10.0_f64.cos()).abs() < 1e-4);
/// # Ok::<(), Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a scheme for the steps of `{L}`",
    note = "`Verlet`, `Gauss`, `Lobatto` and `DAlembert` are methods with steps of one length; `FixedStep` takes the scheme of one of them"
)]
pub trait Scheme<L: System<Scalar: Parts>> {
    /// Data carried from the end of a step to the start of the next one.
    type Carried: Clone + Debug + Send + Sync;

    /// Order of the method.
    const ORDER: usize;

    /// Name of the method, with its number of stages.
    ///
    /// # Errors
    /// Those of writing to `to`.
    fn identify(to: &mut dyn fmt::Write) -> fmt::Result;

    /// Evaluates what a step needs at its start.
    fn start(system: &L, state: &StateOf<L>) -> Self::Carried;

    /// Like [`start`](Self::start), with an initial guess for the iteration of the next step from `before`, the data that the
    /// step to this state left. Where the equations of a long step have several solutions, the guess decides between them.
    #[allow(unused_variables)]
    fn start_after(system: &L, state: &StateOf<L>, before: &Self::Carried) -> Self::Carried {
        Self::start(system, state)
    }

    /// Moves a point by a step (h, t) of length h to the time t. The time is rounded; the length is the given one. Returns the
    /// number of evaluations of the forces. After an error, the point and the data are undefined.
    ///
    /// # Errors
    /// If an iteration does not converge.
    fn advance(
        system: &L,
        point: &mut CompensatedState<L::Scalar, L::Length>,
        carried: &mut Self::Carried,
        step: (L::Scalar, L::Scalar),
    ) -> Result<usize, NotSettled>;

    /// Returns the accelerations at the end of a step, for its dense output. `None` if the data that the step left there
    /// do not give them without another evaluation of the forces.
    #[allow(unused_variables)]
    fn accelerations(
        system: &L,
        end: &StateOf<L>,
        carried: &Self::Carried,
    ) -> Option<VectorOf<L::Scalar, L::Length>> {
        None
    }
}

/// A scheme of order 2 that is its own inverse with the step −h, so that [compositions](super::Composition) of its steps are
/// of higher order.
#[diagnostic::on_unimplemented(
    message = "steps of `{Self}` are not composed",
    label = "`Verlet` and `DAlembert` are composed",
    note = "`Gauss` and `Lobatto` are of higher order with more stages: `Gauss::<4>`, `Lobatto::<4>`"
)]
pub trait SymmetricScheme {}

/// Coordinates or velocities, and their rounding errors.
pub(super) type Compensated<T, N> = [Array<T, N>; 2];

/// A state, and the rounding errors of its coordinates and velocities: sums of many small changes keep the digits that
/// rounding would take from each (compensated summation).
#[derive(Clone, Debug)]
pub struct CompensatedState<T: Element, N: Length> {
    pub(crate) state: State<T, N>,
    rest: PhaseVector<T, N>,
}

impl<T: Element, N: Length> Copy for CompensatedState<T, N>
where
    State<T, N>: Copy,
    PhaseVector<T, N>: Copy,
{
}

impl<T: Parts, N: Length> CompensatedState<T, N> {
    pub(crate) fn at(state: &State<T, N>) -> Self {
        let mut rest = PhaseVector::joined(&state.q, &state.v);
        rest.flat_mut().fill(T::constant(0.0));
        Self { state: state.clone(), rest }
    }

    /// The state, rounded.
    pub fn state(&self) -> &State<T, N> {
        &self.state
    }

    /// Sets the time, and leaves coordinates and velocities as they are.
    pub fn set_time(&mut self, t: T) {
        self.state.t = t;
    }

    /// Adds a change to each coordinate in place, from its velocity and its acceleration.
    #[inline(always)]
    pub(super) fn move_by(&mut self, accelerations: &[T], change: impl Fn(T, T) -> T) {
        let Self { state: State { q, v, .. }, rest } = self;
        add::<T, N>(q.entries_mut(), &mut rest[0], [v.entries(), accelerations], change);
    }

    /// Adds a change to each velocity in place, from the accelerations at both ends.
    #[inline(always)]
    pub(super) fn push_by(&mut self, ends: [&[T]; 2], change: impl Fn(T, T) -> T) {
        let Self { state: State { v, .. }, rest } = self;
        add::<T, N>(v.entries_mut(), &mut rest[1], ends, change);
    }
}

impl<T: Parts, N: StaticLength> CompensatedState<T, N> {
    /// Adds to each coordinate its change, from the state before and the index.
    pub fn change_coordinates(&mut self, change: impl Fn(&State<T, N>, usize) -> T) {
        let [q, rest] = self.moved(&Array::from_fn(|i| change(&self.state, i)));
        self.state.q = vector(q);
        self.rest.set(0, rest);
    }

    /// Adds to each velocity its change, from the state before and the index.
    pub fn change_velocities(&mut self, change: impl Fn(&State<T, N>, usize) -> T) {
        let [v, rest] = self.pushed(&Array::from_fn(|i| change(&self.state, i)));
        self.state.v = vector(v);
        self.rest.set(1, rest);
    }

    /// Adds a change to the coordinates, and returns them with their rounding errors.
    pub(super) fn moved(&self, change: &Array<T, N>) -> Compensated<T, N> {
        summed(&self.state.q, change, &self.rest.half(0))
    }

    /// Adds a change to the velocities, and returns them with their rounding errors.
    pub(super) fn pushed(&self, change: &Array<T, N>) -> Compensated<T, N> {
        summed(&self.state.v, change, &self.rest.half(1))
    }

    /// Sets the point, from coordinates and velocities with their rounding errors.
    pub(super) fn set(&mut self, t: T, [q, rest_q]: Compensated<T, N>, [v, rest_v]: Compensated<T, N>) {
        self.state = State { t, q: vector(q), v: vector(v) };
        self.rest = PhaseVector::new([rest_q, rest_v]);
    }
}

/// Adds to each x the change that two known numbers make. `rest` has the rounding errors of x.
#[inline(always)]
fn add<T: Parts, N: Length>(x: &mut [T], rest: &mut [T], known: [&[T]; 2], change: impl Fn(T, T) -> T) {
    match const { is_constant::<N>() } {
        true => add_here(x, rest, known, change),
        false => add_apart(x, rest, known, change),
    }
}

/// [`add_here`] as a function of its own, from whose arguments the compiler knows that `x` and `rest` do not overlap the others.
#[inline(never)]
fn add_apart<T: Parts>(x: &mut [T], rest: &mut [T], [one, other]: [&[T]; 2], change: impl Fn(T, T) -> T) {
    add_here(x, rest, [one, other], change);
}

#[inline(always)]
fn add_here<T: Parts>(x: &mut [T], rest: &mut [T], [one, other]: [&[T]; 2], change: impl Fn(T, T) -> T) {
    for ((x, rest), (one, other)) in x.iter_mut().zip(rest).zip(one.iter().zip(other)) {
        [*x, *rest] = compensated_sum(*x, change(*one, *other) + *rest);
    }
}

/// Returns x + y and its rounding error, exactly if y is the smaller of the two (Kahan, *Communications of the ACM* 8, 1965, 40; Hairer,
/// Lubich and Wanner, *Geometric Numerical Integration*, VIII.5). The change y of a coordinate x
/// exceeds x near its zero: the error is then off by the round-off of y.
#[inline(always)]
fn compensated_sum<T: Parts>(x: T, y: T) -> [T; 2] {
    let sum = x + y;
    [sum, y - (sum - x)]
}

/// Compensated sum: x + change + rest, and its rounding error.
#[inline(always)]
fn summed<T: Parts, N: StaticLength>(
    x: &Vector<T, N>,
    change: &Array<T, N>,
    rest: &Array<T, N>,
) -> Compensated<T, N> {
    let [mut sums, mut errors] = [*change, *rest];
    for i in 0..N::COUNT {
        [sums[i], errors[i]] = compensated_sum(x[i], change[i] + rest[i]);
    }
    [sums, errors]
}

/// Returns Σₖ `weights`ₖ `terms`ₖ.
#[inline]
pub(super) fn combined<T: Parts, N: StaticLength, const S: usize>(
    weights: &[f64; S],
    terms: &[Array<T, N>; S],
) -> Array<T, N> {
    let mut sum = Array::filled(T::constant(0.0));
    for (weight, term) in weights.iter().zip(terms).filter(|(weight, _)| **weight != 0.0) {
        for i in 0..N::COUNT {
            sum[i] = T::constant(*weight).multiply_add(term[i], sum[i]);
        }
    }
    sum
}

/// Returns the magnitude of each entry.
#[inline]
pub(super) fn magnitudes<T: Parts, K: StaticLength>(x: &Vector<T, K>) -> Array<T, K> {
    Array::from_fn(|k| x[k].magnitude())
}

/// Magnitudes of the terms of Φ; of a constraint on velocities, those of a displacement, Σᵢ |Fₐᵢ qᵢ|.
#[inline]
pub(super) fn terms_of_positions<L: Lagrangian<Scalar: Parts>>(
    system: &L,
    state: &StateOf<L>,
) -> Array<L::Scalar, L::M> {
    let is_displacement =
        |a: usize| <L::Scalar as Parts>::HAS_SLOPES || L::CONSTRAINT_KINDS[a] == ConstraintKind::Velocity;
    let mut magnitudes = array(system.residual_magnitude(state));
    if (0..<L::M>::COUNT).any(is_displacement) {
        let displacements = terms(system, state, &state.q);
        (0..<L::M>::COUNT).filter(|a| is_displacement(*a)).for_each(|a| magnitudes[a] = displacements[a]);
    }
    magnitudes
}

/// Magnitudes of the terms of F q̇ + b, Σᵢ |Fₐᵢ q̇ᵢ|.
#[inline]
pub(super) fn terms_of_rates<L: Lagrangian<Scalar: Parts>>(
    system: &L,
    state: &StateOf<L>,
) -> Array<L::Scalar, L::M> {
    match const { <L::Scalar as Parts>::HAS_SLOPES } {
        false => array(system.rate_magnitude(state)),
        true => terms(system, state, &state.v),
    }
}

/// Σᵢ |Fₐᵢ||xᵢ|, with the slope |F||x'| + |F'||x|, where ' is the derivative: a bound, because in the derivative of the sum
/// slopes could cancel.
fn terms<L: Lagrangian<Scalar: Parts>>(
    system: &L,
    state: &StateOf<L>,
    x: &Vector<L::Scalar, L::N>,
) -> Array<L::Scalar, L::M> {
    let f = system.constraint_jacobian(state);
    let term = |a: usize, i: usize| f[(a, i)].magnitude() * x[i].magnitude();
    Array::from_fn(|a| (0..<L::N>::COUNT).fold(L::Scalar::constant(0.0), |sum, i| sum + term(a, i)))
}
