//! Linear systems on constraint manifolds: of the right size, and with the eigenvalues of minimal coordinates.

use lagrange_core::nalgebra::{Complex, DMatrix};
use lagrange_core::{linearized::Stability, prelude::*};
use lagrange_systems::ChaplyginSleigh;

use crate::{PENDULUM, Pendulum, TOLERANCE, assert_spectrum, oscillations};

pub(crate) const G: f64 = 9.81;

#[test]
fn a_pendulum_in_cartesian_coordinates_has_two_degrees_of_freedom_in_its_state() {
    let pendulum = Pendulum { m: 3.0, l: 0.7, ..PENDULUM };
    let near = pendulum.linearize(&State::at_rest([0.0, -0.7]), &["push"]).unwrap();
    assert_eq!(near.a.shape(), (2, 2));
    let frequency = (G / 0.7_f64).sqrt();
    assert_spectrum(&near.eigenvalues().unwrap(), &oscillations(&[frequency]), TOLERANCE);
    // The force acts along the circle, and the bob feels it as if it were free.
    let push = &near.basis * &near.b;
    assert!((push - DMatrix::from_column_slice(4, 1, &[0.0, 0.0, 1.0 / 3.0, 0.0])).amax() < 1e-15);
    assert_eq!(near.states(), ["x", "y", "x_dot", "y_dot"]);
    is_orthonormal(&near.basis);

    let upright = pendulum.linearize(&State::at_rest([0.0, 0.7]), &[]).unwrap();
    let expected = [Complex::from(frequency), Complex::from(-frequency)];
    assert_spectrum(&upright.eigenvalues().unwrap(), &expected, TOLERANCE);
}

pub(crate) fn is_orthonormal(basis: &DMatrix<f64>) {
    let product = basis.tr_mul(basis);
    assert!((product - DMatrix::identity(basis.ncols(), basis.ncols())).amax() < 1e-14);
}

/// Straight ahead, ω̇ = −m a v ω/(I + m a²) (Bloch, *Nonholonomic Mechanics and Control*, 1.7); place, direction and
/// speed are free: a turned blade has a turned velocity.
#[test]
fn a_sleigh_is_stable_forwards_and_unstable_backwards() {
    let system = ChaplyginSleigh { m: 1.5, a: 0.4, inertia: 0.2 };
    for (speed, stability) in [(2.0_f64, Stability::Undecided), (-2.0, Stability::Unstable)] {
        let near = system.linearize(&State::new([1.0, 2.0, 0.0], [speed, 0.0, 0.0]), &[]).unwrap();
        assert_eq!((near.a.shape(), near.stability()), ((5, 5), Ok(stability)));
        assert_eq!(near.rate.as_slice(), [speed, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let growth = -1.5 * 0.4 * speed / (0.2 + 1.5 * 0.16);
        let eigenvalues = near.eigenvalues().unwrap();
        let fastest = eigenvalues.iter().max_by(|x, y| x.norm().total_cmp(&y.norm())).unwrap();
        assert!((fastest - growth).norm() < 1e-13, "{eigenvalues:?}");
        // The others are a multiple zero.
        assert!(eigenvalues.iter().filter(|s| s.norm() < 1e-4).count() == 4, "{eigenvalues:?}");
        // δẏ = v δθ, the velocity that turns with the blade.
        for change in near.basis.column_iter() {
            assert!((change[4] - speed * change[2]).abs() < 1e-14);
        }
    }
}
