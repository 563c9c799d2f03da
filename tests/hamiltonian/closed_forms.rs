//! H and Hamilton's equations against their closed forms and against differences of H.

use lagrange_core::{StateOf, nalgebra::Const, prelude::*};

use crate::{Potential, Random, agree, gradient};
use lagrange_random::cases;
use lagrange_systems::{DrivenSpring, PolarPendulum, random_state};

/// A relativistic particle: nothing but the rest energy is quadratic in the momenta.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = potential)]
#[lagrangian(-m*c^2 * sqrt(1 - dot(r_dot, r_dot)/c^2) - U(r))]
pub(crate) struct Relativistic {
    pub(crate) m: f64,
    pub(crate) c: f64,
    pub(crate) potential: Potential,
}

/// Two angles whose kinetic energy couples them, time-dependent, with a term linear in the velocities.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(x_dot^2/2 + y_dot^2 + k*cos(x - y)*x_dot*y_dot + b*(x*y_dot - y*x_dot) + sin(t)*y_dot - x^4/4 - y^2*x)]
struct Coupled {
    k: f64,
    b: f64,
}

/// H(q, p(q, q̇)) = E(q, q̇), and back: q̇(q, p(q, q̇)) = q̇.
fn check_round_trip<L: Hamiltonian<Scalar = f64>>(system: &L, state: &StateOf<L>) {
    let phase = system.phase_state(state);
    agree(&[system.hamiltonian(&phase).unwrap()], &[system.energy(state)], 1e-12);
    agree(system.legendre(&phase).unwrap().v.as_slice(), state.v.as_slice(), 1e-12);
}

/// q̇ = ∂H/∂p and ṗ = −∂H/∂q, the derivatives by differences.
fn check_equations<L: Hamiltonian<N = Const<N>, M = Const<0>, Scalar = f64>, const N: usize>(
    system: &L,
    phase: &PhaseState<f64, N>,
) {
    let rate = system.hamilton_equations(phase).unwrap();
    let [by_q, by_p] = gradient(system, phase);
    agree(rate.q.as_slice(), &by_p, 1e-9);
    agree(rate.p.as_slice(), &by_q.map(|x| -x), 1e-9);
}

#[test]
fn coupled_coordinates_with_gyroscopic_terms() {
    let mut random = Random(1);
    let system = Coupled { k: 0.8, b: 0.7 };
    for _ in 0..cases([50, 200, 10_000]) {
        let state = random_state(&mut random);
        check_round_trip(&system, &state);
        check_equations(&system, &system.phase_state(&state));
    }
}

/// H = p_θ²/2ml² + p_φ²/(2ml² sin²θ) − m g l cos θ.
#[test]
fn pendulum_in_polar_coordinates() {
    let mut random = Random(2);
    let system = PolarPendulum { m: 1.3, l: 0.8, g: 9.81 };
    let PolarPendulum { m, l, g } = system;
    for _ in 0..cases([50, 200, 10_000]) {
        let q = [1.5 + random.number(), 3.0 * random.number()];
        let phase = PhaseState::new(q, random.vector());
        let ([theta, _], [p_theta, p_phi]) = (q, phase.p.into());
        let (sine, cosine, inertia) = (theta.sin(), theta.cos(), m * l * l);
        let h = (p_theta * p_theta + p_phi * p_phi / (sine * sine)) / (2.0 * inertia) - m * g * l * cosine;
        agree(&[system.hamiltonian(&phase).unwrap()], &[h], 1e-12);
        let rate = system.hamilton_equations(&phase).unwrap();
        agree(rate.q.as_slice(), &[p_theta / inertia, p_phi / (inertia * sine * sine)], 1e-12);
        let p_dot = p_phi * p_phi * cosine / (inertia * sine.powi(3)) - m * g * l * sine;
        agree(rate.p.as_slice(), &[p_dot, 0.0], 1e-12);
        check_equations(&system, &phase);
        check_round_trip(&system, &State::new(q, random.vector()));
    }
}

/// H = √(m²c⁴ + p²c²) + U from momenta of 10⁻³ m c to 10³ m c, where the speed is c to six digits, and
/// q̇ = p c²/√(m²c⁴ + p²c²).
#[test]
fn relativistic_particle() {
    let mut random = Random(3);
    let system = Relativistic { m: 0.7, c: 1.5, potential: Potential };
    let (m, c) = (system.m, system.c);
    for i in 0..300 {
        let q = random.vector();
        let size = m * c * 10_f64.powf(f64::from(i) / 50.0 - 3.0);
        let phase = PhaseState::new(q, random.vector::<3>().map(|x| size * x));
        let rest_and_motion = (m * m * c.powi(4) + phase.p.norm_squared() * c * c).sqrt();
        let [potential] = Function::eval(&Potential, q);
        agree(&[system.hamiltonian(&phase).unwrap()], &[rest_and_motion + potential], 1e-12);
        let velocity = phase.p * (c * c / rest_and_motion);
        let rate = system.hamilton_equations(&phase).unwrap();
        agree(rate.q.as_slice(), velocity.as_slice(), 1e-12);
        let force = system.momentum_rate(&State::at_rest(q));
        agree(rate.p.as_slice(), force.as_slice(), 1e-12);
    }
    let phase = PhaseState::new([0.2, -0.4, 0.3], [1.0, 2.0, -0.5]);
    check_equations(&system, &phase);
    check_round_trip(&system, &system.legendre(&phase).unwrap());
}

/// A generalized force enters ṗ and not H.
#[test]
fn forces_enter_the_rates_of_the_momenta() {
    let system = DrivenSpring { m: 2.0, k: 3.0, c: 0.25, a: 0.5, w: 1.0 };
    let phase = PhaseState::new([0.4], [1.2]).at_time(0.3);
    agree(&[system.hamiltonian(&phase).unwrap()], &[1.44 / 4.0 + 1.5 * 0.16], 1e-14);
    let p_dot = -3.0 * 0.4 + 0.5 * 0.3_f64.cos() - 0.25 * 0.6;
    agree(system.hamilton_equations(&phase).unwrap().p.as_slice(), &[p_dot], 1e-14);
}

/// Single precision, to its round-off.
#[test]
fn single_precision() {
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(-m*sqrt(1 - x_dot^2) - k/2 * x^2)]
    struct Single<T> {
        m: T,
        k: T,
    }
    let system = Single { m: 1.0_f32, k: 0.5 };
    let phase = PhaseState::new([2.0], [0.75]);
    assert!((system.hamiltonian(&phase).unwrap() - 2.25).abs() < 1e-6);
    assert!((system.hamilton_equations(&phase).unwrap().q[0] - 0.6).abs() < 1e-6);
    let path = system.motion_in_momenta(phase).by(Dopri5::with_tolerance(1e-5)).to(5.0).unwrap();
    assert!(path.ending().is_complete() && (path.end().energy() - 2.25).abs() < 1e-3);
}

/// The forms that are printed, at random (q, p): the inverse by Newton's method gives the same H and the same velocities.
#[test]
fn roots_and_powers_are_printed_in_closed_form() {
    #[derive(Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian(-m*c^2*sqrt(1 - (x_dot^2 + y_dot^2)/c^2) + e*B/2*(x*y_dot - y*x_dot) - e*E*x)]
    #[expect(non_snake_case, reason = "as they are written in the Lagrangian")]
    struct Charged {
        m: f64,
        c: f64,
        e: f64,
        B: f64,
        E: f64,
    }
    #[derive(Lagrangian)]
    #[coordinates(x)]
    #[lagrangian(a/4*(x_dot - w*x)^4 - k*x^2)]
    struct Quartic {
        a: f64,
        w: f64,
        k: f64,
    }
    let printed = [Charged::equations().hamiltonian(), Quartic::equations().hamiltonian()];
    let hamiltonians = [
        "H = √(c² ((p_x + ½ e B y)² + (p_y − ½ e B x)²) + m² c⁴) + e E x",
        "H = ¾ a (|p_x|/a)^(4/3) + w x p_x + k x²",
    ];
    assert_eq!(printed.map(|hamiltonian| hamiltonian.to_string()), hamiltonians);

    let mut random = Random(11);
    let (charged, quartic) =
        (Charged { m: 1.3, c: 2.0, e: 0.7, B: 0.9, E: 0.4 }, Quartic { a: 1.7, w: 0.6, k: 0.8 });
    for _ in 0..cases([50, 200, 10_000]) {
        let phase = PhaseState::new(random.vector::<2>(), random.vector::<2>());
        let Charged { m, c, e, B, E } = charged;
        let ([x, y], [p_x, p_y]): ([f64; 2], [f64; 2]) = (phase.q.into(), phase.p.into());
        let kinetic = [p_x + 0.5 * e * B * y, p_y - 0.5 * e * B * x];
        let root = (c * c * (kinetic[0].powi(2) + kinetic[1].powi(2)) + (m * c * c).powi(2)).sqrt();
        agree(&[charged.hamiltonian(&phase).unwrap()], &[e * E * x + root], 1e-12);
        let velocities = kinetic.map(|p| c * c * p / root);
        agree(charged.legendre(&phase).unwrap().v.as_slice(), &velocities, 1e-12);

        let Quartic { a, w, k } = quartic;
        let (x, p) = (random.number(), (1.0 + random.number().abs()).copysign(random.number()));
        let phase = PhaseState::new([x], [p]);
        let hamiltonian = w * x * p + k * x * x + 0.75 * a * (p.abs() / a).powf(4.0 / 3.0);
        agree(&[quartic.hamiltonian(&phase).unwrap()], &[hamiltonian], 1e-12);
        agree(quartic.legendre(&phase).unwrap().v.as_slice(), &[(p / a).cbrt() + w * x], 1e-12);
    }
}
