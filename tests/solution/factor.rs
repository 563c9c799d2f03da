//! The factor of the equations' matrix: solves for any right-hand sides, on every scalar, and what motions do with it.

use std::cell::Cell;

use lagrange_core::generic::{Matrix, Vector};
use lagrange_core::prelude::*;
use lagrange_core::{
    Broadcast, ConstraintKind, Hamiltonian, Lagrangian, Scalar, SolutionOf, StateOf, facts::Facts,
    generic::Solution, number::FourLanes,
};
use nalgebra::{Const, SVector};
use num_dual::Dual64;

/// Six rods in a row, in Cartesian coordinates.
#[derive(Lagrangian)]
#[coordinates(x: [6], y: [6])]
#[lagrangian(sum(i in 0..6, m/2*(x_dot[i]^2 + y_dot[i]^2) - m*g*y[i]))]
#[constraint(rod[0]: (x[0]^2 + y[0]^2 - l^2)/2 = 0)]
#[constraint(rod[i in 1..6]: ((x[i]-x[i-1])^2 + (y[i]-y[i-1])^2 - l^2)/2 = 0)]
struct Rods<T> {
    m: T,
    l: T,
    g: T,
}

/// A chain over the velocities of its links, in which M is never formed.
#[derive(Lagrangian)]
#[coordinates(theta: [6])]
#[define(vx[0] = l*cos(theta[0])*theta_dot[0])]
#[define(vx[i in 1..6] = vx[i-1] + l*cos(theta[i])*theta_dot[i])]
#[define(y[0] = -l*cos(theta[0]))]
#[define(y[i in 1..6] = y[i-1] - l*cos(theta[i]))]
#[lagrangian(sum(i in 0..6, m/2*(vx[i]^2 + der(y[i])^2) - m*g*y[i]))]
struct Angles {
    m: f64,
    l: f64,
    g: f64,
}

/// A skate on a plank that swings, held at a height: constraints of all kinds.
#[derive(Lagrangian)]
#[coordinates(x, y, z, phi)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) + j/2*phi_dot^2 + m*a*phi_dot*x_dot - m*g*z)]
#[constraint(plank: z = a*sin(w*t)*x + x*y/4)]
#[constraint(blade: cos(phi)*y_dot - sin(phi)*x_dot = a*cos(w*t))]
struct Skate {
    m: f64,
    j: f64,
    g: f64,
    a: f64,
    w: f64,
}

/// A body that turns: M is singular along the quaternion, and its constraint completes it.
#[derive(Lagrangian)]
#[coordinates(q: [4], r: [3])]
#[define(b = quat_rate_body(q, q_dot))]
#[lagrangian((j[0]*b[0]^2 + j[1]*b[1]^2 + j[2]*b[2]^2)/2 + m/2*dot(r_dot, r_dot))]
#[constraint(unit: (dot(q, q) - 1)/2 = 0)]
struct Body {
    j: [f64; 3],
    m: f64,
}

/// So densely coupled that loops solve it; the massless `z` is completed by its constraint.
#[derive(Lagrangian)]
#[coordinates(x: [30], z)]
#[lagrangian(dot(x_dot, x_dot)/2 + dot(c, x_dot)^2/2 - z)]
#[constraint(height: z = x[0]*x[1] + x[2])]
#[constraint(tie: x[3] = sin(x[4]))]
struct Dense {
    c: [f64; 30],
}

fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

fn vector<const K: usize>(seed: &mut u64) -> SVector<f64, K> {
    SVector::from_fn(|_, _| random(seed))
}

fn state<const N: usize>(seed: &mut u64) -> State<f64, N> {
    State::new(vector(seed), vector(seed)).at_time(0.3)
}

/// The residual of M x − Fᵀλ = h, F x = −γ, as a part of its largest terms, with M and F as they are emitted.
fn residual<L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>, const N: usize, const M: usize>(
    system: &L,
    state: &State<f64, N>,
    (h, gamma): (&SVector<f64, N>, &SVector<f64, M>),
    solution: &SolutionOf<L>,
) -> f64 {
    let (x, lambda) = (solution.accelerations, solution.multipliers);
    let (mass, f) = (system.mass_matrix(state), system.constraint_jacobian(state));
    let motion = (mass * x - f.tr_mul(&lambda) - h).amax();
    let terms = (mass.abs() * x.abs() + f.abs().tr_mul(&lambda.abs()) + h.abs()).max();
    let rows = f * x + gamma;
    let terms_of_rows = f.abs() * x.abs() + gamma.abs();
    rows.iter().zip(&terms_of_rows).fold(motion / terms, |most, (row, terms)| most.max(row.abs() / terms))
}

fn check<L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>, const N: usize, const M: usize>(
    system: &L,
) {
    let mut seed = 17;
    for _ in 0..30 {
        let state = state(&mut seed);
        let factor = system.factor(&state);
        for _ in 0..3 {
            let (h, gamma) = (vector(&mut seed), vector(&mut seed));
            let solution = system.solve_with(&factor, &h, &gamma);
            let left = residual(system, &state, (&h, &gamma), &solution);
            // The elimination loses as many digits as its pivot tells.
            assert!(left * solution.pivot < 1e-14, "{}: {left:e}, pivot {:e}", L::NAME, solution.pivot);
        }
        let (h, gamma) = (system.forcing(&state), system.constraint_bias(&state));
        let (solved, fused) =
            (system.solve_with(&factor, &h, &gamma), system.accelerations_unchecked(&state));
        let size = fused.accelerations.amax() + fused.multipliers.amax();
        let apart = (solved.accelerations - fused.accelerations).amax()
            + (solved.multipliers - fused.multipliers).amax();
        assert!(apart * fused.pivot < 1e-13 * size, "{}: {apart:e} of {size:e}", L::NAME);
        assert!((solved.pivot - fused.pivot).abs() <= 1e-12, "{}", L::NAME);
    }
}

#[test]
fn one_factor_solves_for_any_right_hand_sides() {
    check(&Rods { m: 1.3, l: 0.7, g: 9.81 });
    check(&Angles { m: 1.3, l: 0.7, g: 9.81 });
    check(&Skate { m: 1.3, j: 0.4, g: 9.81, a: 0.2, w: 3.0 });
    check(&Body { j: [0.3, 1.0, 2.5], m: 1.7 });
    check(&Dense { c: vector::<30>(&mut 5).into() });
}

/// In single precision, on lanes and with derivatives.
#[test]
fn every_scalar_is_solved() {
    let rods = Rods { m: 1.3, l: 0.7, g: 9.81 };
    let mut seed = 3;
    let states: [State<f64, 12>; 4] = std::array::from_fn(|_| state(&mut seed));
    let (h, gamma): (SVector<f64, 12>, SVector<f64, 6>) = (vector(&mut seed), vector(&mut seed));
    let solve = |state: &State<f64, 12>| rods.solve_with(&rods.factor(state), &h, &gamma);
    let solved = states.each_ref().map(solve);

    let lane = |x: [f64; 4]| FourLanes::from(x);
    let packed = State {
        t: lane(states.map(|state| state.t)),
        q: SVector::from_fn(|i, _| lane(states.map(|state| state.q[i]))),
        v: SVector::from_fn(|i, _| lane(states.map(|state| state.v[i]))),
    };
    let wide =
        Rods { m: FourLanes::constant(1.3), l: FourLanes::constant(0.7), g: FourLanes::constant(9.81) };
    let of_lanes =
        wide.solve_with(&wide.factor(&packed), &h.map(FourLanes::constant), &gamma.map(FourLanes::constant));
    for i in 0..12 {
        let lanes = of_lanes.accelerations[i].to_array();
        for (lane, solved) in lanes.iter().zip(&solved) {
            let size = solved.accelerations.amax() / solved.pivot;
            assert!((lane - solved.accelerations[i]).abs() <= 1e-14 * size, "{i}");
        }
    }

    let single = Rods { m: 1.3_f32, l: 0.7, g: 9.81 };
    let small = State { t: 0.3, q: states[0].q.cast(), v: states[0].v.cast() };
    let of_single = single.solve_with(&single.factor(&small), &h.cast::<f32>(), &gamma.cast());
    let apart = (of_single.accelerations.cast::<f64>() - solved[0].accelerations).amax();
    assert!(apart * solved[0].pivot < 1e-5 * solved[0].accelerations.amax(), "{apart:e}");

    // Along the first coordinate, against a difference.
    let with = |x: f64| Dual64::from_re(x);
    let mut turned = State { t: with(0.3), q: states[0].q.map(with), v: states[0].v.map(with) };
    turned.q[0] = turned.q[0].derivative();
    let dual = Rods { m: with(1.3), l: with(0.7), g: with(9.81) };
    let of_dual = dual.solve_with(&dual.factor(&turned), &h.map(with), &gamma.map(with));
    let [ahead, behind] = [1e-6, -1e-6].map(|step| {
        let mut state = states[0];
        state.q[0] += step;
        solve(&state).accelerations
    });
    for i in 0..12 {
        let slope = (ahead[i] - behind[i]) / 2e-6;
        let scale = (ahead - behind).amax() / 2e-6;
        assert!((of_dual.accelerations[i].eps - slope).abs() < 1e-6 * scale, "{i}");
    }
}

/// What cannot be solved shows in the factor, and in every solve by it.
#[test]
fn a_factor_of_nothing_vouches_for_nothing() {
    let pivot = |j: [f64; 3], m: f64| {
        let body = Body { j, m };
        let state = State::at_rest([1.0, 0.0, 0.0, 0.0, 0.1, 0.2, 0.3]);
        body.solve_with(&body.factor(&state), &SVector::repeat(1.0), &SVector::repeat(0.0)).pivot
    };
    assert!(pivot([1.0, 2.0, 3.0], 1.0) > 0.01);
    for (j, m) in [([1.0, 2.0, 3.0], 0.0), ([0.0; 3], 1.0), ([1.0, f64::NAN, 1.0], 1.0)] {
        let pivot = pivot(j, m);
        assert!(pivot.is_nan() || pivot < 1e-6, "{j:?} {m}: {pivot:e}");
    }
}

/// A system that counts how often its matrices are asked for as such.
struct Counted<L> {
    system: L,
    matrices: Cell<usize>,
}

impl<L> Counted<L> {
    fn counted<T>(&self, matrix: T) -> T {
        self.matrices.set(self.matrices.get() + 1);
        matrix
    }
}

impl<L: Lagrangian<Scalar = f64>> Lagrangian for Counted<L> {
    type Scalar = f64;
    type N = L::N;
    type M = L::M;
    type Factor = L::Factor;
    const NAME: &'static str = L::NAME;
    const COORDINATES: &'static [&'static str] = L::COORDINATES;
    const CONSTRAINTS: &'static [&'static str] = L::CONSTRAINTS;
    const CONSTRAINT_KINDS: &'static [ConstraintKind] = L::CONSTRAINT_KINDS;
    const MOMENTA_ARE_LINEAR: bool = L::MOMENTA_ARE_LINEAR;
    const OBSERVABLES: &'static [&'static str] = &[];
    const FACTS: Facts = L::FACTS;

    fn mass_matrix(&self, state: &StateOf<L>) -> Matrix<f64, L::N, L::N> {
        self.counted(self.system.mass_matrix(state))
    }
    fn constraint_jacobian(&self, state: &StateOf<L>) -> Matrix<f64, L::M, L::N> {
        self.counted(self.system.constraint_jacobian(state))
    }
    fn lagrangian(&self, state: &StateOf<L>) -> f64 {
        self.system.lagrangian(state)
    }
    fn energy_rate(&self, state: &StateOf<L>, multipliers: &Vector<f64, L::M>) -> f64 {
        self.system.energy_rate(state, multipliers)
    }
    fn energy(&self, state: &StateOf<L>) -> f64 {
        self.system.energy(state)
    }
    fn momentum(&self, state: &StateOf<L>) -> Vector<f64, L::N> {
        self.system.momentum(state)
    }
    fn momentum_rate(&self, state: &StateOf<L>) -> Vector<f64, L::N> {
        self.system.momentum_rate(state)
    }
    fn forcing(&self, state: &StateOf<L>) -> Vector<f64, L::N> {
        self.system.forcing(state)
    }
    fn constraint_residual(&self, state: &StateOf<L>) -> Vector<f64, L::M> {
        self.system.constraint_residual(state)
    }
    fn constraint_rate(&self, state: &StateOf<L>) -> Vector<f64, L::M> {
        self.system.constraint_rate(state)
    }
    fn residual_magnitude(&self, state: &StateOf<L>) -> Vector<f64, L::M> {
        self.system.residual_magnitude(state)
    }
    fn rate_magnitude(&self, state: &StateOf<L>) -> Vector<f64, L::M> {
        self.system.rate_magnitude(state)
    }
    fn constraint_bias(&self, state: &StateOf<L>) -> Vector<f64, L::M> {
        self.system.constraint_bias(state)
    }
    fn constraint_force(&self, state: &StateOf<L>, multipliers: &Vector<f64, L::M>) -> Vector<f64, L::N> {
        self.system.constraint_force(state, multipliers)
    }
    fn inverse_dynamics(
        &self,
        state: &StateOf<L>,
        accelerations: &Vector<f64, L::N>,
        multipliers: &Vector<f64, L::M>,
    ) -> Vector<f64, L::N> {
        self.system.inverse_dynamics(state, accelerations, multipliers)
    }
    fn accelerations_unchecked(&self, state: &StateOf<L>) -> SolutionOf<L> {
        self.system.accelerations_unchecked(state)
    }
    fn factor(&self, state: &StateOf<L>) -> L::Factor {
        self.system.factor(state)
    }
    fn solve_with<S: Broadcast<f64>>(
        &self,
        factor: &L::Factor,
        forcing: &Vector<S, L::N>,
        bias: &Vector<S, L::M>,
    ) -> Solution<S, L::N, L::M> {
        self.system.solve_with(factor, forcing, bias)
    }
    fn observable(&self, _: usize, _: &StateOf<L>, _: &SolutionOf<L>) -> Option<f64> {
        None
    }
    fn conserved(&self, _: usize, _: &StateOf<L>) -> Option<f64> {
        None
    }
}

/// How often the steps of a motion, and its states in between, make M or F: what the start takes is left out.
fn matrices_of_steps<L: Lagrangian<Scalar = f64>>(system: L, start: StateOf<L>) -> [usize; 2] {
    let counted = Counted { system, matrices: Cell::new(0) };
    let start = counted.make_consistent(&start).expect("a start").0;
    let of = |motion: &dyn Fn(f64) -> usize| {
        let [few, many] = [0.1, 2.0].map(|end| {
            counted.matrices.set(0);
            (motion(start.t + end), counted.matrices.get())
        });
        assert!(many.0 > 2 * few.0, "more steps");
        many.1 - few.1
    };
    let lagrangian = of(&|end| {
        let path = counted.integrate(start, end, Dop853::default()).expect("a motion");
        assert_eq!(path.samples(50).count(), 50);
        path.statistics().accepted
    });
    let hamiltonian = of(&|end| {
        let start = counted.phase_state(&start);
        let path = counted.motion_in_momenta(start).to(end).expect("a motion");
        assert_eq!(path.samples(50).count(), 50);
        path.statistics().accepted
    });
    [lagrangian, hamiltonian]
}

#[test]
fn motions_make_no_matrices() {
    let line = State::at_rest(SVector::from_fn(|i, _| {
        0.7 * if i < 6 { 0.8 * (i + 1) as f64 } else { -0.6 * (i - 5) as f64 }
    }));
    assert_eq!(matrices_of_steps(Rods { m: 1.3, l: 0.7, g: 9.81 }, line), [0, 0]);
    let turning = State::new([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.5, 0.1, 0.2, 1.0, 0.0, 0.0]);
    assert_eq!(matrices_of_steps(Body { j: [0.3, 1.0, 2.5], m: 1.7 }, turning), [0, 0]);
    let skate = Skate { m: 1.3, j: 0.4, g: 9.81, a: 0.2, w: 3.0 };
    assert_eq!(matrices_of_steps(skate, State::new([0.5, 0.2, 0.0, 0.1], [1.0, 0.3, 0.0, 0.5])), [0, 0]);
}
