//! Systems written by hand, and the comparison with what the macro emits for them.

use lagrange_core::nalgebra::{Const, SMatrix, SVector};
use lagrange_core::{ConstraintKind, Solution, prelude::*};
pub(crate) use num_dual::DualNum;
use num_dual::HyperDual64;

use crate::jacobian::System;
use lagrange_random::{Random, cases};
use lagrange_systems::random_state;

/// Largest deviation, as a fraction of the largest entry of a vector or matrix.
const TOLERANCE: f64 = 1e-11;
/// Largest residual of the equations of motion, as a fraction of their largest term.
const RESIDUAL: f64 = 1e-10;
/// Eliminations whose smallest pivot is less are not judged.
const REGULAR: f64 = 1e-4;

/// Numbers that carry a mixed second derivative.
pub(crate) type D = HyperDual64;

/// The system that the attributes state, once more.
pub(crate) trait ByHand<const N: usize, const M: usize>:
    Linearized<N = Const<N>, M = Const<M>, Scalar = f64> + Default
{
    const KINDS: [ConstraintKind; M] = [ConstraintKind::Holonomic; M];

    /// True if everything is defined where all coordinates, velocities and the time are zero.
    const AT_ORIGIN: bool = true;

    /// A system with random parameters.
    fn random(random: &mut Random) -> Self {
        with_parameters(random)
    }

    /// A random state where everything is defined.
    fn state(&self, random: &mut Random) -> State<f64, N> {
        random_state(random)
    }

    /// L(t, q, q̇).
    fn l(&self, t: D, q: &[D; N], v: &[D; N]) -> D;

    /// Φ(t, q) of holonomic constraints, ψ(t, q, q̇) of the others. Systems without constraints leave it as it is.
    fn constraints(&self, _t: D, _q: &[D; N], _v: &[D; N]) -> [D; M] {
        std::array::from_fn(|a| panic!("constraint {a} is not written by hand"))
    }

    /// Generalized forces Q.
    fn forces(&self, _t: f64, _q: &[f64; N], _v: &[f64; N]) -> [f64; N] {
        [0.0; N]
    }

    /// Rayleigh's function.
    fn dissipation(&self, _t: D, _q: &[D; N], _v: &[D; N]) -> D {
        D::from_re(0.0)
    }
}

/// A system whose fields are numbers, all of them random and positive.
pub(crate) fn with_parameters<S: Linearized<Scalar = f64> + Default>(random: &mut Random) -> S {
    let mut system = S::default();
    for k in 0..S::PARAMETERS.len() {
        assert!(system.set_parameter(k, random.positive()), "{}", S::PARAMETERS[k]);
    }
    system
}

pub(crate) fn dot(x: [D; 3], y: [D; 3]) -> D {
    x[0] * y[0] + x[1] * y[1] + x[2] * y[2]
}

pub(crate) fn cross(x: [D; 3], y: [D; 3]) -> [D; 3] {
    [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
}

/// Sum of the squares.
pub(crate) fn square(x: &[D]) -> D {
    x.iter().map(|x| *x * *x).sum()
}

/// What to differentiate by.
#[derive(Clone, Copy)]
enum By {
    Time,
    Coordinate(usize),
    Velocity(usize),
}

use By::{Coordinate, Time, Velocity};

/// `f` at the state as hyper-dual numbers: `eps1` is ∂f/∂x, `eps1eps2` is ∂²f/∂x∂y.
fn differentiate<const N: usize>(
    state: &State<f64, N>,
    (x, y): (By, By),
    f: &dyn Fn(D, &[D; N], &[D; N]) -> D,
) -> D {
    let mut t = D::from_re(state.t);
    let [mut q, mut v] = [state.q, state.v].map(|x| x.data.0[0].map(D::from_re));
    let mut variable = |by: By, seed: fn(D) -> D| {
        let number = match by {
            Time => &mut t,
            Coordinate(i) => &mut q[i],
            Velocity(i) => &mut v[i],
        };
        *number = seed(*number);
    };
    variable(x, D::derivative1);
    variable(y, D::derivative2);
    f(t, &q, &v)
}

/// The functions that a system is made of, and their derivatives by the formulas of the textbook.
struct Formulas<const N: usize, const M: usize> {
    l: f64,
    /// p_i = ∂L/∂q̇_i
    momentum: SVector<f64, N>,
    /// M_ij = ∂²L/∂q̇_i∂q̇_j
    mass: SMatrix<f64, N, N>,
    /// h_i = ∂L/∂q_i + Q_i − ∂D/∂q̇_i − Σ_j ∂²L/∂q̇_i∂q_j q̇_j − ∂²L/∂q̇_i∂t
    forcing: SVector<f64, N>,
    /// Φ, and zero for velocity constraints.
    residual: SVector<f64, M>,
    /// Σ_j ∂Φ/∂q_j q̇_j + ∂Φ/∂t, or ψ
    rate: SVector<f64, M>,
    /// F_aj = ∂Φ_a/∂q_j, or ∂ψ_a/∂q̇_j
    jacobian: SMatrix<f64, M, N>,
    /// Σ_jk ∂²Φ/∂q_j∂q_k q̇_j q̇_k + 2 Σ_j ∂²Φ/∂q_j∂t q̇_j + ∂²Φ/∂t², or Σ_j ∂ψ/∂q_j q̇_j + ∂ψ/∂t
    bias: SVector<f64, M>,
}

impl<const N: usize, const M: usize> Formulas<N, M> {
    fn of<S: ByHand<N, M>>(system: &S, state: &State<f64, N>) -> Self {
        let (here, speeds) = (state.q.data.0[0], state.v.data.0[0]);
        let l = |x, y| differentiate(state, (x, y), &|t, q, v| system.l(t, q, v));
        let c = |a: usize, x, y| differentiate(state, (x, y), &|t, q, v| system.constraints(t, q, v)[a]);
        let dissipation = |x| differentiate(state, (x, Time), &|t, q, v| system.dissipation(t, q, v)).eps1;
        let along = |of: &dyn Fn(usize) -> f64| (0..N).map(|j| of(j) * speeds[j]).sum::<f64>();
        let forces = system.forces(state.t, &here, &speeds);
        let holonomic = |a: usize| S::KINDS[a] == ConstraintKind::Holonomic;
        Self {
            l: l(Time, Time).re,
            momentum: SVector::from_fn(|i, _| l(Velocity(i), Time).eps1),
            mass: SMatrix::from_fn(|i, j| l(Velocity(i), Velocity(j)).eps1eps2),
            forcing: SVector::from_fn(|i, _| {
                l(Coordinate(i), Time).eps1 + forces[i]
                    - dissipation(Velocity(i))
                    - along(&|j| l(Velocity(i), Coordinate(j)).eps1eps2)
                    - l(Velocity(i), Time).eps1eps2
            }),
            residual: SVector::from_fn(|a, _| if holonomic(a) { c(a, Time, Time).re } else { 0.0 }),
            rate: SVector::from_fn(|a, _| match holonomic(a) {
                true => along(&|j| c(a, Coordinate(j), Time).eps1) + c(a, Time, Time).eps1,
                false => c(a, Time, Time).re,
            }),
            jacobian: SMatrix::from_fn(|a, j| match holonomic(a) {
                true => c(a, Coordinate(j), Time).eps1,
                false => c(a, Velocity(j), Time).eps1,
            }),
            bias: SVector::from_fn(|a, _| match holonomic(a) {
                true => {
                    let second = |x, y| c(a, x, y).eps1eps2;
                    along(&|j| along(&|k| second(Coordinate(j), Coordinate(k))))
                        + 2.0 * along(&|j| second(Coordinate(j), Time))
                        + second(Time, Time)
                }
                false => along(&|j| c(a, Coordinate(j), Time).eps1) + c(a, Time, Time).eps1,
            }),
        }
    }

    /// The terms of M x − Fᵀλ = h along coordinate i.
    fn motion(&self, i: usize, x: &SVector<f64, N>, multipliers: &SVector<f64, M>) -> Vec<f64> {
        let inertia = (0..N).map(|j| self.mass[(i, j)] * x[j]);
        let constraint = (0..M).map(|a| -self.jacobian[(a, i)] * multipliers[a]);
        inertia.chain(constraint).chain([-self.forcing[i]]).collect()
    }
}

/// Compares everything that is emitted for a system, at random states and parameters, and at the origin and at rest, where
/// many terms vanish and nothing may divide by them.
pub(crate) fn check<S, const N: usize, const M: usize, const P: usize>(
    check_jacobian: fn(&mut S, &State<f64, N>) -> f64,
) where
    S: ByHand<N, M> + System<N, M, P>,
{
    assert_eq!(S::CONSTRAINT_KINDS, S::KINDS, "{}", S::NAME);
    let (random, mut worst, mut regular) = (&mut Random(1), Worst::default(), 0);
    let states = cases([10, 25, 1_000]);
    for _ in 0..states {
        let mut system = S::random(random);
        let state = system.state(random);
        check_derivatives(&system, &state, &SVector::from_fn(|_, _| random.signed()), &mut worst);
        if check_accelerations(&system, &state, &mut worst) {
            regular += 1;
            worst.jacobian = worst.jacobian.max(check_jacobian(&mut system, &state));
        }
    }
    if S::AT_ORIGIN {
        let multipliers = SVector::from_fn(|_, _| random.signed());
        check_derivatives(&S::random(random), &State::at_rest([0.0; N]), &multipliers, &mut worst);
    }
    let Worst { deviation, residual, jacobian } = worst;
    println!("{}: off by {deviation:.1e}, residual {residual:.1e}, Jacobian {jacobian:.1e}", S::NAME);
    assert!(regular >= states / 2, "{}: only {regular} states are regular", S::NAME);
}

/// Tests that compare a system with the one by hand. Jacobians are checked too after `with check_jacobian`, and of all systems
/// if the feature `thorough` is on: they take long to compile.
macro_rules! checks {
    (@ $system:ty) => {
        crate::by_hand::check::<$system, _, _, _>(crate::jacobian::check_if_thorough)
    };
    (@ $system:ty, $jacobian:ident) => {
        crate::by_hand::check::<$system, _, _, _>(crate::jacobian::$jacobian)
    };
    ($($name:ident: $system:ty $(, with $jacobian:ident)?;)+) => {
        $(#[test]
        fn $name() {
            crate::by_hand::checks!(@ $system $(, $jacobian)?);
        })+
    };
}
pub(crate) use checks;

/// The largest relative errors so far.
#[derive(Default)]
struct Worst {
    deviation: f64,
    residual: f64,
    jacobian: f64,
}

impl Worst {
    fn compare(&mut self, what: &str, emitted: &[f64], expected: &[f64]) {
        let difference = emitted.iter().zip(expected).map(|(x, y)| x - y);
        let error = ratio(largest(difference), largest(expected.iter().copied()));
        assert!(error <= TOLERANCE, "{what} is off by {error:e}: {emitted:?}, by hand {expected:?}");
        self.deviation = self.deviation.max(error);
    }
}

/// The sum of the terms, as a part of the largest.
fn rest(terms: &[f64]) -> f64 {
    ratio(terms.iter().sum(), largest(terms.iter().copied()))
}

/// The largest magnitude; NaN if there is one.
pub(crate) fn largest(entries: impl Iterator<Item = f64>) -> f64 {
    entries.map(f64::abs).fold(0.0, |x, y| if y > x || y.is_nan() { y } else { x })
}

/// |x|/scale, where 0/0 is a perfect 0.
pub(crate) fn ratio(x: f64, scale: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.abs() / scale }
}

fn check_derivatives<S: ByHand<N, M>, const N: usize, const M: usize>(
    system: &S,
    state: &State<f64, N>,
    multipliers: &SVector<f64, M>,
    worst: &mut Worst,
) {
    let by_hand = Formulas::of(system, state);
    let mut compare = |what: &str, emitted: &[f64], expected: &[f64]| {
        worst.compare(&format!("{what} of {} at {state:?}", S::NAME), emitted, expected);
    };
    compare("L", &[system.lagrangian(state)], &[by_hand.l]);
    compare("p", system.momentum(state).as_slice(), by_hand.momentum.as_slice());
    compare("M", system.mass_matrix(state).as_slice(), by_hand.mass.as_slice());
    compare("h", system.forcing(state).as_slice(), by_hand.forcing.as_slice());
    compare("Φ", system.constraint_residual(state).as_slice(), by_hand.residual.as_slice());
    compare("dΦ/dt", system.constraint_rate(state).as_slice(), by_hand.rate.as_slice());
    compare("F", system.constraint_jacobian(state).as_slice(), by_hand.jacobian.as_slice());
    compare("γ", system.constraint_bias(state).as_slice(), by_hand.bias.as_slice());
    let force = system.constraint_force(state, multipliers);
    compare("Fᵀλ", force.as_slice(), by_hand.jacobian.tr_mul(multipliers).as_slice());
    let mass = system.mass_matrix(state);
    assert_eq!(mass, mass.transpose(), "{}: M is not symmetric", S::NAME);
    // Where a system is given any accelerations and multipliers, M q̈ − h − Fᵀλ is lacking.
    let accelerations = SVector::from_fn(|i, _| (1.3 * i as f64 + 0.4).cos());
    let lacking = system.inverse_dynamics(state, &accelerations, multipliers);
    for i in 0..N {
        let mut terms = by_hand.motion(i, &accelerations, multipliers);
        terms.push(-lacking[i]);
        // The forces are differences of larger terms, as M and h are.
        assert!(rest(&terms) <= 1e-13, "{}, {i}: {:e} of {terms:?}", S::NAME, rest(&terms));
    }
}

/// M q̈ − Fᵀλ = h and F q̈ = −γ, with M, F, h and γ by hand; false where the system is near singular.
fn check_accelerations<S: ByHand<N, M>, const N: usize, const M: usize>(
    system: &S,
    state: &State<f64, N>,
    worst: &mut Worst,
) -> bool {
    let Solution { accelerations, multipliers, pivot, .. } = system.accelerations_unchecked(state);
    if pivot.is_nan() || pivot < REGULAR {
        return false;
    }
    let by_hand = Formulas::of(system, state);
    let motion = (0..N).map(|i| (S::COORDINATES[i], by_hand.motion(i, &accelerations, &multipliers)));
    let constraints = (0..M).map(|a| {
        let terms = (0..N).map(|j| by_hand.jacobian[(a, j)] * accelerations[j]);
        (S::CONSTRAINTS[a], terms.chain([by_hand.bias[a]]).collect())
    });
    for (name, terms) in motion.chain(constraints) {
        let error = rest(&terms);
        assert!(error <= RESIDUAL, "the equation of {name} in {} leaves {error:e}: {terms:?}", S::NAME);
        worst.residual = worst.residual.max(error);
    }
    true
}
