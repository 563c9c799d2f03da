//! Noether: cyclic coordinates, their momenta and the energy of systems with known answers.

use lagrange_core::facts::{EnergyForm, Facts, LinearPart};
use lagrange_core::{facts::Evidence, prelude::*};

/// The names of what is conserved, for sure or in all random motions tried.
fn conserved(facts: Facts) -> Vec<&'static str> {
    facts.conserved.iter().map(|found| found.name).collect()
}

fn proved(facts: Facts) -> Vec<&'static str> {
    let proved = facts.conserved.iter().filter(|found| found.evidence == Evidence::Proved);
    proved.map(|found| found.name).collect()
}

#[derive(Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(m/2 * (r_dot^2 + r^2 * phi_dot^2) + k/r)]
struct Kepler {
    m: f64,
    k: f64,
}

#[test]
fn kepler() {
    assert_eq!(Kepler::FACTS.cyclic, ["phi"]);
    assert_eq!(proved(Kepler::FACTS), ["p_phi", "energy"]);
    assert_eq!(Kepler::FACTS.energy_is_conserved, Some(Evidence::Proved));
    assert_eq!(Kepler::FACTS.energy_form, EnergyForm::Even(Evidence::Proved));
    let text = Kepler::equations().text();
    assert!(
        text.contains("Conserved\n  p_φ = m r² φ̇\n  E = ½ m (ṙ² + r² φ̇²) − k/r   (T + U if U is −k/r)\n"),
        "{text}"
    );
    let state = State::new([2.0, 0.3], [0.1, 0.7]);
    let planet = Kepler { m: 1.5, k: 2.0 };
    assert_eq!(planet.conserved(0, &state), Some(1.5 * 4.0 * 0.7));
    assert_eq!(planet.conserved(1, &state), Some(planet.energy(&state)));
    assert_eq!(planet.conserved(2, &state), None);
}

/// Milton (8.23)–(8.25).
#[derive(Lagrangian)]
#[coordinates(theta, phi)]
#[lagrangian(m*l^2/2 * (theta_dot^2 + sin(theta)^2 * phi_dot^2) - m*g*l*cos(theta))]
struct SphericalPendulum {
    m: f64,
    l: f64,
    g: f64,
}

#[test]
fn spherical_pendulum() {
    assert_eq!(SphericalPendulum::FACTS.cyclic, ["phi"]);
    assert_eq!(proved(SphericalPendulum::FACTS), ["p_phi", "energy"]);
}

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2 * dot(r_dot, r_dot))]
struct Free {
    m: f64,
}

#[test]
fn free_particle() {
    assert_eq!(Free::FACTS.cyclic, ["r[0]", "r[1]", "r[2]"]);
    assert_eq!(proved(Free::FACTS), ["p_r[0]", "p_r[1]", "p_r[2]", "energy"]);
}

#[derive(Lagrangian)]
#[coordinates(theta)]
#[lagrangian(m*l^2/2 * theta_dot^2 + m*g*l*cos(theta))]
struct Pendulum {
    m: f64,
    l: f64,
    g: f64,
}

#[test]
fn pendulum() {
    assert!(Pendulum::FACTS.cyclic.is_empty());
    assert_eq!(proved(Pendulum::FACTS), ["energy"]);
}

/// The point of suspension is moved up and down.
#[derive(Lagrangian)]
#[coordinates(theta)]
#[lagrangian(m*l^2/2 * theta_dot^2 + m*l*(g - a*omega^2*cos(omega*t))*cos(theta))]
struct DrivenPendulum {
    m: f64,
    l: f64,
    g: f64,
    a: f64,
    omega: f64,
}

#[test]
fn a_driven_pendulum_does_not_conserve_its_energy() {
    assert!(conserved(DrivenPendulum::FACTS).is_empty());
    assert_eq!(DrivenPendulum::FACTS.energy_is_conserved, None);
    assert_eq!(DrivenPendulum::FACTS.energy_form, EnergyForm::Even(Evidence::Proved));
    assert!(DrivenPendulum::equations().conserved().is_empty());
    let energy = DrivenPendulum::equations().energy().to_string();
    assert!(
        energy.starts_with("E = ") && energy.contains("\nd/dt E = ") && energy.ends_with("(−∂L/∂t)"),
        "{energy}"
    );
}

/// In the gauge A = (−B y, 0, 0) the momentum along x is conserved.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - q*b*y*x_dot)]
struct Charge {
    m: f64,
    q: f64,
    b: f64,
}

#[test]
fn charge_in_a_magnetic_field() {
    assert_eq!(Charge::FACTS.cyclic, ["x", "z"]);
    assert_eq!(proved(Charge::FACTS), ["p_x", "p_z", "energy"]);
    // E = T, but T + U with U = q B y ẋ it is not.
    assert_eq!(Charge::FACTS.energy_form, EnergyForm::Quadratic);
    assert_eq!(Charge::FACTS.linear_part, LinearPart::Open);
}

/// A ball of radius a rolling on a table that turns at the rate Ω: no time appears, and the table does work.
#[derive(Lagrangian)]
#[coordinates(x, y, alpha, beta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + inertia/2 * (alpha_dot^2 + beta_dot^2))]
#[constraint(along_x: x_dot - a*beta_dot = -omega*y)]
#[constraint(along_y: y_dot + a*alpha_dot = omega*x)]
struct Turntable {
    m: f64,
    a: f64,
    inertia: f64,
    omega: f64,
}

#[test]
fn a_turntable_spoils_the_energy() {
    assert!(conserved(Turntable::FACTS).is_empty(), "{:?}", Turntable::FACTS);
    assert_eq!(Turntable::FACTS.energy_form, EnergyForm::Even(Evidence::Proved));
}

/// The same ball on a table at rest: friction acts at a point at rest, and in free rolling it is zero, which no
/// symbol shows.
#[derive(Lagrangian)]
#[coordinates(x, y, alpha, beta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + inertia/2 * (alpha_dot^2 + beta_dot^2))]
#[constraint(along_x: x_dot - a*beta_dot = 0)]
#[constraint(along_y: y_dot + a*alpha_dot = 0)]
struct Table {
    m: f64,
    a: f64,
    inertia: f64,
}

#[test]
fn a_table_at_rest_does_not() {
    assert!(Table::FACTS.cyclic.is_empty());
    assert_eq!(conserved(Table::FACTS), ["p_x", "p_y", "p_alpha", "p_beta", "energy"]);
    assert_eq!(proved(Table::FACTS), ["energy"]);
}

/// Without the constraint all three momenta would be conserved.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2))]
#[constraint(cylinder: x^2 + y^2 = a^2)]
struct OnACylinder {
    m: f64,
    a: f64,
}

#[test]
fn a_constraint_spoils_a_symmetry() {
    assert_eq!(OnACylinder::FACTS.cyclic, ["z"]);
    assert_eq!(proved(OnACylinder::FACTS), ["p_z", "energy"]);
    assert_eq!(conserved(OnACylinder::FACTS), ["p_z", "energy"]);
}

/// A constraint that depends on time does work; one whose inhomogeneous part does none keeps the energy.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(rail: y = a*sin(omega*t))]
struct MovingRail {
    m: f64,
    a: f64,
    omega: f64,
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(belt: y_dot = v)]
struct Belt {
    m: f64,
    v: f64,
}

#[test]
fn the_power_of_a_constraint_counts_and_not_its_form() {
    assert_eq!(conserved(MovingRail::FACTS), ["p_x"]);
    // The belt moves at a constant rate without any force: λ = 0, so that y's momentum is conserved too.
    assert_eq!(conserved(Belt::FACTS), ["p_x", "p_y", "energy"]);
    assert_eq!(proved(Belt::FACTS), ["p_x"]);
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - k/2 * x^2)]
#[dissipation(c/2 * x_dot^2)]
struct Damped {
    m: f64,
    k: f64,
    c: f64,
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[force(x: f)]
struct Pushed {
    m: f64,
    f: f64,
}

#[test]
fn forces_and_dissipation_count() {
    assert_eq!(Damped::FACTS.cyclic, ["y"]);
    assert_eq!(conserved(Damped::FACTS), ["p_y"]);
    // x is in L by its velocity only, and a force acts along it.
    assert_eq!(Pushed::FACTS.cyclic, ["y"]);
    assert_eq!(conserved(Pushed::FACTS), ["p_y"]);
}

/// However weak the damping is.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[dissipation(c/2 * x_dot^2)]
#[parameter(c: 0..1/1_000_000_000_000)]
struct WeaklyDamped {
    m: f64,
    k: f64,
    c: f64,
}

#[test]
fn weak_damping_counts() {
    assert!(conserved(WeaklyDamped::FACTS).is_empty());
}

/// Milton (8.44) with a constant Ω along z: E is conserved (8.48), and it is not T + U.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[define(v = r_dot)]
#[define(w = [0, 0, omega])]
#[lagrangian(m/2 * dot(v, v) + m/2 * dot(cross(w, r), cross(w, r)) + m * dot(v, cross(w, r)) - k/2 * r[2]^2)]
struct RotatingFrame {
    m: f64,
    omega: f64,
    k: f64,
}

#[test]
fn rotating_frame_8_48() {
    assert_eq!(conserved(RotatingFrame::FACTS), ["energy"]);
    assert_eq!(RotatingFrame::FACTS.energy_is_conserved, Some(Evidence::Proved));
    assert_eq!(RotatingFrame::FACTS.energy_form, EnergyForm::Quadratic);
    assert_eq!(RotatingFrame::FACTS.linear_part, LinearPart::Open);
    assert!(
        RotatingFrame::equations().energy().to_string().ends_with("(L₂ − L₀ by degree in the velocities)")
    );
}

/// A function that the user supplies.
struct Square;

impl Function<1, 1> for Square {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [x * x]
    }
}

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[function(U(z) = u)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - U(z))]
struct Layered {
    m: f64,
    u: Square,
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[function(K(t) = k)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - K(t)/2 * x^2)]
struct Modulated {
    m: f64,
    k: Square,
}

#[test]
fn functions_that_the_user_supplies() {
    assert_eq!(proved(Layered::FACTS), ["p_x", "p_y", "energy"]);
    assert_eq!(conserved(Modulated::FACTS), ["p_y"]);
}
