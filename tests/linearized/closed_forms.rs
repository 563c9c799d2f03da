//! Linear systems of textbooks, in coordinates without constraints.

use std::f64::consts::PI;

use lagrange_core::nalgebra::{Complex, DMatrix, dmatrix};
use lagrange_core::{linearized::Stability, prelude::*};
use lagrange_systems::{DoublePendulum, DrivenSpring};

use crate::{TOLERANCE, assert_close, assert_spectrum, oscillations};

/// The balance system of Åström and Murray, *Feedback Systems*: a pendulum upright on a cart, both with friction.
#[derive(Clone, Lagrangian)]
#[coordinates(p, theta)]
#[lagrangian((cart + m)/2*p_dot^2 - m*l*cos(theta)*p_dot*theta_dot + (inertia + m*l^2)/2*theta_dot^2
    - m*g*l*cos(theta))]
#[dissipation(c/2*p_dot^2 + gamma/2*theta_dot^2)]
#[force(p: force)]
struct Balance {
    cart: f64,
    m: f64,
    inertia: f64,
    l: f64,
    c: f64,
    gamma: f64,
    g: f64,
    force: f64,
}

#[test]
fn the_balance_system_is_that_of_the_textbook() {
    let Balance { cart, m, inertia, l, c, gamma, g, .. } = BALANCE;
    let (mt, jt) = (cart + m, inertia + m * l * l);
    let mu = mt * jt - (m * l).powi(2);
    let a = dmatrix![
        0.0, 0.0, 1.0, 0.0;
        0.0, 0.0, 0.0, 1.0;
        0.0, (m * l).powi(2) * g / mu, -c * jt / mu, -gamma * l * m / mu;
        0.0, mt * m * g * l / mu, -c * l * m / mu, -gamma * mt / mu;
    ];
    let b = dmatrix![0.0; 0.0; jt / mu; l * m / mu];
    let near = BALANCE.linearize(&State::at_rest([0.7, 0.0]), &["force"]).unwrap();
    assert_close(&near.a, &a);
    assert_close(&near.b, &b);
    assert_eq!(near.basis, DMatrix::identity(4, 4));
    assert_eq!(near.rate.as_slice(), [0.0; 4]);
    assert_eq!(near.states(), ["p", "theta", "p_dot", "theta_dot"]);
    assert_eq!(near.inputs(), ["force"]);
    assert_eq!(near.stability(), Ok(Stability::Unstable));
    // Hanging, it comes to rest, but anywhere.
    let hanging = BALANCE.linearize(&State::at_rest([0.7, PI]), &[]).unwrap();
    assert_eq!(hanging.stability(), Ok(Stability::Undecided));
    assert_eq!(hanging.b.shape(), (4, 0));
}

#[test]
fn a_linear_system_prints_its_names_and_numbers() {
    let near = BALANCE.linearize(&State::at_rest([0.7, 0.0]), &["force"]).unwrap();
    let expected = "\
ż = A z + B u

A                  p      theta      p_dot  theta_dot
p                  0          0     1.0000          0
theta              0          0          0     1.0000
p_dot              0     6.4000  -1.837e-3  -8.163e-5
theta_dot          0     7.2000  -8.163e-4  -9.184e-5

B             force
p                 0
theta             0
p_dot        0.0184
theta_dot  8.163e-3
";
    assert_eq!(near.to_string(), expected);
}

const BALANCE: Balance =
    Balance { cart: 10.0, m: 80.0, inertia: 100.0, l: 1.0, c: 0.1, gamma: 0.01, g: 9.8, force: 0.0 };

/// l₀ l₁ s⁴ + μ (l₀ + l₁) g s² + μ g² = 0 with μ = 1 + m₁/m₀; for equal rods and masses s² = −(2 ± √2) g/l.
#[test]
fn the_normal_modes_of_a_double_pendulum() {
    let system = DoublePendulum { m: [2.0, 0.7], l: [1.3, 0.4], g: 9.81 };
    let near = system.linearize(&State::at_rest([0.0; 2]), &[]).unwrap();
    let (ratio, [l0, l1], g) = (1.0 + 0.7 / 2.0, system.l, system.g);
    let (a, b, c) = (l0 * l1, ratio * (l0 + l1) * g, ratio * g * g);
    let root = (b * b - 4.0 * a * c).sqrt();
    let modes = [((b - root) / (2.0 * a)).sqrt(), ((b + root) / (2.0 * a)).sqrt()];
    assert_spectrum(&near.eigenvalues().unwrap(), &oscillations(&modes), TOLERANCE);
    for (frequency, mode) in near.natural_frequencies().unwrap().iter().zip(modes) {
        assert!((frequency - mode).abs() < 1e-13 * mode);
    }
    // Upright: the roots of the same equation with −g.
    let upright = system.linearize(&State::at_rest([PI; 2]), &[]).unwrap();
    let expected = modes.iter().flat_map(|&w| [Complex::from(w), Complex::from(-w)]).collect::<Vec<_>>();
    assert_spectrum(&upright.eigenvalues().unwrap(), &expected, TOLERANCE);
    assert!(upright.natural_frequencies().unwrap().is_empty());
}

/// A symmetric top on its tip, tilted about x by α, then about y by β, spinning by ψ about its axis: regular upright.
#[derive(Clone, Lagrangian)]
#[coordinates(alpha, beta, psi)]
#[lagrangian(i1/2*(alpha_dot^2*cos(beta)^2 + beta_dot^2) + i3/2*(psi_dot + alpha_dot*sin(beta))^2
    - m*g*l*cos(alpha)*cos(beta))]
struct Top {
    i1: f64,
    i3: f64,
    m: f64,
    g: f64,
    l: f64,
}

/// I₁ z̈ − i I₃ω ż − m g l z = 0 for z = α + iβ (Goldstein, *Classical Mechanics*, 5.7): stable where
/// I₃²ω² > 4 m g l I₁.
#[test]
fn a_top_sleeps_where_it_spins_fast() {
    let top = Top { i1: 0.3, i3: 0.1, m: 1.2, g: 9.81, l: 0.25 };
    let weight = top.m * top.g * top.l;
    let critical = (4.0 * weight * top.i1).sqrt() / top.i3;
    for (part, stability) in [(0.99, Stability::Unstable), (1.01, Stability::Undecided)] {
        let spin = part * critical;
        let upright = State::new([0.0, 0.0, 0.4], [0.0, 0.0, spin]);
        let near = top.linearize(&upright, &[]).unwrap();
        assert_eq!(near.stability(), Ok(stability), "at {part} of the critical spin");
        let (b, i) = (top.i3 * spin, Complex::<f64>::i());
        let root = Complex::from(b * b - 4.0 * top.i1 * weight).sqrt();
        let s = [i * (b + root) / (2.0 * top.i1), i * (b - root) / (2.0 * top.i1)];
        let zero = Complex::from(0.0);
        // Of the spin, which is cyclic.
        let expected = [s[0], s[0].conj(), s[1], s[1].conj(), zero, zero];
        // The pairs are √0.02 apart: near a double eigenvalue round-off counts ten times.
        assert_spectrum(&near.eigenvalues().unwrap(), &expected, 10.0 * TOLERANCE);
    }
}

/// Two springs, of which the slower one is damped: |s| = √k of both.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - x^2/2 - 2*y^2)]
#[dissipation(x_dot^2/10)]
struct Springs;

#[test]
fn natural_frequencies_ascend_whatever_decays_first() {
    let near = Springs.linearize(&State::at_rest([0.0; 2]), &[]).unwrap();
    let found = near.natural_frequencies().unwrap();
    assert!((found[0] - 1.0).abs() < 1e-14 && (found[1] - 2.0).abs() < 1e-14, "{found:?}");
}

/// Underdamped, overdamped, driven apart: ẍ + 2δẋ + k x = 0.
#[test]
fn damping_decides_the_stability() {
    let near = |k, delta| {
        let spring = DrivenSpring { m: 1.0, k, c: 2.0 * delta, a: 0.0, w: 0.0 };
        spring.linearize(&State::at_rest([0.0]), &[]).unwrap()
    };
    let damped = near(4.0, 0.1);
    assert_eq!(damped.stability(), Ok(Stability::AsymptoticallyStable));
    let decay = Complex::new(-0.1, 3.99_f64.sqrt());
    assert_spectrum(&damped.eigenvalues().unwrap(), &[decay, decay.conj()], TOLERANCE);
    assert!((damped.natural_frequencies().unwrap()[0] - 2.0).abs() < 1e-14);
    assert_eq!(near(4.0, 3.0).stability(), Ok(Stability::AsymptoticallyStable));
    assert!(near(4.0, 3.0).natural_frequencies().unwrap().is_empty());
    assert_eq!(near(4.0, -0.1).stability(), Ok(Stability::Unstable));
    assert_eq!(near(4.0, 0.0).stability(), Ok(Stability::Undecided));
    assert_eq!(near(0.0, 0.0).stability(), Ok(Stability::Undecided));
}

/// However far the unit of time is from a period: for equal rods and masses s² = −(2 ± √2) g/l.
#[test]
fn fast_and_slow_oscillations_are_found_alike() {
    for g in [1e-200, 1e-20, 1e-14, 1.0, 1e14, 1e20, 1e200] {
        let system = DoublePendulum { m: [1.0; 2], l: [1.0; 2], g };
        let near = system.linearize(&State::at_rest([0.0; 2]), &[]).unwrap();
        assert_eq!(near.stability(), Ok(Stability::Undecided), "g = {g:e}");
        let expected = oscillations(&[2.0 - 2.0_f64.sqrt(), 2.0 + 2.0_f64.sqrt()].map(|s| (s * g).sqrt()));
        assert_spectrum(&near.eigenvalues().unwrap(), &expected, TOLERANCE);
    }
}
