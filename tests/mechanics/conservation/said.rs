//! `#[conserved(…)]`: what is true compiles, and stays as it was along the motion.

use lagrange_core::facts::{Evidence, Facts};
use lagrange_core::prelude::*;

fn names(facts: Facts) -> Vec<&'static str> {
    facts.conserved.iter().map(|found| found.name).collect()
}

/// The angular momentum, and the vector of Laplace, Runge and Lenz, which points to the pericentre.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[define(v = r_dot)]
#[lagrangian(m/2 * dot(v, v) + k/norm(r))]
#[conserved(momentum_of_rotation = cross(r, m*v))]
#[conserved(eccentricity = cross(v, momentum_of_rotation)/k - r/norm(r))]
#[observable(distance = norm(r))]
struct Planet {
    m: f64,
    k: f64,
}

#[test]
fn laplace_runge_lenz() {
    let vector = |name: &str| [0, 1, 2].map(|i| format!("{name}[{i}]"));
    assert_eq!(names(Planet::FACTS)[0], "energy");
    assert_eq!(names(Planet::FACTS)[1..4], vector("momentum_of_rotation"));
    assert_eq!(names(Planet::FACTS)[4..], vector("eccentricity"));
    assert!(Planet::FACTS.conserved[1..].iter().all(|found| found.evidence == Evidence::Held(8)));
    // It is an observable too.
    assert_eq!(Planet::OBSERVABLES.len(), 7);
    let planet = Planet { m: 1.0, k: 1.0 };
    let start = State::new([1.0, 0.0, 0.0], [0.0, 1.2, 0.3]);
    let path = planet.integrate(start, 20.0, Dop853::with_tolerance(1e-12)).unwrap();
    // Kepler: at the pericentre e = r v²/k − 1.
    let [x, y, z] = planet.eccentricity(path.end().state()).data.0[0];
    assert!((x - (1.2 * 1.2 + 0.3 * 0.3 - 1.0)).abs() < 1e-9 && y.abs() < 1e-9 && z.abs() < 1e-9);
    assert_eq!(path.end().conserved("eccentricity[0]").unwrap(), x);
    let text = Planet::equations().text();
    assert!(text.contains("eccentricity = (v×momentum_of_rotation)/k − r/|r|"), "{text}");
}

/// Milton (8.15)–(8.16): with the constraint.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(rod: 1/2*(x^2 + y^2 + z^2 - l^2) = 0)]
#[conserved(l_z = m*(x*y_dot - y*x_dot))]
// These two are conserved only where the velocities, and the coordinates, satisfy the constraint.
#[conserved(total = m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + m*g*z)]
#[conserved(nothing = x*(x^2 + y^2 + z^2 - l^2))]
struct SphericalPendulum {
    m: f64,
    g: f64,
    l: f64,
}

/// Whatever function U is, the angular momentum of a central force stays; so do the sums of momenta and of
/// angular momenta of two bodies.
struct Attraction;

impl Function<1, 1> for Attraction {
    fn eval<S: Scalar>(&self, [s]: [S; 1]) -> [S; 1] {
        [-S::constant(1.0) / s.sqrt()]
    }
}

#[derive(Lagrangian)]
#[coordinates(a: [3], b: [3])]
#[define(d = a - b)]
#[function(U(s) = u)]
#[lagrangian(m/2 * dot(a_dot, a_dot) + n/2 * dot(b_dot, b_dot) - U(dot(d, d)))]
#[conserved(total = m*a_dot + n*b_dot)]
#[conserved(spin = cross(a, m*a_dot) + cross(b, n*b_dot))]
#[conserved(centre = m*a + n*b - t*total)]
struct TwoBodies {
    m: f64,
    n: f64,
    u: Attraction,
}

#[test]
fn two_bodies() {
    let bodies = TwoBodies { m: 1.0, n: 2.0, u: Attraction };
    let start = State::new([1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.2, 0.1, 0.0, 0.0]);
    let path = bodies.integrate(start, 10.0, Dop853::with_tolerance(1e-12)).unwrap();
    let drift = path.drift();
    assert_eq!(drift.iter().count(), 10);
    assert!(drift.iter().all(|quantity| quantity.largest < 1e-10), "{drift}");
}

/// Of a set of dependent constraints the motion is determined, and so is what it conserves.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2))]
#[constraint(sphere: a*(x^2 + y^2 + z^2 - l^2) = 0)]
#[constraint(also: b*(x*x_dot + y*y_dot + z*z_dot) = 0)]
#[conserved(rotation = cross([x, y, z], [x_dot, y_dot, z_dot]))]
struct Redundant {
    m: f64,
    l: f64,
    a: f64,
    b: f64,
}

/// Rounding in this constraint leaves x − y uncertain by 1e-10, which is no reason to find anything broken.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2))]
#[constraint(equal: sqrt(x + far) = sqrt(y + far))]
#[parameter(far: 1_000_000..2_000_000)]
#[conserved(nothing = (x - y)*z)]
struct FarAway {
    m: f64,
    far: f64,
}

#[test]
fn constraints_decide_where_quantities_are_compared() {
    assert_eq!(names(SphericalPendulum::FACTS), ["energy", "l_z", "total", "nothing"]);
    assert_eq!(names(Redundant::FACTS), ["energy", "rotation[0]", "rotation[1]", "rotation[2]"]);
    assert_eq!(names(FarAway::FACTS), ["p_x", "p_y", "p_z", "energy", "nothing"]);
}
