//! The Legendre transform on the constraint manifold: from momenta to velocities.
//!
//! The unknown is v with F v + b = 0 and p(q, v) − p = Fᵀμ for some μ: momenta that differ by a part along the
//! constraints belong to the same motion. Newton's step (δ, μ) solves M δ − Fᵀμ = p − p(q, v), F δ = −(F v +
//! b), the linear system of the dynamics with other right-hand sides. So M may be singular if the constraints
//! make the system regular. If L is quadratic in the velocities, one step is exact.

use super::phase::PhaseState;
use crate::error::Error;
use crate::names::name;
use crate::number::{Real, Scalar, beyond_round_off, exceeds, is_within, power_of_epsilon};
use crate::numerics::newton::{self, Left, Search, halvings};
use crate::solution::kkt::{self, Fault, KktSystem, Rank, Units};
use crate::solution::pivot::is_trustworthy;
use crate::solution::solve::{fault, not_finite};
use crate::system::{Lagrangian, SolutionOf, State, StateOf};
use crate::vector::{Array, Element, Entrywise, StaticLength, from_fn, vector};

/// Returns the state with these momenta. The velocity is sought from `guess` on the constraints `active`; for
/// `None` an independent set is chosen.
pub(crate) fn invert<L: Lagrangian<Scalar: Real>>(
    system: &L,
    phase: &PhaseState<L::Scalar, L::N>,
    guess: &Array<L::Scalar, L::N>,
    active: Option<&Array<bool, L::M>>,
) -> Result<StateOf<L>, Error> {
    let inversion = Inversion { system, phase, active: active.copied().unwrap_or(Array::filled(true)) };
    let state = State { t: phase.t, q: phase.q, v: vector(*guess) };
    match inversion.at_once(state) {
        Some(state) => Ok(state),
        None => inversion.by_steps(state),
    }
}

struct Inversion<'a, L: Lagrangian> {
    system: &'a L,
    phase: &'a PhaseState<L::Scalar, L::N>,
    active: Array<bool, L::M>,
}

/// Trial velocity with its residual.
struct VelocityTrial<T: Element, N: StaticLength, M: StaticLength> {
    state: State<T, N>,
    /// Multipliers μ.
    multipliers: Array<T, M>,
    /// Momenta p(q, v).
    momentum: Array<T, N>,
    /// F v + b of the active constraints.
    rate: Array<T, M>,
}

/// Linear system of Newton's step at a trial, and the units in which its rows are compared.
struct Linear<'a, T: Element, N: StaticLength, M: StaticLength> {
    wanted: &'a PhaseState<T, N>,
    equations: KktSystem<T, N, M>,
    units: Units<T, N, M>,
}

impl<T: Real, N: StaticLength, M: StaticLength> Linear<'_, T, N, M> {
    /// Returns p(q, v) − p − Fᵀμ, and the sum of the magnitudes of its terms.
    fn momentum_residual(&self, trial: &VelocityTrial<T, N, M>, i: usize) -> (T, T) {
        let (given, wanted) = (trial.momentum[i], self.wanted.p[i]);
        let inertia = (0..N::COUNT).map(|j| self.equations.m[i][j] * trial.state.v[j]);
        let terms = inertia.fold(Scalar::abs(given) + Scalar::abs(wanted), |sum, x| sum + Scalar::abs(x));
        (0..M::COUNT).fold((given - wanted, terms), |(residual, terms), a| {
            let along = self.equations.f[a][i] * trial.multipliers[a];
            (residual - along, terms + Scalar::abs(along))
        })
    }

    /// Returns the distance from the solution, in natural units of the dynamics, and the magnitude of its
    /// terms. A residual within the round-off of its terms counts as zero, so that it does not hide another
    /// row.
    fn distance(&self, trial: &VelocityTrial<T, N, M>) -> (T, T) {
        let momenta = (0..N::COUNT).map(|i| {
            let (residual, terms) = self.momentum_residual(trial, i);
            (residual * self.units.coordinates[i], terms * self.units.coordinates[i])
        });
        let rates = (0..M::COUNT).map(|a| {
            let row = &self.equations.f[a];
            let terms =
                (0..N::COUNT).fold(T::constant(0.0), |sum, i| sum + Scalar::abs(row[i] * trial.state.v[i]));
            (self.units.of_row(a, trial.rate[a]), self.units.of_row(a, terms))
        });
        let zero = T::constant(0.0);
        momenta.chain(rates).fold((zero, zero), |(distance, size), (residual, terms)| {
            let left = beyond_round_off(residual, terms);
            (if exceeds(left, zero) { distance + left } else { distance }, size + terms)
        })
    }
}

impl<L: Lagrangian<Scalar: Real>> Inversion<'_, L> {
    /// Inverts momenta that are linear in the velocities by one linear solve, and by a second one if the
    /// first lost a digit.
    #[inline]
    fn at_once(&self, mut state: StateOf<L>) -> Option<StateOf<L>> {
        if !L::MOMENTA_ARE_LINEAR || self.active.contains(&false) {
            return None;
        }
        let factor = self.system.factor(&state);
        for _ in 0..2 {
            let missing = self.phase.p.minus(&self.system.momentum(&state));
            let rate = self.system.constraint_rate(&state);
            let correction = self.system.solve_with(&factor, &missing, &rate);
            if !is_trustworthy(&correction) {
                return None;
            }
            state.v += correction.accelerations;
            if correction.pivot > L::Scalar::constant(0.1) {
                break;
            }
        }
        Some(state)
    }

    /// Takes Newton steps until they converge. Not inlined, because its matrices are large.
    #[inline(never)]
    fn by_steps(mut self, state: StateOf<L>) -> Result<StateOf<L>, Error> {
        let start = self.trial(state, Array::filled(L::Scalar::constant(0.0)));
        newton::find(&mut self, start).map(|(found, _)| found.state)
    }

    fn trial(
        &self,
        state: StateOf<L>,
        multipliers: Array<L::Scalar, L::M>,
    ) -> VelocityTrial<L::Scalar, L::N, L::M> {
        let rate = self.system.constraint_rate(&state);
        VelocityTrial {
            momentum: self.system.momentum(&state).into(),
            rate: from_fn(|a| if self.active[a] { rate[a] } else { L::Scalar::constant(0.0) }),
            state,
            multipliers,
        }
    }

    /// Newton's step from a state: change of the velocity, and the new multipliers μ.
    fn step(
        &self,
        state: &StateOf<L>,
        equations: &KktSystem<L::Scalar, L::N, L::M>,
    ) -> Result<SolutionOf<L>, Error> {
        if !self.active.contains(&false) {
            let (h, gamma) = (vector(equations.h), vector(equations.gamma));
            let fast = self.system.solve_with(&self.system.factor(state), &h, &gamma);
            if is_trustworthy(&fast) {
                return Ok(fast);
            }
        }
        // Near the solution, dependent constraints disagree by round-off, which must not count as a
        // contradiction.
        let solved = kkt::solve(equations, Rank::off_constraints()).map(|(solution, _)| solution);
        solved.map_err(|found| self.fault(&found))
    }

    fn fault(&self, found: &Fault<L::Scalar, L::N>) -> Error {
        match fault::<L>(found, self.phase.t.to_f64()) {
            Error::Singular { coordinates, time } => Error::VelocityUndetermined { coordinates, time },
            other => other,
        }
    }
}

impl<'a, L: Lagrangian<Scalar: Real>> Search for Inversion<'a, L> {
    type Scalar = L::Scalar;
    type Error = Error;
    type Trial = VelocityTrial<L::Scalar, L::N, L::M>;
    type Linear = Linear<'a, L::Scalar, L::N, L::M>;

    fn linearize(&mut self, trial: &Self::Trial) -> Result<Self::Linear, Error> {
        let zero = L::Scalar::constant(0.0);
        let jacobian = self.system.constraint_jacobian(&trial.state);
        let equations = KktSystem {
            m: self.system.mass_matrix(&trial.state).into(),
            h: from_fn(|i| self.phase.p[i] - trial.momentum[i]),
            f: from_fn(|a| from_fn(|i| if self.active[a] { jacobian[(a, i)] } else { zero })),
            gamma: trial.rate,
        };
        if let Some(row) = not_finite::<L>(&equations) {
            return Err(Error::EquationsNotFinite { row, time: self.phase.t.to_f64() });
        }
        let units = Units::of(&equations.m, &equations.f);
        Ok(Linear { wanted: self.phase, equations, units })
    }

    fn left(&self, near: &Self::Linear, trial: &Self::Trial) -> Left<L::Scalar> {
        let (distance, size) = near.distance(trial);
        let is_rounded = distance == L::Scalar::constant(0.0);
        let is_negligible = is_rounded || is_within(distance, power_of_epsilon::<L::Scalar>(0.75) * size);
        Left { distance, is_rounded, is_negligible }
    }

    fn corrected(
        &self,
        linear: &Self::Linear,
        from: &Self::Trial,
        converged: bool,
    ) -> Result<impl Iterator<Item = Self::Trial>, Error> {
        let step = self.step(&from.state, &linear.equations)?;
        Ok(halvings(converged).map(move |part| {
            let v = from.state.v.each_with(&step.accelerations, |v, change| v + change * part);
            let change = |a: usize| (step.multipliers[a] - from.multipliers[a]) * part;
            self.trial(State { v, ..from.state }, from_fn(|a| from.multipliers[a] + change(a)))
        }))
    }

    #[cold]
    fn not_found(&self, linear: &Self::Linear, trial: &Self::Trial, steps: usize) -> Error {
        // A dependent constraint that the steps ignore may demand another velocity.
        if let Err(found @ Fault::Contradictory(_)) = kkt::solve(&linear.equations, Rank::on_constraints()) {
            return self.fault(&found);
        }
        let residual = |i: usize| linear.momentum_residual(trial, i).0;
        let size = |i: usize| Scalar::abs(residual(i)) * linear.units.coordinates[i];
        let farthest =
            (1..<L::N>::COUNT).fold(0, |worst, i| if exceeds(size(i), size(worst)) { i } else { worst });
        Error::MomentumNotReached {
            coordinate: name(L::COORDINATES, farthest),
            residual: residual(farthest).to_f64(),
            iterations: steps,
            time: self.phase.t.to_f64(),
        }
    }
}
