//! Second derivatives of the map of an interval, over dual numbers of dual numbers.

use alloc::vec::Vec;

use nalgebra::{ComplexField, DMatrix};

use super::DiscreteTime;
use crate::derivatives::tangent::WideOf;
use crate::derivatives::tangent::parameter;
use crate::error::{Ending, Error};
use crate::linearized::Linearized;
use crate::linearized::argument::set_parameter;
use crate::motion::run::{Observer, Run, Watchdog, check_end};
use crate::motion::{Method, RungeKutta4, runge_kutta_step};
use crate::names::Row;
use crate::number::{Broadcast, Dual, Real, Scalar, Wide};
use crate::system::finite::check_finite;
use crate::system::{Pack, State, StateOf};
use crate::vector::{StaticLength, Vector, from_fn, vector};

/// Numbers with first and second derivatives: by one argument in all lanes, and by one argument in each lane.
type SecondDuals<L> = Dual<Dual<WideOf<L>>>;
/// The system over these numbers.
type PackedSecondDuals<L> = <L as Pack<SecondDuals<L>>>::Packed;

impl<L> DiscreteTime<L, RungeKutta4>
where
    L: Linearized<Scalar: Real> + Pack<SecondDuals<L>>,
    PackedSecondDuals<L>: Linearized<N = L::N, M = L::M, P = L::P, Scalar = SecondDuals<L>>,
{
    /// Second derivatives of wᵀx⁺ by the entries of x, then the inputs: the symmetric matrix Σ wᵢ ∂²fᵢ/∂(x, u)² that
    /// Newton-type optimisers add (differential dynamic programming). `weights` are those of the coordinates and of the
    /// velocities.
    ///
    /// The steps are taken over dual numbers of dual numbers, once for each argument and vector of lanes. The number type
    /// of the system must be a type parameter. A system with constraints does not compile.
    ///
    /// ```
    /// use lagrange_core::{linearized::DiscreteTime, prelude::*};
    ///
    /// #[derive(Lagrangian)]
    /// #[coordinates(theta)]
    /// #[lagrangian(l^2/2 * theta_dot^2 + g*l*cos(theta))]
    /// struct Pendulum<T> { l: T, g: T }
    ///
    /// let pendulum = Pendulum { l: 1.0, g: 9.81 };
    /// let discrete = DiscreteTime::new(pendulum, RungeKutta4::with_step(1e-4), &["l"])?;
    /// let weights = [[0.0].into(), [1.0].into()];
    /// let second = discrete.second_derivatives(&State::at_rest([0.5]), 1e-4, &weights)?;
    /// // θ̇⁺ = −g/l sin θ h, for small h
    /// assert!((second[(0, 0)] / 1e-4 - 9.81 * 0.5_f64.sin()).abs() < 1e-6);
    /// assert!((second[(0, 2)] / 1e-4 - 9.81 * 0.5_f64.cos()).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::ParameterFixed`]; [`Error::DerivativeNotFinite`]; the errors of [`advance`](Self::advance).
    pub fn second_derivatives(
        &self,
        state: &StateOf<L>,
        end: L::Scalar,
        weights: &[Vector<L::Scalar, L::N>; 2],
    ) -> Result<DMatrix<L::Scalar>, Error> {
        const { assert!(<L::M>::COUNT == 0, "second derivatives are those of systems without constraints") };
        check_finite(&self.system, state)?;
        check_end(end)?;
        let (mut run, _) = Run::<L, RungeKutta4>::begin(&self.system, state, &self.method)?;
        let limits = Watchdog::new(Method::<L>::limits(&self.method), &run.statistics);
        let mut sweeps = Sweeps { system: &self.system, end, all: self.sweeps(&run.state)? };
        run.drive(&self.method, &limits, &mut sweeps)?;
        self.combined(&sweeps.all, weights, run.before.t)
    }

    /// Motions over dual numbers of dual numbers that begin at a state: all lanes along the first argument, then all along the
    /// second, …
    fn sweeps(&self, start: &StateOf<L>) -> Result<Vec<Sweep<L>>, Error> {
        let arguments = self.variations.arguments();
        let blocks = arguments.len().div_ceil(WideOf::<L>::COUNT);
        (0..arguments.len() * blocks)
            .map(|k| self.sweep(start, k / blocks, WideOf::<L>::COUNT * (k % blocks)))
            .collect()
    }

    /// The motion along argument `outer` and, in lane k, argument `first` + k.
    fn sweep(&self, start: &StateOf<L>, outer: usize, first: usize) -> Result<Sweep<L>, Error> {
        let at = |value: L::Scalar, index: usize| seed::<L>(value, index, outer, first);
        let size = 2 * <L::N>::COUNT;
        let state = State {
            t: at(start.t, usize::MAX),
            q: vector(from_fn(|i| at(start.q[i], i))),
            v: vector(from_fn(|i| at(start.v[i], <L::N>::COUNT + i))),
        };
        let (mut system, values) = (self.system.pack(), self.system.parameters());
        for (index, argument) in self.variations.arguments().iter().enumerate().skip(size) {
            let Some(k) = parameter::<L>(*argument) else { continue };
            set_parameter(&mut system, k, at(values[k], index))?;
        }
        Ok(Sweep { system, state })
    }

    /// Second derivatives of the weighted sum of the entries of the state that the sweeps have reached.
    fn combined(
        &self,
        sweeps: &[Sweep<L>],
        weights: &[Vector<L::Scalar, L::N>; 2],
        time: L::Scalar,
    ) -> Result<DMatrix<L::Scalar>, Error> {
        let (arguments, lanes) = (self.variations.arguments(), WideOf::<L>::COUNT);
        let (count, blocks) = (arguments.len(), arguments.len().div_ceil(WideOf::<L>::COUNT));
        let mut second = DMatrix::zeros(count, count);
        for (j, k) in (0..count).flat_map(|j| (0..count).map(move |k| (j, k))) {
            let State { q, v, .. } = &sweeps[blocks * j + k / lanes].state;
            for i in 0..<L::N>::COUNT {
                let [of_q, of_v] = [q, v].map(|x| x[i].slope.slope.lane(k % lanes));
                if !(of_q.is_finite() && of_v.is_finite()) {
                    let row = Row::Coordinate(L::COORDINATES[i]);
                    return Err(Error::DerivativeNotFinite { row, entry: arguments[j], time: time.to_f64() });
                }
                second[(j, k)] += weights[0][i] * of_q + weights[1][i] * of_v;
            }
        }
        Ok(second)
    }
}

/// A number that is argument `index`, with slope 1 where the sweep is along this argument.
fn seed<L: Linearized<Scalar: Real>>(
    value: L::Scalar,
    index: usize,
    outer: usize,
    first: usize,
) -> SecondDuals<L> {
    let unit = |is_along: bool| L::Scalar::constant(if is_along { 1.0 } else { 0.0 });
    let mut inner = WideOf::<L>::constant(0.0);
    if let Some(lane) = index.checked_sub(first).filter(|lane| *lane < WideOf::<L>::COUNT) {
        inner.put(lane, unit(true));
    }
    Dual {
        value: Dual { value: WideOf::<L>::of(value), slope: inner },
        slope: Dual { value: WideOf::<L>::of(unit(index == outer)), slope: WideOf::<L>::constant(0.0) },
    }
}

/// A motion over dual numbers of dual numbers.
struct Sweep<L: Linearized<Scalar: Real> + Pack<SecondDuals<L>>> {
    system: PackedSecondDuals<L>,
    state: State<SecondDuals<L>, L::N>,
}

/// Observer that takes the steps of a motion in all sweeps.
struct Sweeps<'m, L: Linearized<Scalar: Real> + Pack<SecondDuals<L>>> {
    system: &'m L,
    end: L::Scalar,
    all: Vec<Sweep<L>>,
}

impl<L> Observer<L, RungeKutta4> for Sweeps<'_, L>
where
    L: Linearized<Scalar: Real> + Pack<SecondDuals<L>>,
    PackedSecondDuals<L>: Linearized<N = L::N, M = L::M, P = L::P, Scalar = SecondDuals<L>>,
{
    fn system(&self) -> &L {
        self.system
    }

    fn goal(&mut self, _: &RungeKutta4, run: &mut Run<L, RungeKutta4>) -> Result<Option<L::Scalar>, Ending> {
        Ok((run.state.t != self.end).then_some(self.end))
    }

    fn keep(&mut self, _: &RungeKutta4, run: &mut Run<L, RungeKutta4>) -> Result<(), Ending> {
        let constant = |x: L::Scalar| seed::<L>(x, usize::MAX, 0, 0);
        for Sweep { system, state } in &mut self.all {
            state.t = constant(run.before.t);
            *state = runge_kutta_step(system, state, constant(run.state.t - run.before.t));
        }
        Ok(())
    }
}
