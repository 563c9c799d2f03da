//! One step of a partitioned Runge–Kutta method for d/dt ∂L/∂q̇ = ∂L/∂q + Q + Fᵀλ, in coordinates and momenta.
//!
//! The unknowns of a step are the velocities Vᵢ of its stages and the multipliers Λᵢ:
//!
//! Qᵢ = q₀ + h Σⱼ aᵢⱼ Vⱼ, p(Qᵢ, Vᵢ) = p₀ + h Σⱼ âᵢⱼ (r(Qⱼ, Vⱼ) + F(Qⱼ)ᵀΛⱼ), Φ(Qᵢ) = 0,
//!
//! with p = ∂L/∂q̇ and r = ∂L/∂q + Q (Jay, *SIAM Journal on Numerical Analysis* 33, 1996; Hairer, Lubich and Wanner,
//! *Geometric Numerical Integration*, VII.1.4). With two stages, a constraint on velocities is imposed on the chord of
//! the step, F(q̄) (q₁ − q₀)/h + b = 0 at its middle q̄, which makes the step reversible (discrete Lagrange–d'Alembert
//! principle: Cortés and Martínez, *Nonlinearity* 14, 2001; McLachlan and Perlmutter, *Journal of Nonlinear Science*
//! 16, 2006).
//!
//! The iteration is that of Newton with the derivatives of M q̇ and Fᵀλ alone, at the start of the step. It contracts by
//! a factor that is proportional to the step length.

use super::scheme::{CompensatedState, combined, magnitudes, terms_of_positions, terms_of_rates};
use super::settle::{NotSettled, Residuals, are_within, have_hardly_turned};
use super::stage_memory::StageMemory;
use super::tableau::Tableau;
use crate::motion::limits::HIDDEN;
use crate::number::limits::CHANGE;
use crate::number::{Parts, Scalar};
use crate::room::Room;
use crate::solution::eliminate::LoopFactor;
use crate::solution::near::compensated;
use crate::system::{ConstraintKind, Lagrangian, State, StateOf, has_velocity_constraints, unit};
use crate::vector::{Array, Element, Entrywise, StaticLength, Vector, array, from_fn, rows, vector, zeros};

/// A step in progress.
struct PartitionedStep<'a, L: Lagrangian, const S: usize> {
    system: &'a L,
    tableau: &'static Tableau<S>,
    from: &'a CompensatedState<L::Scalar, L::N>,
    momenta: [Array<L::Scalar, L::N>; 2],
    h: L::Scalar,
    to: L::Scalar,
}

/// Forces of the stages, at the last sweep.
type StageForces<T, N, const S: usize> = [Array<T, N>; S];

/// Residuals of the stages.
struct StageResiduals<T: Element, N: StaticLength, M: StaticLength, const S: usize> {
    momenta: [Array<T, N>; S],
    constraints: [Array<T, M>; S],
}

/// Moves a point to the time `to` by one step. Returns the number of evaluations of the forces.
#[inline]
pub(super) fn advance<L: Lagrangian<Scalar: Parts>, const S: usize>(
    tableau: &'static Tableau<S>,
    system: &L,
    point: &mut CompensatedState<L::Scalar, L::N>,
    stages: &mut StageMemory<L::Factor, L::Scalar, L::N, L::M, S>,
    (h, to): (L::Scalar, L::Scalar),
) -> Result<usize, NotSettled> {
    stages.forget_a_short_step(system, &point.state, h);
    stages.guess(&tableau.nodes, h);
    let step = PartitionedStep { system, tableau, from: point, momenta: stages.momenta, h, to };
    let (forces, sweeps) = step.solve(stages)?;
    let change = combined(&tableau.weights, &stages.velocities).map(|x| h * x);
    let q = point.moved(&change);
    let push = combined(&tableau.weights, &forces).map(|x| h * x);
    let step = PartitionedStep { system, tableau, from: point, momenta: stages.momenta, h, to };
    let v = step.arrive(stages, &q[0], &push)?;
    point.set(to, q, [v, Array::filled(L::Scalar::constant(0.0))]);
    Ok(S * sweeps)
}

impl<L: Lagrangian<Scalar: Parts>, const S: usize> PartitionedStep<'_, L, S> {
    /// Iterates until the stages satisfy their equations. Returns the forces of the stages, and the number of sweeps.
    fn solve(
        &self,
        stages: &mut StageMemory<L::Factor, L::Scalar, L::N, L::M, S>,
    ) -> Result<(StageForces<L::Scalar, L::N, S>, usize), NotSettled> {
        let matrices = (<L::M>::COUNT > 0).then(|| self.matrices(&stages.velocities));
        let (mut of_momenta, mut of_constraints) = (Residuals::new(), Residuals::new());
        let mut sweeps = 0;
        loop {
            sweeps += 1;
            let states = self.states(&stages.velocities);
            let mut terms = Array::filled(L::Scalar::constant(0.0));
            let [momenta, mut forces] = self.momenta_and_forces(&states, &stages.multipliers, &mut terms);
            let residuals = self.residuals(&momenta, &forces, &states, &stages.velocities);
            let size = sizes(&residuals.momenta);
            let mut are_last = of_momenta.settle(
                &size,
                &terms,
                [&|| self.hidden(), &|| self.wider(&terms, &stages.multipliers[0])],
                || are_hidden(&size, &terms, &stages.largest),
            )?;
            if let Some(matrices) = &matrices {
                let [terms, wider] = self.constraint_terms(&states);
                let is_noise = || {
                    let jacobian = self.system.constraint_jacobian(&states[S - 1]);
                    have_hardly_turned(&jacobian, |a| moved_by(matrices, a))
                };
                let size = sizes(&residuals.constraints);
                are_last &= of_constraints.settle(&size, &terms, [&|| wider; 2], is_noise)?;
            }
            match &matrices {
                None => self.correct(stages, &residuals),
                Some(matrices) => {
                    let change = self.correct_on_constraints(stages, &residuals, matrices);
                    if are_last {
                        self.add_constraint_forces(&mut forces, &states, &change);
                    }
                }
            }
            if are_last {
                let largest = |k: usize| -(-stages.largest[k]).least(-terms[k]);
                stages.largest = Array::from_fn(largest);
                return Ok((forces, sweeps));
            }
        }
    }

    fn states(&self, velocities: &[Array<L::Scalar, L::N>; S]) -> [StateOf<L>; S] {
        from_fn(|i| {
            let change = combined(&self.tableau.a[i], velocities).map(|x| self.h * x);
            let t = match self.tableau.nodes[i] {
                1.0 => self.to,
                node => self.from.state.t + L::Scalar::constant(node) * self.h,
            };
            State { t, q: vector(self.from.moved(&change)[0]), v: vector(velocities[i]) }
        })
    }

    /// Momenta and forces at the stages; adds the mean magnitudes of their terms to `terms`. At the last stage of a method
    /// with constraints, the multiplier is not part of the force.
    fn momenta_and_forces(
        &self,
        states: &[StateOf<L>; S],
        multipliers: &[Array<L::Scalar, L::M>; S],
        terms: &mut Array<L::Scalar, L::N>,
    ) -> [[Array<L::Scalar, L::N>; S]; 2] {
        let mut both = [[Array::filled(L::Scalar::constant(0.0)); S]; 2];
        let length = self.h.magnitude();
        for (i, state) in states.iter().enumerate() {
            // The forces of the last stage of a Lobatto pair act on no stage.
            let acts = self.tableau.hat.iter().any(|row| row[i] != 0.0);
            let (p, mut r) =
                (self.system.completed_momentum(state), self.system.completed_momentum_rate(state));
            let mut size = magnitudes(&r);
            if <L::M>::COUNT > 0 && i + 1 < S {
                let force = self.system.constraint_force(state, &vector(multipliers[i]));
                size = Array::from_fn(|k| size[k] + force[k].magnitude());
                r = r.plus(&force);
            }
            for k in 0..<L::N>::COUNT {
                let push = if acts { length * size[k] } else { L::Scalar::constant(0.0) };
                let all = p[k].magnitude() + self.momenta[0][k].magnitude() + push;
                terms[k] = terms[k] + all * L::Scalar::constant(1.0 / S as f64);
            }
            (both[0][i], both[1][i]) = (array(p), array(r));
        }
        both
    }

    fn residuals(
        &self,
        momenta: &[Array<L::Scalar, L::N>; S],
        forces: &[Array<L::Scalar, L::N>; S],
        states: &[StateOf<L>; S],
        velocities: &[Array<L::Scalar, L::N>; S],
    ) -> StageResiduals<L::Scalar, L::N, L::M, S> {
        let [start, rest] = &self.momenta;
        let momenta = from_fn(|i| {
            let push = combined(&self.tableau.hat[i], forces);
            Array::from_fn(|k| (momenta[i][k] - start[k]) - (self.h * push[k] + rest[k]))
        });
        let constraints = from_fn(|i| match i {
            0 => Array::filled(L::Scalar::constant(0.0)),
            _ => self.constraints(&states[i], velocities),
        });
        StageResiduals { momenta, constraints }
    }

    /// Φ/h of the holonomic constraints at a stage; the velocity constraints on the chord of the step.
    fn constraints(
        &self,
        state: &StateOf<L>,
        velocities: &[Array<L::Scalar, L::N>; S],
    ) -> Array<L::Scalar, L::M> {
        let holonomic = self.system.constraint_residual(state);
        let rate = has_velocity_constraints::<L>()
            .then(|| self.system.constraint_rate(&self.chord(state, velocities)));
        Array::from_fn(|a| match (L::CONSTRAINT_KINDS[a], &rate) {
            (ConstraintKind::Velocity, Some(rate)) => rate[a],
            _ => holonomic[a] / self.h,
        })
    }

    /// The middle of the chord of the step, with its mean velocity.
    fn chord(&self, end: &StateOf<L>, velocities: &[Array<L::Scalar, L::N>; S]) -> StateOf<L> {
        let half = L::Scalar::constant(0.5);
        State {
            t: self.from.state.t + half * self.h,
            q: self.from.state.q.each_with(&end.q, |x, y| half * (x + y)),
            v: vector(combined(&self.tableau.weights, velocities)),
        }
    }

    /// Mean magnitudes of the terms of the constraints at the stages, and with those of a displacement.
    fn constraint_terms(&self, states: &[StateOf<L>; S]) -> [Array<L::Scalar, L::M>; 2] {
        let mut all = [Array::filled(L::Scalar::constant(0.0)); 2];
        for state in &states[1..] {
            let positions = terms_of_positions(self.system, state);
            let rates = terms_of_rates(self.system, state);
            for a in 0..<L::M>::COUNT {
                let position = positions[a] / self.h.magnitude();
                let (terms, others) = match L::CONSTRAINT_KINDS[a] {
                    ConstraintKind::Holonomic => (position, rates[a]),
                    ConstraintKind::Velocity => (rates[a], position),
                };
                let part = L::Scalar::constant(1.0 / (S - 1) as f64);
                (all[0][a], all[1][a]) = (all[0][a] + part * terms, all[1][a] + part * (terms + others));
            }
        }
        all
    }

    /// Magnitudes of the terms of the momenta, and of those of a displacement of each coordinate by its own size during the
    /// step: M q̇, the change of the forces with each coordinate, and Fᵀλ.
    #[inline(never)]
    fn wider(
        &self,
        terms: &Array<L::Scalar, L::N>,
        multipliers: &Array<L::Scalar, L::M>,
    ) -> Array<L::Scalar, L::N> {
        let (system, state, length) = (self.system, &self.from.state, self.h.magnitude());
        let (m, f) = (system.completed_mass_matrix(state), system.constraint_jacobian(state));
        let mut wider = *terms;
        for j in 0..<L::N>::COUNT {
            let part = L::Scalar::constant(CHANGE);
            let mut moved = *state;
            moved.q[j] = moved.q[j] + part * moved.q[j];
            let change = system.completed_momentum_rate(&moved).minus(&system.completed_momentum_rate(state));
            let speed = state.v[j].magnitude() + state.q[j].magnitude() / length;
            for k in 0..<L::N>::COUNT {
                let change = change[k].magnitude() * length / part;
                // Forces may end near the coordinates.
                let change = if change.is_finite() { change } else { L::Scalar::constant(0.0) };
                wider[k] = wider[k] + m[(k, j)].magnitude() * speed + change;
            }
        }
        for a in 0..<L::M>::COUNT {
            for k in 0..<L::N>::COUNT {
                wider[k] = wider[k] + length * f[(a, k)].magnitude() * multipliers[a].magnitude();
            }
        }
        wider
    }

    /// Bounds of the terms Mₖⱼ q̇ⱼ of the momenta that symmetry may hide in an entry of M: by Schwarz's inequality they are at
    /// most √(Mₖₖ Mⱼⱼ) |q̇ⱼ|.
    #[inline(never)]
    fn hidden(&self) -> Array<L::Scalar, L::N> {
        let m = self.system.completed_mass_matrix(&self.from.state);
        let root = |k: usize| Scalar::sqrt(m[(k, k)].magnitude());
        let speed = |j: usize| root(j) * self.from.state.v[j].magnitude();
        let sum = (0..<L::N>::COUNT).fold(L::Scalar::constant(0.0), |sum, j| sum + speed(j));
        Array::from_fn(|k| root(k) * sum)
    }

    /// Corrects the stages without constraints: M δVᵢ = −Gᵢ.
    fn correct(
        &self,
        stages: &mut StageMemory<L::Factor, L::Scalar, L::N, L::M, S>,
        residuals: &StageResiduals<L::Scalar, L::N, L::M, S>,
    ) {
        let none = zeros();
        for (v, residual) in stages.velocities.iter_mut().zip(&residuals.momenta) {
            let push = vector(residual.map(|x| -x));
            let correction = self.system.solve_with(&stages.factor, &push, &none).accelerations;
            *v = Array::from_fn(|i| v[i] + correction[i]);
        }
    }

    /// Factorizes M and F. With two stages, where forces act at the start and constraints at the end, the iteration takes
    /// fewest sweeps with the matrices of the start (8 against 13 on a sphere, in steps of a 30th of a turn); with more
    /// stages, with those of the middle, which the initial guess gives (11 against 14).
    #[inline(never)]
    fn matrices(&self, velocities: &[Array<L::Scalar, L::N>; S]) -> Room<LoopFactor<L::Scalar, L::N, L::M>> {
        let half = L::Scalar::constant(if S == 2 { 0.0 } else { 0.5 }) * self.h;
        let mean = combined(&self.tableau.weights, velocities);
        let State { t, q, .. } = self.from.state;
        let q = vector(Array::from_fn(|i| q[i] + half * mean[i]));
        let state = &State { t: t + half, q, v: vector(mean) };
        let none = Array::filled(L::Scalar::constant(0.0));
        let (m, f) = (self.system.completed_mass_matrix(state), self.system.constraint_jacobian(state));
        Room::of(LoopFactor::of(m.into(), rows(&f), none, array(self.system.compliance())))
    }

    /// Corrects the stages and multipliers: M δVᵢ − Fᵀμᵢ = −Gᵢ with μᵢ = h Σₖ âᵢₖ δΛₖ, and F Σⱼ aᵢⱼ δVⱼ = −Φᵢ/h.
    ///
    /// Returns δΛ. With x = −M⁻¹G, the multipliers νᵢ = Σⱼ aᵢⱼ μⱼ = h Σₖ (a â)ᵢₖ δΛₖ satisfy F M⁻¹Fᵀ νᵢ = −Φᵢ/h − F Σⱼ aᵢⱼ xⱼ.
    fn correct_on_constraints(
        &self,
        stages: &mut StageMemory<L::Factor, L::Scalar, L::N, L::M, S>,
        residuals: &StageResiduals<L::Scalar, L::N, L::M, S>,
        matrices: &LoopFactor<L::Scalar, L::N, L::M>,
    ) -> [Array<L::Scalar, L::M>; S] {
        let Tableau { a, hat, inverse, .. } = self.tableau;
        let free: [Array<_, L::N>; S] = from_fn(|i| matrices.free(&residuals.momenta[i].map(|x| -x)));
        let mut nu = [Array::filled(L::Scalar::constant(0.0)); S];
        for i in 1..S {
            nu[i - 1] = matrices.multipliers(&combined(&a[i], &free), &residuals.constraints[i]);
        }
        let change: [Array<_, L::M>; S] = from_fn(|k| combined(&inverse[k], &nu).map(|x| x / self.h));
        for i in 0..S {
            let mu = combined(&hat[i], &change).map(|x| x * self.h);
            let correction = matrices.held(&free[i], &mu);
            stages.velocities[i] = Array::from_fn(|k| stages.velocities[i][k] + correction[k]);
            stages.multipliers[i] = Array::from_fn(|k| stages.multipliers[i][k] + change[i][k]);
        }
        change
    }

    /// Adds the forces of a change of the multipliers: without the last change, the momenta would be off by an error of
    /// the same sign in every step.
    fn add_constraint_forces(
        &self,
        forces: &mut StageForces<L::Scalar, L::N, S>,
        states: &[StateOf<L>; S],
        change: &[Array<L::Scalar, L::M>; S],
    ) {
        for i in 0..S - 1 {
            let force = self.system.constraint_force(&states[i], &vector(change[i]));
            forces[i] = Array::from_fn(|k| forces[i][k] + force[k]);
        }
    }

    /// Finds the velocities at the end, which have the momenta p₁ = p₀ + `push` + FᵀΛ and satisfy the constraints on
    /// velocities. Keeps the momenta.
    fn arrive(
        &self,
        stages: &mut StageMemory<L::Factor, L::Scalar, L::N, L::M, S>,
        q: &Array<L::Scalar, L::N>,
        push: &Array<L::Scalar, L::N>,
    ) -> Result<Array<L::Scalar, L::N>, NotSettled> {
        let (system, [start, rest]) = (self.system, &self.momenta);
        let last = stages.velocities[S - 1];
        let mut state = State { t: self.to, q: vector(*q), v: vector(last) };
        stages.factor = system.factor(&state);
        let mut multipliers: Vector<L::Scalar, L::M> = zeros();
        let (mut of_momenta, mut of_rates) = (Residuals::new(), Residuals::new());
        loop {
            let force = system.constraint_force(&state, &multipliers);
            let total = Array::from_fn(|k| push[k] + force[k]);
            let p = compensated(start, &total, rest);
            let momenta = system.completed_momentum(&state);
            let residual = Array::from_fn(|k| (momenta[k] - p.0[k]) - p.1[k]);
            let terms = Array::from_fn(|k| {
                momenta[k].magnitude() + start[k].magnitude() + push[k].magnitude() + force[k].magnitude()
            });
            let rate = system.constraint_rate(&state);
            let size = magnitudes(&vector(residual));
            let mut is_last = of_momenta.settle(
                &size,
                &terms,
                [&|| self.hidden(), &|| self.wider(&terms, &array(multipliers))],
                || are_hidden(&size, &terms, &stages.largest),
            )?;
            let terms = terms_of_rates(system, &state);
            let wider = || {
                let positions = terms_of_positions(system, &state);
                Array::from_fn(|a| terms[a] + positions[a] / self.h.magnitude())
            };
            // The equations are linear, and factorized at this state.
            is_last &= of_rates.settle(&magnitudes(&rate), &terms, [&wider; 2], || true)?;
            let correction = system.solve_with(&stages.factor, &vector(residual.map(|x| -x)), &rate);
            state.v = state.v.plus(&correction.accelerations);
            multipliers = multipliers.plus(&correction.multipliers);
            if is_last {
                let force = system.constraint_force(&state, &multipliers);
                let total = Array::from_fn(|k| push[k] + force[k]);
                stages.momenta = compensated(start, &total, rest).into();
                return Ok(array(state.v));
            }
        }
    }
}

/// True if residuals may be the round-off of hidden terms: they are within a thousandth of the visible ones, or of the largest
/// so far, because a motion that comes to rest leaves terms of the size of its whole way.
fn are_hidden<T: Parts, N: StaticLength>(
    size: &Array<T, N>,
    terms: &Array<T, N>,
    largest: &Array<T, N>,
) -> bool {
    are_within(HIDDEN, size, &Array::from_fn(|k| terms[k] + largest[k]))
}

/// The move that changes constraint `a` by −1, and no other.
fn moved_by<T: Parts, N: StaticLength, M: StaticLength>(
    matrices: &LoopFactor<T, N, M>,
    a: usize,
) -> Array<T, N> {
    let none = Array::filled(T::constant(0.0));
    matrices.held(&none, &matrices.multipliers(&none, &unit::<T, M>(a).into()))
}

/// Sums of the magnitudes over the stages.
fn sizes<T: Parts, K: StaticLength, const S: usize>(of: &[Array<T, K>; S]) -> Array<T, K> {
    Array::from_fn(|k| of.iter().fold(T::constant(0.0), |sum, x| sum + x[k].magnitude()))
}
