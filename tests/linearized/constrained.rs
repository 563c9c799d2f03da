//! Linear systems on constraint manifolds: of the right size, and with the eigenvalues of minimal coordinates.

use lagrange_core::nalgebra::{Complex, DMatrix};
use lagrange_core::{linearized::Stability, prelude::*};

use crate::{TOLERANCE, assert_spectrum, oscillations};

const G: f64 = 9.81;

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: x^2 + y^2 = l^2)]
#[force(x: push)]
struct Pendulum {
    m: f64,
    g: f64,
    l: f64,
    push: f64,
}

const PENDULUM: Pendulum = Pendulum { m: 3.0, g: G, l: 0.7, push: 0.0 };

#[test]
fn a_pendulum_in_cartesian_coordinates_has_two_degrees_of_freedom_in_its_state() {
    let near = PENDULUM.linearize(&State::at_rest([0.0, -0.7]), &["push"]).unwrap();
    assert_eq!(near.a.shape(), (2, 2));
    let frequency = (G / 0.7_f64).sqrt();
    assert_spectrum(&near.eigenvalues().unwrap(), &oscillations(&[frequency]), TOLERANCE);
    // The force acts along the circle, and the bob feels it as if it were free.
    let push = &near.basis * &near.b;
    assert!((push - DMatrix::from_column_slice(4, 1, &[0.0, 0.0, 1.0 / 3.0, 0.0])).amax() < 1e-15);
    assert_eq!(near.states(), ["x", "y", "x_dot", "y_dot"]);
    is_orthonormal(&near.basis);

    let upright = PENDULUM.linearize(&State::at_rest([0.0, 0.7]), &[]).unwrap();
    let expected = [Complex::from(frequency), Complex::from(-frequency)];
    assert_spectrum(&upright.eigenvalues().unwrap(), &expected, TOLERANCE);
}

fn is_orthonormal(basis: &DMatrix<f64>) {
    let product = basis.tr_mul(basis);
    assert!((product - DMatrix::identity(basis.ncols(), basis.ncols())).amax() < 1e-14);
}

/// The second constraint says nothing new where the first one holds.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: x^2 + y^2 = l^2)]
#[constraint(again: (2 + x)*(x^2 + y^2 - l^2) = 0)]
struct Overdetermined {
    m: f64,
    g: f64,
    l: f64,
}

#[test]
fn constraints_that_depend_on_one_another_count_once() {
    let system = Overdetermined { m: 3.0, g: G, l: 0.7 };
    let near = system.linearize(&State::at_rest([0.0, -0.7]), &[]).unwrap();
    assert_spectrum(&near.eigenvalues().unwrap(), &oscillations(&[(G / 0.7_f64).sqrt()]), TOLERANCE);
    let jacobian = system.jacobian(&State::at_rest([0.0, -0.7])).unwrap();
    assert_eq!(jacobian.solution.rank, 1);
}

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2*dot(r_dot, r_dot) - m*g*r[2])]
#[constraint(string: dot(r, r) = l^2)]
struct SphericalPendulum {
    m: f64,
    g: f64,
    l: f64,
}

#[test]
fn a_spherical_pendulum_swings_alike_both_ways() {
    let system = SphericalPendulum { m: 0.5, g: G, l: 2.0 };
    let near = system.linearize(&State::at_rest([0.0, 0.0, -2.0]), &[]).unwrap();
    let frequency = (G / 2.0_f64).sqrt();
    assert_spectrum(&near.eigenvalues().unwrap(), &oscillations(&[frequency; 2]), TOLERANCE);
}

/// Two links in a wind that pushes the lower bob, with friction of the air, in angles …
#[derive(Clone, Lagrangian)]
#[coordinates(a, b)]
#[define(first = l[0]*[sin(a), -cos(a)])]
#[define(second = first + l[1]*[sin(b), -cos(b)])]
#[lagrangian(m[0]/2*dot(der(first), der(first)) + m[1]/2*dot(der(second), der(second))
    - g*(m[0]*first[1] + m[1]*second[1]))]
#[dissipation(c/2*(dot(der(first), der(first)) + dot(der(second), der(second))))]
#[force(a: wind*l[0]*cos(a))]
#[force(b: wind*l[1]*cos(b))]
struct Angles {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
    c: f64,
    wind: f64,
}

/// … and in Cartesian coordinates.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [2], s: [2])]
#[lagrangian(m[0]/2*dot(r_dot, r_dot) + m[1]/2*dot(s_dot, s_dot) - g*(m[0]*r[1] + m[1]*s[1]))]
#[constraint(upper: dot(r, r) = l[0]^2)]
#[constraint(lower: dot(s - r, s - r) = l[1]^2)]
#[dissipation(c/2*(dot(r_dot, r_dot) + dot(s_dot, s_dot)))]
#[force(s: [wind, 0])]
struct Cartesian {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
    c: f64,
    wind: f64,
}

/// Where the wind holds the links at an angle, both have one spectrum, and pass the wind on alike.
#[test]
fn angles_and_cartesian_coordinates_give_one_spectrum() {
    let (m, l, g, c, wind) = ([1.0, 0.6], [0.8, 0.5], G, 0.4, 3.0);
    let angles = Angles { m, l, g, c, wind };
    let cartesian = Cartesian { m, l, g, c, wind };
    let by_angles = angles.equilibrium(&State::at_rest([0.1, 0.1]), &[]).unwrap();
    let guess = State::at_rest([0.1, -0.7, 0.2, -1.2]);
    let by_place = cartesian.equilibrium(&guess, &["r", "s"]).unwrap();
    // tan a = wind/((m₀ + m₁) g), tan b = wind/(m₁ g).
    let [a, b] = [(wind / (1.6 * G)).atan(), (wind / (0.6 * G)).atan()];
    assert!((by_angles.state.q - State::at_rest([a, b]).q).amax() < 1e-15);
    assert!((by_place.state.q[0] - 0.8 * a.sin()).abs() < 1e-15);
    assert!((by_place.state.q[3] + 0.8 * a.cos() + 0.5 * b.cos()).abs() < 1e-15);
    let near = angles.linearize(&by_angles.state, &["wind"]).unwrap();
    let on_manifold = cartesian.linearize(&by_place.state, &["wind"]).unwrap();
    assert_eq!(on_manifold.a.shape(), (4, 4));
    is_orthonormal(&on_manifold.basis);
    let expected = near.eigenvalues().unwrap();
    assert!(expected.iter().all(|s| s.re < -0.1 && s.im.abs() > 1.0), "{expected:?}");
    assert_spectrum(&on_manifold.eigenvalues().unwrap(), &expected, TOLERANCE);
    // The horizontal acceleration of the lower bob for a unit of wind.
    let lower = l[0] * a.cos() * near.b[(2, 0)] + l[1] * b.cos() * near.b[(3, 0)];
    assert!(((&on_manifold.basis * &on_manifold.b)[6] - lower).abs() < 1e-14);
}

/// A sphere on a spring that rolls on a level floor.
#[derive(Clone, Lagrangian)]
#[coordinates(x, phi)]
#[lagrangian(m/2*x_dot^2 + 2/5*m*a^2/2*phi_dot^2 - k/2*x^2)]
#[constraint(no_slip: x_dot - a*phi_dot = 0)]
struct RollingSphere {
    m: f64,
    a: f64,
    k: f64,
}

/// A velocity constraint takes one degree of freedom away from the state: here x − a φ stays what it is.
#[test]
fn a_sphere_that_rolls_on_a_spring() {
    let system = RollingSphere { m: 2.0, a: 0.1, k: 5.0 };
    let near = system.linearize(&State::at_rest([0.0, 1.0]), &[]).unwrap();
    assert_eq!(near.a.shape(), (3, 3));
    let mut expected = oscillations(&[(5.0 / (7.0 / 5.0 * 2.0_f64)).sqrt()]);
    expected.push(Complex::from(0.0));
    assert_spectrum(&near.eigenvalues().unwrap(), &expected, TOLERANCE);
}

/// The blade lets its point move along itself only; the centre of mass is ahead of it where a > 0.
#[derive(Lagrangian)]
#[coordinates(x, y, theta)]
#[define(velocity = der([x + a*cos(theta), y + a*sin(theta)]))]
#[lagrangian(m/2*dot(velocity, velocity) + inertia/2*theta_dot^2)]
#[constraint(blade: y_dot*cos(theta) - x_dot*sin(theta) = 0)]
struct ChaplyginSleigh {
    m: f64,
    a: f64,
    inertia: f64,
}

/// Straight ahead, ω̇ = −m a v ω/(I + m a²) (Bloch, *Nonholonomic Mechanics and Control*, 1.7); place, direction and
/// speed are free: a turned blade has a turned velocity.
#[test]
fn a_sleigh_is_stable_forwards_and_unstable_backwards() {
    let system = ChaplyginSleigh { m: 1.5, a: 0.4, inertia: 0.2 };
    for (speed, stability) in [(2.0, Stability::Undecided), (-2.0, Stability::Unstable)] {
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
