//! Derivatives where all coordinates, velocities and the time are zero.

use lagrange_core::prelude::*;

use crate::by_hand::check_at_origin;
use crate::{constrained::*, fields::*, particles::*, pendulums::*};

#[test]
fn pendulums() {
    check_at_origin::<SphericalPendulum, 3, 1>();
    check_at_origin::<PolarPendulum, 2, 0>();
    check_at_origin::<DoublePendulum, 2, 0>();
    check_at_origin::<ElasticPendulum, 2, 0>();
    check_at_origin::<SwingingAtwood, 3, 1>();
    check_at_origin::<DrivenPendulum, 1, 0>();
    check_at_origin::<Chain, 5, 0>();
    check_at_origin::<StringOfMasses, 6, 0>();
}

#[test]
fn particles() {
    check_at_origin::<Relativistic, 2, 0>();
    check_at_origin::<MagneticField, 3, 0>();
    check_at_origin::<Driven, 3, 0>();
    check_at_origin::<RotatingFrame, 3, 0>();
    check_at_origin::<Coupled, 3, 2>();
}

#[test]
fn constraints() {
    check_at_origin::<RollingSphere, 2, 1>();
    check_at_origin::<BeadOnWire, 3, 2>();
    check_at_origin::<ChaplyginSleigh, 3, 1>();
    check_at_origin::<Turntable, 5, 2>();
    check_at_origin::<BeadOnCurve, 2, 1>();
}

/// At the pole the azimuth has no inertia.
#[test]
fn a_singular_mass_matrix_shows_in_the_pivot() {
    let pendulum = PolarPendulum { m: 1.0, g: 1.0, l: 1.0 };
    let pivot = pendulum.accelerations_unchecked(&State::at_rest([0.0, 0.0])).pivot;
    assert!(pivot.is_nan() || pivot <= 0.0, "{pivot}");
}

/// A force law with the exponent as a parameter: F = −k n xⁿ⁻¹ is finite where the spring is relaxed.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k * x^n)]
struct Spring {
    m: f64,
    k: f64,
    n: f64,
}

#[test]
fn a_power_with_a_parameter_as_exponent_has_a_derivative_at_zero() {
    let spring = Spring { m: 1.0, k: 3.0, n: 2.0 };
    assert_eq!(spring.forcing(&State::at_rest([0.0]))[0], 0.0);
    assert_eq!(spring.forcing(&State::at_rest([-0.5]))[0], 3.0);
}
