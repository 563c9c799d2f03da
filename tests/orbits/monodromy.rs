//! Monodromy matrices against the symplectic condition, and against closed forms.

use std::f64::consts::TAU;

use lagrange_core::nalgebra::DMatrix;
use lagrange_core::prelude::*;
use lagrange_systems::{DrivenSpring, HenonHeiles, PolarPendulum, SphericalPendulum};

use crate::systems::{DRIVEN, Saddle};

fn method() -> Dop853 {
    Dop853::with_tolerance(1e-14)
}

/// J of the canonical condition Mᵀ J M = J.
fn canonical(n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i + n == j, j + n == i) {
        (true, _) => 1.0,
        (_, true) => -1.0,
        _ => 0.0,
    })
}

/// Momenta that depend on coordinates: p_φ = r² φ̇ + r², with a field along the axis.
#[derive(Clone, Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian((r_dot^2 + r^2*phi_dot^2)/2 + r^2*phi_dot + r^3*phi*phi_dot/5 + 1/r - r_dot*phi^2/3 + cos(t)*r/5)]
struct InAField;

#[test]
fn canonical_in_momenta() {
    let start = State::new([1.0, 0.3], [0.2, 0.9]);
    let moved = InAField.monodromy(&start, 5.0, method()).unwrap();
    assert!(moved.symplectic_error() < 1e-12, "{:e}", moved.symplectic_error());
    assert!(moved.is_symplectic());
    let (m, j) = (moved.matrix_in_momenta().unwrap(), canonical(2));
    let off = (m.tr_mul(&(&j * &m)) - j).amax() / m.amax().powi(2);
    assert!(off < 1e-10, "{off:e}");
    // In velocities it is not.
    let (m, j) = (moved.matrix(), canonical(2));
    assert!((m.tr_mul(&(&j * &m)) - j).amax() > 0.1);
}

/// Once about a cone: ψ″ = −(Ω² (1 + 3 cos² θ)/…) in closed form is ω² = g (1 + 3 cos² θ)/(l cos θ) for the nutation.
#[test]
fn cone_of_a_spherical_pendulum() {
    let (g, l, theta) = (9.81, 0.7, 0.6_f64);
    let rate = (g / (l * theta.cos())).sqrt();
    let period = TAU / rate;
    let pendulum = SphericalPendulum { m: 0.3, g, l };
    let (x, z) = (l * theta.sin(), -l * theta.cos());
    let start = State::new([x, 0.0, z], [0.0, x * rate, 0.0]);
    let around = pendulum.monodromy(&start, period, method()).unwrap();
    assert_eq!(around.matrix().shape(), (4, 4));
    assert!(around.symplectic_error() < 1e-12, "{:e}", around.symplectic_error());
    let nutation = (g * (1.0 + 3.0 * theta.cos().powi(2)) / (l * theta.cos())).sqrt() * period;
    let trace = 2.0 + 2.0 * nutation.cos();
    assert!((around.matrix().trace() - trace).abs() < 1e-10);
    let start = State::new([theta, 0.0], [0.0, rate]);
    let same = PolarPendulum { m: 1.0, g, l }.monodromy(&start, period, method()).unwrap();
    assert!((same.matrix().trace() - trace).abs() < 1e-10);
    // And it is found from nearby.
    let guess = State::new([x, 0.0, z], [0.0, x * rate * 1.001, 0.0]);
    let cone = pendulum.periodic_orbit(&guess).period(period).segments(4).find().unwrap();
    assert!((cone.start.q[2] - z).abs() < 1e-9, "{}", cone.start);
    assert!(cone.gap < 1e-11 && cone.error < 1e-11, "{:e} {:e}", cone.gap, cone.error);
    let index = cone.stability_indices().unwrap()[0];
    assert!((index.re - nutation.cos()).abs() < 1e-8, "{index}");
    assert!(cone.monodromy.symplectic_error() < 1e-12);
}

/// Multipliers are exp(s T) of s² + c s + 4 = 0, and friction is not symplectic: det = exp(−c T).
#[test]
fn friction_shows() {
    let (c, t) = (0.3_f64, 2.0);
    let moved =
        DrivenSpring { k: 4.0, c, ..DRIVEN }.monodromy(&State::new([1.0], [0.0]), t, method()).unwrap();
    assert!(!moved.is_symplectic());
    let exact = (4.0 - c * c / 4.0).sqrt();
    for s in moved.exponents().unwrap() {
        assert!((s.re + c / 2.0).abs() < 1e-12);
        let turned = |x: f64| x.rem_euclid(TAU / t);
        assert!([s.im, -s.im].iter().any(|im| (turned(*im) - turned(exact)).abs() < 1e-12), "{s}");
    }
    assert!((moved.matrix().determinant() - (-c * t).exp()).abs() < 1e-12);
}

/// A motion that takes no time has multipliers, all 1, and no exponents.
#[test]
fn no_time_has_no_exponents() {
    let moved = DRIVEN.monodromy(&State::new([1.0], [0.0]), 0.0, method()).unwrap();
    assert!(moved.multipliers().unwrap().iter().all(|x| x.re == 1.0 && x.im == 0.0));
    let said = moved.exponents().unwrap_err().to_string();
    assert_eq!(said, "the duration of the motion is 0: it must be positive and finite");
}

/// A saddle of rate k: multipliers exp(± k T), reciprocals to the last digit though their ratio is 10¹⁷.
#[test]
fn pairs_are_reciprocal() {
    let saddle = Saddle { h: 4.0, k: 1.0, a: 0.0, c: 0.0 };
    let moved = saddle.monodromy(&State::new([0.0, 0.0], [0.0, 0.0]), 10.0, method()).unwrap();
    let found = moved.multipliers().unwrap();
    assert!((found[0].re * (-20.0_f64).exp() - 1.0).abs() < 1e-11);
    assert!((found[1].re * found[0].re - 1.0).abs() < 1e-15);
    assert!((found[2].re - 10.0_f64.cos()).abs() < 1e-11 && (found[2].norm() - 1.0).abs() < 1e-15);
}

#[test]
fn a_monodromy_needs_derivatives_by_every_entry() {
    let start = State::new([0.0, 0.1], [0.35, 0.1]);
    let motion = HenonHeiles.integrate_sensitivities(start, 1.0, method(), &["x", "y", "x_dot"]).unwrap();
    let error =
        HenonHeiles.monodromy_across(&start, motion.derivatives_at_end().unwrap()).unwrap_err().to_string();
    assert!(error.contains("y_dot"), "{error}");
}
