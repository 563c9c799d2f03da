//! Systems written by hand, and the comparison with what the macro emits for them.

use lagrange_core::nalgebra::{Const, SMatrix, SVector};
use lagrange_core::{ConstraintKind, Solution, prelude::*};
use num_dual::{DualNum, HyperDual64};

use crate::jacobian::check_jacobian;
use lagrange_random::Random;
use lagrange_systems::random_state;

const STATES: usize = 25;
/// Largest deviation, as a fraction of the largest entry of a vector or matrix.
const TOLERANCE: f64 = 1e-11;
/// Largest residual of the equations of motion, as a fraction of their largest term.
const RESIDUAL: f64 = 1e-10;
/// Eliminations whose smallest pivot is less are not judged.
const REGULAR: f64 = 1e-4;

/// What automatic differentiation runs on.
pub(crate) trait Number: DualNum<Primitive = f64> + Copy {}

impl<D: DualNum<Primitive = f64> + Copy> Number for D {}

/// The system that the attributes state, once more.
pub(crate) trait WithDerivatives<const N: usize, const M: usize>:
    Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64> + Sized
{
    const KINDS: [ConstraintKind; M] = [ConstraintKind::Holonomic; M];

    /// A system with random parameters.
    fn random(random: &mut Random) -> Self;

    /// A random state where everything is defined.
    fn state(&self, random: &mut Random) -> State<f64, N> {
        random_state(random)
    }

    /// L(t, q, q̇).
    fn l<D: Number>(&self, t: D, q: &[D; N], v: &[D; N]) -> D;

    /// Φ(t, q) of holonomic constraints, ψ(t, q, q̇) of the others. Systems without constraints leave it as it is.
    fn constraints<D: Number>(&self, _t: D, _q: &[D; N], _v: &[D; N]) -> [D; M] {
        std::array::from_fn(|a| panic!("constraint {a} is not written by hand"))
    }

    /// Generalized forces Q.
    fn forces(&self, _t: f64, _q: &[f64; N], _v: &[f64; N]) -> [f64; N] {
        [0.0; N]
    }

    /// Rayleigh's function.
    fn dissipation<D: Number>(&self, _t: D, _q: &[D; N], _v: &[D; N]) -> D {
        D::zero()
    }
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
fn differentiate<const N: usize, R>(
    state: &State<f64, N>,
    (x, y): (By, By),
    f: impl Fn(HyperDual64, &[HyperDual64; N], &[HyperDual64; N]) -> R,
) -> R {
    let mut t = HyperDual64::from_re(state.t);
    let mut q = state.q.data.0[0].map(HyperDual64::from_re);
    let mut v = state.v.data.0[0].map(HyperDual64::from_re);
    let mut variable = |by: By, seed: fn(HyperDual64) -> HyperDual64| {
        let number = match by {
            Time => &mut t,
            Coordinate(i) => &mut q[i],
            Velocity(i) => &mut v[i],
        };
        *number = seed(*number);
    };
    variable(x, HyperDual64::derivative1);
    variable(y, HyperDual64::derivative2);
    f(t, &q, &v)
}

/// The derivatives of a system at a state, by the formulas of the textbook.
struct Derivatives<'a, S, const N: usize, const M: usize> {
    system: &'a S,
    state: &'a State<f64, N>,
}

impl<S: WithDerivatives<N, M>, const N: usize, const M: usize> Derivatives<'_, S, N, M> {
    fn l(&self, x: By, y: By) -> HyperDual64 {
        differentiate(self.state, (x, y), |t, q, v| self.system.l(t, q, v))
    }

    fn constraint(&self, a: usize, x: By, y: By) -> HyperDual64 {
        differentiate(self.state, (x, y), |t, q, v| self.system.constraints(t, q, v)[a])
    }

    fn lagrangian(&self) -> f64 {
        self.l(Time, Time).re
    }

    /// p_i = ∂L/∂q̇_i
    fn momentum(&self) -> SVector<f64, N> {
        SVector::from_fn(|i, _| self.l(Velocity(i), Time).eps1)
    }

    /// M_ij = ∂²L/∂q̇_i∂q̇_j
    fn mass_matrix(&self) -> SMatrix<f64, N, N> {
        SMatrix::from_fn(|i, j| self.l(Velocity(i), Velocity(j)).eps1eps2)
    }

    /// h_i = ∂L/∂q_i + Q_i − ∂D/∂q̇_i − Σ_j ∂²L/∂q̇_i∂q_j q̇_j − ∂²L/∂q̇_i∂t
    fn forcing(&self) -> SVector<f64, N> {
        let (t, q, v) = (self.state.t, &self.state.q.data.0[0], &self.state.v.data.0[0]);
        let forces = self.system.forces(t, q, v);
        SVector::from_fn(|i, _| {
            let dissipation =
                differentiate(self.state, (Velocity(i), Time), |t, q, v| self.system.dissipation(t, q, v));
            let convective = |j| self.l(Velocity(i), Coordinate(j)).eps1eps2 * v[j];
            self.l(Coordinate(i), Time).eps1 + forces[i]
                - dissipation.eps1
                - (0..N).map(convective).sum::<f64>()
                - self.l(Velocity(i), Time).eps1eps2
        })
    }

    fn is_holonomic(a: usize) -> bool {
        S::KINDS[a] == ConstraintKind::Holonomic
    }

    /// Φ, and zero for velocity constraints
    fn residual(&self) -> SVector<f64, M> {
        SVector::from_fn(|a, _| if Self::is_holonomic(a) { self.constraint(a, Time, Time).re } else { 0.0 })
    }

    /// Σ_j ∂Φ/∂q_j q̇_j + ∂Φ/∂t, or ψ
    fn rate(&self) -> SVector<f64, M> {
        let v = &self.state.v;
        SVector::from_fn(|a, _| match S::KINDS[a] {
            ConstraintKind::Velocity => self.constraint(a, Time, Time).re,
            ConstraintKind::Holonomic => {
                let convective = |j| self.constraint(a, Coordinate(j), Time).eps1 * v[j];
                (0..N).map(convective).sum::<f64>() + self.constraint(a, Time, Time).eps1
            }
        })
    }

    /// F_aj = ∂Φ_a/∂q_j, or ∂ψ_a/∂q̇_j
    fn jacobian(&self) -> SMatrix<f64, M, N> {
        SMatrix::from_fn(|a, j| match S::KINDS[a] {
            ConstraintKind::Holonomic => self.constraint(a, Coordinate(j), Time).eps1,
            ConstraintKind::Velocity => self.constraint(a, Velocity(j), Time).eps1,
        })
    }

    fn bias(&self) -> SVector<f64, M> {
        SVector::from_fn(|a, _| match S::KINDS[a] {
            ConstraintKind::Holonomic => self.holonomic_bias(a),
            ConstraintKind::Velocity => self.velocity_bias(a),
        })
    }

    /// Σ_jk ∂²Φ/∂q_j∂q_k q̇_j q̇_k + 2 Σ_j ∂²Φ/∂q_j∂t q̇_j + ∂²Φ/∂t²
    fn holonomic_bias(&self, a: usize) -> f64 {
        let v = &self.state.v;
        let second = |x, y| self.constraint(a, x, y).eps1eps2;
        let quadratic: f64 = (0..N)
            .flat_map(|j| (0..N).map(move |k| (j, k)))
            .map(|(j, k)| second(Coordinate(j), Coordinate(k)) * v[j] * v[k])
            .sum();
        let mixed: f64 = (0..N).map(|j| second(Coordinate(j), Time) * v[j]).sum();
        quadratic + 2.0 * mixed + second(Time, Time)
    }

    /// Σ_j ∂ψ/∂q_j q̇_j + ∂ψ/∂t
    fn velocity_bias(&self, a: usize) -> f64 {
        let first = |x| self.constraint(a, x, Time).eps1;
        (0..N).map(|j| first(Coordinate(j)) * self.state.v[j]).sum::<f64>() + first(Time)
    }
}

/// Compares everything that is emitted for a system, at random states and parameters.
pub(crate) fn check<S, const N: usize, const M: usize, const P: usize>()
where
    S: WithDerivatives<N, M> + Linearized<P = Const<P>>,
{
    assert_eq!(S::CONSTRAINT_KINDS, S::KINDS, "{}", S::NAME);
    let mut random = Random(1);
    let (mut worst, mut regular) = (Worst::default(), 0);
    for _ in 0..STATES {
        let mut system = S::random(&mut random);
        let state = system.state(&mut random);
        let multipliers = SVector::from_fn(|_, _| random.signed());
        check_derivatives(&system, &state, &multipliers, &mut worst);
        if check_accelerations(&system, &state, &mut worst) {
            regular += 1;
            worst.jacobian = worst.jacobian.max(check_jacobian(&mut system, &state));
        }
    }
    let Worst { deviation, residual, jacobian } = worst;
    println!("{}: off by {deviation:.1e}, residual {residual:.1e}, Jacobian {jacobian:.1e}", S::NAME);
    assert!(regular >= STATES / 2, "{}: only {regular} states are regular", S::NAME);
}

/// The same at the origin and at rest, where many terms vanish and nothing may divide by them.
pub(crate) fn check_at_origin<S: WithDerivatives<N, M>, const N: usize, const M: usize>() {
    let mut random = Random(2);
    let system = S::random(&mut random);
    let (state, mut worst) = (State::at_rest([0.0; N]), Worst::default());
    check_derivatives(&system, &state, &SVector::from_fn(|_, _| random.signed()), &mut worst);
}

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

    /// Notes how well a sum of terms vanishes.
    fn vanishes(&mut self, what: &str, terms: &[f64]) {
        let error = ratio(terms.iter().sum(), largest(terms.iter().copied()));
        assert!(error <= RESIDUAL, "{what} leaves {error:e}: {terms:?}");
        self.residual = self.residual.max(error);
    }
}

/// The largest magnitude; NaN if there is one.
fn largest(entries: impl Iterator<Item = f64>) -> f64 {
    entries.map(f64::abs).fold(0.0, |x, y| if y > x || y.is_nan() { y } else { x })
}

/// |x|/scale, where 0/0 is a perfect 0.
fn ratio(x: f64, scale: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.abs() / scale }
}

fn check_derivatives<S: WithDerivatives<N, M>, const N: usize, const M: usize>(
    system: &S,
    state: &State<f64, N>,
    multipliers: &SVector<f64, M>,
    worst: &mut Worst,
) {
    let by_hand = Derivatives { system, state };
    let mut compare = |what: &str, emitted: &[f64], expected: &[f64]| {
        worst.compare(&format!("{} of {} at {state:?}", what, S::NAME), emitted, expected);
    };
    compare("L", &[system.lagrangian(state)], &[by_hand.lagrangian()]);
    compare("p", system.momentum(state).as_slice(), by_hand.momentum().as_slice());
    compare("M", system.mass_matrix(state).as_slice(), by_hand.mass_matrix().as_slice());
    compare("h", system.forcing(state).as_slice(), by_hand.forcing().as_slice());
    compare("Φ", system.constraint_residual(state).as_slice(), by_hand.residual().as_slice());
    compare("dΦ/dt", system.constraint_rate(state).as_slice(), by_hand.rate().as_slice());
    compare("F", system.constraint_jacobian(state).as_slice(), by_hand.jacobian().as_slice());
    compare("γ", system.constraint_bias(state).as_slice(), by_hand.bias().as_slice());
    let force = system.constraint_force(state, multipliers);
    compare("Fᵀλ", force.as_slice(), by_hand.jacobian().tr_mul(multipliers).as_slice());
    check_inverse_dynamics(&by_hand, multipliers);
    let mass = system.mass_matrix(state);
    assert_eq!(mass, mass.transpose(), "{}: M is not symmetric", S::NAME);
}

/// Where a system is given any accelerations and multipliers, M q̈ − h − Fᵀλ is lacking, with M, h and F by hand.
fn check_inverse_dynamics<S: WithDerivatives<N, M>, const N: usize, const M: usize>(
    by_hand: &Derivatives<'_, S, N, M>,
    multipliers: &SVector<f64, M>,
) {
    let accelerations = SVector::from_fn(|i, _| (1.3 * i as f64 + 0.4).cos());
    let lacking = by_hand.system.inverse_dynamics(by_hand.state, &accelerations, multipliers);
    let (mass, jacobian, forcing) = (by_hand.mass_matrix(), by_hand.jacobian(), by_hand.forcing());
    for i in 0..N {
        let inertia = (0..N).map(|j| mass[(i, j)] * accelerations[j]);
        let constraint = (0..M).map(|a| -jacobian[(a, i)] * multipliers[a]);
        let terms: Vec<f64> = inertia.chain(constraint).chain([-forcing[i], -lacking[i]]).collect();
        let error = ratio(terms.iter().sum(), largest(terms.iter().copied()));
        // The forces are differences of larger terms, as M and h are.
        assert!(error <= 1e-13, "{}, {i}: {error:e} of {terms:?}", S::NAME);
    }
}

/// M q̈ − Fᵀλ = h and F q̈ = −γ, with M, F, h and γ by hand; false where the system is near singular.
fn check_accelerations<S: WithDerivatives<N, M>, const N: usize, const M: usize>(
    system: &S,
    state: &State<f64, N>,
    worst: &mut Worst,
) -> bool {
    let Solution { accelerations, multipliers, pivot, .. } = system.accelerations_unchecked(state);
    if pivot.is_nan() || pivot < REGULAR {
        return false;
    }
    let by_hand = Derivatives { system, state };
    let (mass, jacobian) = (by_hand.mass_matrix(), by_hand.jacobian());
    let (forcing, bias) = (by_hand.forcing(), by_hand.bias());
    for i in 0..N {
        let inertia = (0..N).map(|j| mass[(i, j)] * accelerations[j]);
        let constraint = (0..M).map(|a| -jacobian[(a, i)] * multipliers[a]);
        let terms: Vec<f64> = inertia.chain(constraint).chain([-forcing[i]]).collect();
        worst.vanishes(&format!("the equation of {} in {}", S::COORDINATES[i], S::NAME), &terms);
    }
    for a in 0..M {
        let terms = (0..N).map(|j| jacobian[(a, j)] * accelerations[j]);
        let terms: Vec<f64> = terms.chain([bias[a]]).collect();
        worst.vanishes(&format!("the constraint {} of {}", S::CONSTRAINTS[a], S::NAME), &terms);
    }
    true
}
