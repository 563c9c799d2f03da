//! Round bodies rolling down an incline without slipping: Milton (8.8)–(8.10).
//!
//! L = m/2 ẋ² + I/2 φ̇² + m g x sin α with ẋ − a φ̇ = 0 and I = k m a² gives
//! ẍ = g sin α / (1 + k) and λ = −k/(1 + k) m g sin α: friction points up the slope.

use approx::assert_relative_eq;
use lagrange_core::prelude::*;

macro_rules! rolling_body {
    ($name:ident, $k:expr) => {
        #[derive(Lagrangian)]
        #[coordinates(x, phi)]
        #[define(inertia = $k * m * a^2)]
        #[lagrangian(m/2 * x_dot^2 + inertia/2 * phi_dot^2 + m*g*x*sin(alpha))]
        #[constraint(no_slip: x_dot - a*phi_dot = 0)]
        #[observable(friction = lambda(no_slip))]
        struct $name {
            m: f64,
            a: f64,
            g: f64,
            alpha: f64,
        }
    };
}

rolling_body!(Sphere, 2 / 5);
rolling_body!(Shell, 2 / 3);
rolling_body!(Cylinder, 1 / 2);
rolling_body!(Hoop, 1);

/// The acceleration and the friction are these fractions of g sin α and of m g sin α, and the motion from
/// rest is the parabola that follows.
macro_rules! check {
    ($name:ident, $acceleration:expr, $friction:expr) => {
        for (m, a, g, alpha) in [(1.0, 0.1, 9.81, 0.3), (2.5, 0.07, 1.62, 1.1), (0.01, 3.0, 24.8, 0.02)] {
            let body = $name { m, a, g, alpha };
            let slope = g * f64::sin(alpha);
            let start = State::new([0.3, -0.2], [0.0, 0.0]);
            let solution = body.solve(&start).unwrap();
            assert_relative_eq!(solution.accelerations[0], $acceleration * slope, max_relative = 1e-14);
            assert_relative_eq!(solution.accelerations[1], $acceleration * slope / a, max_relative = 1e-14);
            assert_relative_eq!(solution.multipliers[0], $friction * m * slope, max_relative = 1e-14);
            assert_relative_eq!(
                body.friction(&start, &solution),
                $friction * m * slope,
                max_relative = 1e-14
            );

            let path = body.integrate(start, 3.0, Dop853::with_tolerance(1e-12)).unwrap();
            let end = path.end();
            let exact = 0.3 + $acceleration * slope * 4.5;
            assert_relative_eq!(end.coordinate("x").unwrap(), exact, max_relative = 1e-12);
            assert_relative_eq!(
                end.multiplier("no_slip").unwrap(),
                $friction * m * slope,
                max_relative = 1e-14
            );
            let force = end.constraint_force("phi").unwrap();
            assert_relative_eq!(force, -a * $friction * m * slope, max_relative = 1e-14);
        }
    };
}

#[test]
fn sphere_8_10() {
    check!(Sphere, 5.0 / 7.0, -2.0 / 7.0);
}

#[test]
fn shell() {
    check!(Shell, 3.0 / 5.0, -2.0 / 5.0);
}

#[test]
fn cylinder() {
    check!(Cylinder, 2.0 / 3.0, -1.0 / 3.0);
}

#[test]
fn hoop() {
    check!(Hoop, 1.0 / 2.0, -1.0 / 2.0);
}

/// A body that already rolls keeps x − aφ as it was: the constraint is enforced as written, on velocities.
#[test]
fn the_offset_between_path_and_angle_stays() {
    let sphere = Sphere { m: 1.0, a: 0.1, g: 9.81, alpha: 0.3 };
    let start = State::new([1.0, 5.0], [0.2, 2.0]);
    let path = sphere.integrate(start, 3.0, Dop853::with_tolerance(1e-12)).unwrap();
    for sample in path.steps() {
        let [x, phi] = sample.state().q.data.0[0];
        assert_relative_eq!(x - 0.1 * phi, 0.5, epsilon = 1e-11);
    }
}
