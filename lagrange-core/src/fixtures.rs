//! Systems for tests, written down by hand, and random numbers.

mod random;

use core::array::from_fn;

use nalgebra::{Const, SMatrix, SVector};

pub(crate) use random::RandomMatrix;

use crate::generated::{self, LoopFactor, eliminate, vector};
use crate::motion::LagrangianVectorField;
use crate::number::Broadcast;
use crate::system::{ConstraintKind, Facts, Lagrangian, System};
use crate::{Solution, State};

pub(crate) type At<const N: usize> = State<f64, N>;

/// A system of `N` coordinates `x`, `y`, … and `M` constraints `c0`, `c1`, …, the first `H` holonomic.
#[derive(Clone, Copy)]
pub(crate) struct Mechanism<const N: usize, const M: usize, const H: usize> {
    pub(crate) mass: fn(&At<N>) -> [[f64; N]; N],
    pub(crate) forcing: fn(&At<N>) -> [f64; N],
    pub(crate) residual: fn(&At<N>) -> [f64; M],
    pub(crate) rate: fn(&At<N>) -> [f64; M],
    pub(crate) jacobian: fn(&At<N>) -> [[f64; N]; M],
    pub(crate) bias: fn(&At<N>) -> [f64; M],
}

/// The first `count` names; all of them if there are fewer.
const fn first(all: &'static [&'static str], count: usize) -> &'static [&'static str] {
    if count < all.len() { all.split_at(count).0 } else { all }
}

const fn kinds<const M: usize>(holonomic: usize) -> [ConstraintKind; M] {
    let mut kinds = [ConstraintKind::Velocity; M];
    let mut i = 0;
    while i < holonomic {
        kinds[i] = ConstraintKind::Holonomic;
        i += 1;
    }
    kinds
}

impl<const N: usize, const M: usize, const H: usize> System for Mechanism<N, M, H> {
    type Scalar = f64;
    type Length = Const<N>;
    type M = Const<M>;
    type Field = LagrangianVectorField;

    fn length(&self) -> Const<N> {
        Const
    }

    fn accelerations(&self, t: f64, q: &[f64; N], v: &[f64; N], a: &mut [f64; N]) {
        generated::write_accelerations(self, t, [q, v], a);
    }
}

impl<const N: usize, const M: usize, const H: usize> Lagrangian for Mechanism<N, M, H> {
    type N = Const<N>;
    type Factor = LoopFactor<f64, N, M>;
    const NAME: &'static str = "Mechanism";
    const COORDINATES: &'static [&'static str] = first(&["x", "y", "z", "w[0]", "w[1]"], N);
    const CONSTRAINTS: &'static [&'static str] = first(&["c0", "c1", "c2", "c3", "c4"], M);
    const CONSTRAINT_KINDS: &'static [ConstraintKind] = &kinds::<M>(H);
    const OBSERVABLES: &'static [&'static str] = &["kinetic"];
    const FACTS: Facts = Facts::NONE;

    fn lagrangian(&self, _: &At<N>) -> f64 {
        0.0
    }

    fn energy(&self, state: &At<N>) -> f64 {
        state.v.dot(&self.momentum(state))
    }

    /// For constant masses.
    fn energy_rate(&self, state: &At<N>, multipliers: &SVector<f64, M>) -> f64 {
        2.0 * state.v.dot(&(self.forcing(state) + self.constraint_force(state, multipliers)))
    }

    fn momentum_rate(&self, state: &At<N>) -> SVector<f64, N> {
        self.forcing(state)
    }

    fn momentum(&self, state: &At<N>) -> SVector<f64, N> {
        self.mass_matrix(state) * state.v
    }

    fn mass_matrix(&self, state: &At<N>) -> SMatrix<f64, N, N> {
        (self.mass)(state).into()
    }

    fn forcing(&self, state: &At<N>) -> SVector<f64, N> {
        vector((self.forcing)(state))
    }

    fn constraint_residual(&self, state: &At<N>) -> SVector<f64, M> {
        vector((self.residual)(state))
    }

    fn constraint_rate(&self, state: &At<N>) -> SVector<f64, M> {
        vector((self.rate)(state))
    }

    fn constraint_jacobian(&self, state: &At<N>) -> SMatrix<f64, M, N> {
        SMatrix::<f64, N, M>::from((self.jacobian)(state)).transpose()
    }

    fn residual_magnitude(&self, state: &At<N>) -> SVector<f64, M> {
        let size = self.constraint_jacobian(state).abs() * state.q.abs();
        vector(from_fn(|a| if a < H { size[a] } else { 0.0 }))
    }

    fn rate_magnitude(&self, state: &At<N>) -> SVector<f64, M> {
        self.constraint_jacobian(state).abs() * state.v.abs()
    }

    fn constraint_bias(&self, state: &At<N>) -> SVector<f64, M> {
        vector((self.bias)(state))
    }

    fn constraint_force(&self, state: &At<N>, multipliers: &SVector<f64, M>) -> SVector<f64, N> {
        self.constraint_jacobian(state).tr_mul(multipliers)
    }

    fn inverse_dynamics(&self, state: &At<N>, q2: &SVector<f64, N>, l: &SVector<f64, M>) -> SVector<f64, N> {
        self.mass_matrix(state) * q2 - self.forcing(state) - self.constraint_force(state, l)
    }

    fn accelerations_unchecked(&self, state: &At<N>) -> Solution<f64, N, M> {
        eliminate((self.mass)(state), (self.forcing)(state), (self.jacobian)(state), (self.bias)(state))
    }

    fn factor(&self, state: &At<N>) -> LoopFactor<f64, N, M> {
        generated::factor((self.mass)(state), (self.jacobian)(state), [0.0; M])
    }

    fn solve_with<S: Broadcast<f64>>(
        &self,
        factor: &LoopFactor<f64, N, M>,
        forcing: &SVector<S, N>,
        bias: &SVector<S, M>,
    ) -> Solution<S, N, M> {
        factor.solve(forcing, bias)
    }

    fn observable(&self, index: usize, state: &At<N>, _: &Solution<f64, N, M>) -> Option<f64> {
        (index == 0).then(|| 0.5 * state.v.dot(&self.momentum(state)))
    }

    fn conserved(&self, _: usize, _: &At<N>) -> Option<f64> {
        None
    }
}

pub(crate) fn identity<const N: usize>(_: &At<N>) -> [[f64; N]; N] {
    SMatrix::<f64, N, N>::identity().into()
}

/// Unconstrained, of unit mass.
pub(crate) fn free<const N: usize>(forcing: fn(&At<N>) -> [f64; N]) -> Mechanism<N, 0, 0> {
    Mechanism { mass: identity, forcing, residual: |_| [], rate: |_| [], jacobian: |_| [], bias: |_| [] }
}

pub(crate) fn oscillator() -> Mechanism<1, 0, 0> {
    free(|s| [-s.q[0]])
}

pub(crate) const GRAVITY: f64 = 9.81;

/// Mass 2, radius 0.1, slope 0.3: x along the slope, y the angle; c0: ẋ − a ẏ = 0.
pub(crate) fn rolling_sphere() -> Mechanism<2, 1, 0> {
    Mechanism {
        mass: |_| [[2.0, 0.0], [0.0, 0.4 * 2.0 * 0.1 * 0.1]],
        forcing: |_| [2.0 * GRAVITY * 0.3_f64.sin(), 0.0],
        residual: |_| [0.0],
        rate: |s| [s.v[0] - 0.1 * s.v[1]],
        jacobian: |_| [[1.0, -0.1]],
        bias: |_| [0.0],
    }
}

/// Length and mass 1; c0: ½(x² + y² + z² − 1) = 0.
pub(crate) fn spherical_pendulum() -> Mechanism<3, 1, 1> {
    Mechanism {
        mass: identity,
        forcing: |_| [0.0, 0.0, -GRAVITY],
        residual: |s| [0.5 * (s.q.norm_squared() - 1.0)],
        rate: |s| [s.q.dot(&s.v)],
        jacobian: |s| [s.q.into()],
        bias: |s| [s.v.norm_squared()],
    }
}

/// Length and mass 1; c0: ½(x² + y² − 1) = 0.
pub(crate) fn plane_pendulum() -> Mechanism<2, 1, 1> {
    Mechanism {
        mass: identity,
        forcing: |_| [0.0, -GRAVITY],
        residual: |s| [0.5 * (s.q.norm_squared() - 1.0)],
        rate: |s| [s.q.dot(&s.v)],
        jacobian: |s| [s.q.into()],
        bias: |s| [s.v.norm_squared()],
    }
}

/// A plane pendulum, c0, with c1: (1 + x) Φ₀ = 0, which depends on c0 where both hold and nowhere else.
pub(crate) fn dependent_on_the_manifold() -> Mechanism<2, 2, 2> {
    fn phi(s: &At<2>) -> f64 {
        0.5 * (s.q.norm_squared() - 1.0)
    }
    Mechanism {
        mass: identity,
        forcing: |_| [0.0, -GRAVITY],
        residual: |s| [phi(s), (1.0 + s.q[0]) * phi(s)],
        rate: |s| [s.q.dot(&s.v), (1.0 + s.q[0]) * s.q.dot(&s.v) + s.v[0] * phi(s)],
        jacobian: |s| [s.q.into(), [(1.0 + s.q[0]) * s.q[0] + phi(s), (1.0 + s.q[0]) * s.q[1]]],
        bias: |s| {
            let square = s.v.norm_squared();
            [square, (1.0 + s.q[0]) * square + 2.0 * s.v[0] * s.q.dot(&s.v)]
        },
    }
}
