//! A system in discrete time: its motion over an interval with held inputs, as a map with derivatives.

mod second;

use alloc::vec::Vec;
use core::fmt::{self, Debug, Formatter};

use nalgebra::DMatrix;

use super::Linearized;
use super::argument::check_parameters;
use super::variation::{DifferentiableMethod, Variations, VariedRun};
use crate::derivatives::tangent::Tangent;
use crate::error::{Ending, Error};
use crate::motion::run::{Observer, Run, Watchdog, check_end};
use crate::names::Entry;
use crate::number::{Real, Scalar};
use crate::system::finite::check_finite;
use crate::system::{StateOf, check_contacts, entry, lookup, unit};
use crate::vector::{Array, StaticLength, vector};

/// A system in discrete time, x⁺ = f(x, u): the motion from a state x = (q, q̇) over an interval in which the inputs u
/// are held, with the derivatives A = ∂f/∂x and B = ∂f/∂u.
///
/// Optimisers of trajectories (iLQR, sequential quadratic programming, model predictive control) and Kalman filters ask
/// for this at every tick. Inputs are parameters, as in [`linearize`](Linearized::linearize).
///
/// A and B are the derivatives of the steps that the method takes. For [`RungeKutta4`](crate::RungeKutta4) they are those
/// of the map f that it computes, to round-off; for [`Dop853`](crate::Dop853) and other methods that choose their steps, at
/// the lengths chosen. The result depends on the system, the state and the end alone, not on earlier intervals.
///
/// With constraints, f projects its argument onto them first: the columns of A are the images of the projected unit
/// vectors, and lie in the tangent space at x⁺.
///
/// Memory is allocated by [`new`](Self::new) and by the first interval. Without constraints,
/// [`RungeKutta4`](crate::RungeKutta4) allocates nothing after that.
///
/// ```
/// use lagrange_core::{linearized::DiscreteTime, prelude::*};
///
/// #[derive(Lagrangian)]
/// #[coordinates(x)]
/// #[lagrangian(m/2 * x_dot^2)]
/// #[force(x: push)]
/// struct Cart { m: f64, push: f64 }
///
/// let cart = Cart { m: 2.0, push: 0.0 };
/// let mut cart = DiscreteTime::new(cart, RungeKutta4::with_step(0.1), &["push"])?;
/// let mut state = State::new([1.0], [0.0]);
/// for tick in 1..=60 {
///     cart.system_mut().push = -3.0 * state.q[0] - 4.0 * state.v[0];
///     cart.advance(&state, 0.1 * f64::from(tick))?;
///     state = *cart.state();
///     // x⁺ = x + ẋ h + push h²/2m, ẋ⁺ = ẋ + push h/m
///     let h = 0.1;
///     assert!((cart.a()[(0, 1)] - h).abs() < 1e-15 && (cart.b()[(0, 0)] - h * h / 4.0).abs() < 1e-15);
/// }
/// assert!(state.q[0].abs() < 0.1);
/// # Ok::<(), Error>(())
/// ```
pub struct DiscreteTime<L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>> {
    system: L,
    method: D,
    variations: Variations<L>,
    memory: Option<D::VariationMemory>,
    state: StateOf<L>,
    a: DMatrix<L::Scalar>,
    b: DMatrix<L::Scalar>,
}

impl<L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>> DiscreteTime<L, D> {
    /// A system in discrete time, whose motion is integrated by this method. The inputs are the parameters of these names (`u`
    /// stands for all elements of a vector `u: [f64; 3]`).
    ///
    /// # Errors
    /// [`Error::UnknownName`] and [`Error::RepeatedName`]; [`Error::Setting`] for a setting of the method that is not
    /// allowed.
    pub fn new(system: L, method: D, inputs: &[&str]) -> Result<Self, Error> {
        const {
            check_contacts(L::HAS_CONTACTS);
            check_parameters::<L>();
        };
        method.check()?;
        let inputs = lookup::indices::<L>(L::PARAMETERS, "parameter", inputs)?;
        let size = 2 * <L::N>::COUNT;
        let mut arguments: Vec<Entry> = (0..size).map(entry::<L>).collect();
        arguments.extend(inputs.iter().map(|&k| Entry::Parameter(L::PARAMETERS[k])));
        let none = vector(Array::filled(L::Scalar::constant(f64::NAN)));
        Ok(Self {
            variations: Variations::none(&system, arguments),
            memory: None,
            state: StateOf::<L> { t: L::Scalar::constant(f64::NAN), q: none, v: none },
            a: DMatrix::zeros(size, size),
            b: DMatrix::zeros(size, inputs.len()),
            system,
            method,
        })
    }

    /// The system with its current parameters.
    pub fn system(&self) -> &L {
        &self.system
    }

    /// The system, to set its inputs for the next interval.
    pub fn system_mut(&mut self) -> &mut L {
        &mut self.system
    }

    /// Integrates from a state to the time `end`, and computes the derivatives of the state there. After an error, the
    /// state and the derivatives are those of the last interval that succeeded.
    ///
    /// # Errors
    /// The errors of [`integrate`](crate::Simulate::integrate), among them [`Error::Unfinished`];
    /// [`Error::DerivativeNotFinite`].
    pub fn advance(&mut self, state: &StateOf<L>, end: L::Scalar) -> Result<(), Error> {
        check_finite(&self.system, state)?;
        check_end(end)?;
        let (mut run, _) = Run::<L, D>::begin(&self.system, state, &self.method)?;
        self.restart(&mut run)?;
        let limits = Watchdog::new(self.method.limits(), &run.statistics);
        let Self { system, method, variations, memory, .. } = self;
        if let Some(memory) = memory {
            run.drive(method, &limits, &mut HeldInputs { system, end, variations, memory })?;
        }
        self.keep(&run.state);
        Ok(())
    }

    /// State x⁺ at the end of the last interval; NaN before the first.
    pub fn state(&self) -> &StateOf<L> {
        &self.state
    }

    /// A = ∂x⁺/∂x over the last interval. Rows and columns are coordinates, then velocities.
    pub fn a(&self) -> &DMatrix<L::Scalar> {
        &self.a
    }

    /// B = ∂x⁺/∂u over the last interval, one column for each input.
    pub fn b(&self) -> &DMatrix<L::Scalar> {
        &self.b
    }

    /// Puts the variations at the start of an interval: along each entry of the state, and by each input.
    fn restart(&mut self, run: &mut Run<L, D>) -> Result<(), Error> {
        let Self { system, method, variations, memory, .. } = self;
        let size = <L::N>::COUNT;
        // A column of a parameter is zero: its index is that of no entry.
        let column = |j: usize| [unit(j), unit(j.wrapping_sub(size))];
        variations.restart(&Tangent::at(system, &run.state)?, column)?;
        match memory {
            Some(memory) => method.restart(VariedRun { system, run, variations, memory })?,
            None => *memory = Some(method.companion(system, &run.state, variations)?),
        }
        Ok(())
    }

    /// Keeps the end of an interval.
    fn keep(&mut self, end: &StateOf<L>) {
        let Self { variations, state, a, b, .. } = self;
        *state = *end;
        let size = 2 * <L::N>::COUNT;
        (0..size).for_each(|j| (0..size).for_each(|i| a[(i, j)] = variations.entry(j, i)));
        (0..b.ncols()).for_each(|j| (0..size).for_each(|i| b[(i, j)] = variations.entry(size + j, i)));
    }
}

impl<L, D> Debug for DiscreteTime<L, D>
where
    L: Linearized<Scalar: Real> + Debug,
    D: DifferentiableMethod<L> + Debug,
{
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { system, method, state, a, b, .. } = self;
        let mut discrete = f.debug_struct("DiscreteTime");
        discrete
            .field("system", system)
            .field("method", method)
            .field("inputs", &&self.variations.arguments()[a.ncols()..]);
        discrete.field("state", state).field("a", a).field("b", b).finish_non_exhaustive()
    }
}

/// Observer that carries the variations to the end of an interval.
struct HeldInputs<'m, L: Linearized<Scalar: Real>, D: DifferentiableMethod<L>> {
    system: &'m L,
    end: L::Scalar,
    variations: &'m mut Variations<L>,
    memory: &'m mut D::VariationMemory,
}

impl<L, D> Observer<L, D> for HeldInputs<'_, L, D>
where
    L: Linearized<Scalar: Real>,
    D: DifferentiableMethod<L>,
{
    fn system(&self) -> &L {
        self.system
    }

    fn goal(&mut self, method: &D, run: &mut Run<L, D>) -> Result<Option<L::Scalar>, Ending> {
        if run.state.t == self.end {
            return Ok(None);
        }
        let Self { system, variations, memory, .. } = self;
        method.prepare(VariedRun { system, run, variations, memory }, self.end)?;
        Ok(Some(self.end))
    }

    fn follow(&mut self, method: &D, run: &mut Run<L, D>) -> Result<(), Ending> {
        let Self { system, variations, memory, .. } = self;
        method.follow(VariedRun { system, run, variations, memory })
    }
}
