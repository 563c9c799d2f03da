//! Noether: cyclic coordinates, their momenta and the energy of systems with known answers.

use lagrange_core::facts::{EnergyForm, Evidence, Facts, Integrals, LinearPart};
use lagrange_core::prelude::*;

/// Compares the cyclic coordinates, what is conserved for sure, and what in all random motions tried beside that.
#[track_caller]
fn check(facts: Facts, cyclic: &[&str], proved: &[&str], tried: &[&str]) {
    let names = |sure: bool| -> Vec<&str> {
        let found = facts.conserved.iter().filter(|found| (found.evidence == Evidence::Proved) == sure);
        found.map(|found| found.name).collect()
    };
    assert_eq!((facts.cyclic, &names(true)[..], &names(false)[..]), (cyclic, proved, tried));
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
    check(Kepler::FACTS, &["phi"], &["p_phi", "energy"], &[]);
    assert_eq!(Kepler::FACTS.energy_is_conserved, Some(Evidence::Proved));
    assert_eq!(Kepler::INTEGRALS, Some(Integrals::VOID));
    assert_eq!(Kepler::FACTS.energy_form, EnergyForm::Even(Evidence::Proved));
    let text = Kepler::equations().text();
    let expected = "Conserved\n  p_φ = m r² φ̇\n  E = ½ m (ṙ² + r² φ̇²) − k/r   (T + U if U is −k/r)\n";
    assert!(text.contains(expected), "{text}");
    let state = State::new([2.0, 0.3], [0.1, 0.7]);
    let planet = Kepler { m: 1.5, k: 2.0 };
    assert_eq!(planet.conserved(0, &state), Some(1.5 * 4.0 * 0.7));
    assert_eq!(planet.conserved(1, &state), Some(planet.energy(&state)));
    assert_eq!(planet.conserved(2, &state), None);
}

/// Three bodies that attract each other.
#[derive(Lagrangian)]
#[coordinates(r: [3, 3])]
#[define(pair(i, j) = gamma*m[i]*m[j]/norm(r[i] - r[j]))]
#[lagrangian(sum(i in 0..3, m[i]/2 * dot(r_dot[i], r_dot[i])) + pair(0, 1) + pair(0, 2) + pair(1, 2))]
struct Bodies {
    m: [f64; 3],
    gamma: f64,
}

/// Momentum and angular momentum are sums by hand, and stay constant along a motion.
#[test]
fn bodies_have_a_momentum_and_an_angular_momentum() {
    let names = ["momentum[0]", "momentum[1]", "momentum[2]"];
    let angular = ["angular_momentum[0]", "angular_momentum[1]", "angular_momentum[2]"];
    check(Bodies::FACTS, &[], &[&names[..], &angular, &["energy"]].concat(), &[]);
    let bodies = Bodies { m: [1.0, 0.8, 0.3], gamma: 1.0 };
    let place = |i: usize| [[0.0, 0.1, -0.2], [2.0, 0.0, 0.3], [-1.0, 3.0, 0.5]][i];
    let speed = |i: usize| [[0.1, -0.3, 0.2], [-0.2, 0.6, 0.1], [0.3, 0.2, -0.5]][i];
    let flat = |of: &dyn Fn(usize) -> [f64; 3]| std::array::from_fn(|k| of(k / 3)[k % 3]);
    let state: State<f64, 9> = State::new(flat(&place), flat(&speed));
    for k in 0..3 {
        let [i, j] = [(k + 1) % 3, (k + 2) % 3];
        let linear: f64 = (0..3).map(|a| bodies.m[a] * speed(a)[k]).sum();
        let angular: f64 =
            (0..3).map(|a| bodies.m[a] * (place(a)[i] * speed(a)[j] - place(a)[j] * speed(a)[i])).sum();
        for (index, expected) in [(k, linear), (k + 3, angular)] {
            let value = bodies.conserved(index, &state).expect("a quantity");
            assert!((value - expected).abs() < 1e-14, "{value} is not {expected}");
        }
    }
    let path = bodies.integrate(state, 5.0, Dop853::with_tolerance(1e-12)).expect("a motion");
    let end = *path.end().state();
    for index in 0..6 {
        let [before, after] = [&state, &end].map(|state| bodies.conserved(index, state).expect("a quantity"));
        assert!((before - after).abs() < 1e-10, "{index}: {before} becomes {after}");
    }
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
    check(DrivenPendulum::FACTS, &[], &[], &[]);
    assert_eq!(DrivenPendulum::FACTS.energy_is_conserved, None);
    assert_eq!(DrivenPendulum::FACTS.energy_form, EnergyForm::Even(Evidence::Proved));
    assert!(DrivenPendulum::equations().conserved().is_empty());
    let energy = DrivenPendulum::equations().energy().to_string();
    let parts = energy.starts_with("E = ") && energy.contains("\nd/dt E = ") && energy.ends_with("(−∂L/∂t)");
    assert!(parts, "{energy}");
}

/// In the gauge A = (−B y, 0, 0) the momentum along x is conserved.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2 * dot(r_dot, r_dot) - q*b*r[1]*r_dot[0])]
struct Charge {
    m: f64,
    q: f64,
    b: f64,
}

#[test]
fn charge_in_a_magnetic_field() {
    check(Charge::FACTS, &["r[0]", "r[2]"], &["p_r[0]", "p_r[2]", "energy"], &[]);
    // E = T, but T + U with U = q B y ẋ it is not.
    assert_eq!(Charge::FACTS.energy_form, EnergyForm::Quadratic);
    assert_eq!(Charge::FACTS.linear_part, LinearPart::Open);
}

macro_rules! ball {
    ($(#[$doc:meta])* $name:ident { $($omega:ident)? }: $x:expr, $y:expr) => {
        $(#[$doc])*
        #[derive(Lagrangian)]
        #[coordinates(x, y, alpha, beta)]
        #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + inertia/2 * (alpha_dot^2 + beta_dot^2))]
        #[constraint(along_x: x_dot - a*beta_dot = $x)]
        #[constraint(along_y: y_dot + a*alpha_dot = $y)]
        struct $name {
            m: f64,
            a: f64,
            inertia: f64,
            $($omega: f64,)?
        }
    };
}

ball!(
    /// A ball of radius a rolling on a table that turns at the rate Ω: no time appears, and the table does work.
    Turntable { omega }: -omega * y, omega * x
);
ball!(
    /// The same ball on a table at rest: friction acts at a point at rest, and in free rolling it is zero, which no
    /// symbol shows.
    Table {}: 0, 0
);

#[test]
fn a_turntable_spoils_the_energy_and_a_table_at_rest_does_not() {
    assert!(Turntable::FACTS.conserved.is_empty(), "{:?}", Turntable::FACTS);
    assert_eq!(Turntable::FACTS.energy_form, EnergyForm::Even(Evidence::Proved));
    check(Table::FACTS, &[], &["energy"], &["p_x", "p_y", "p_alpha", "p_beta"]);
}

/// Declares a particle of mass 1 in the plane or in space.
macro_rules! particle {
    ($name:ident { $($field:ident: $type:ident),* } ($($x:ident),*): $kinetic:expr, $(#[$attribute:meta])*) => {
        #[derive(Lagrangian)]
        #[coordinates($($x),*)]
        #[lagrangian($kinetic)]
        $(#[$attribute])*
        struct $name {
            $($field: $type),*
        }
    };
}

/// A function that the user supplies.
struct Square;

impl Function<1, 1> for Square {
    fn eval<S: Scalar>(&self, [x]: [S; 1]) -> [S; 1] {
        [x * x]
    }
}

particle!(OnACylinder { a: f64 } (x, y, z): (x_dot^2 + y_dot^2 + z_dot^2)/2, #[constraint(cylinder: x^2 + y^2 = a^2)]);
particle!(MovingRail { a: f64 } (x, y): (x_dot^2 + y_dot^2)/2, #[constraint(rail: y = a*sin(t))]);
particle!(Belt { v: f64 } (x, y): (x_dot^2 + y_dot^2)/2, #[constraint(belt: y_dot = v)]);
particle!(Pushed { f: f64 } (x, y): (x_dot^2 + y_dot^2)/2, #[force(x: f)]);
particle!(WeaklyDamped { k: f64, c: f64 } (x): (x_dot^2 - k*x^2)/2,
    #[dissipation(c/2 * x_dot^2)] #[parameter(c: 0..1/1_000_000_000_000)]);
particle!(Layered { u: Square } (x, y, z): (x_dot^2 + y_dot^2 + z_dot^2)/2 - U(z), #[function(U(z) = u)]);
particle!(Modulated { k: Square } (x, y): (x_dot^2 + y_dot^2)/2 - K(t)/2 * x^2, #[function(K(t) = k)]);

#[test]
fn constraints_forces_and_dissipation_spoil_symmetries() {
    // Without the constraint all three momenta would be conserved.
    check(OnACylinder::FACTS, &["z"], &["p_z", "energy"], &[]);
    // A constraint that depends on time does work; one whose inhomogeneous part does none keeps the energy.
    check(MovingRail::FACTS, &["x"], &["p_x"], &[]);
    // The belt moves at a constant rate without any force: λ = 0, so that y's momentum is conserved too.
    check(Belt::FACTS, &["x"], &["p_x"], &["p_y", "energy"]);
    // x is in L by its velocity only, and a force acts along it.
    check(Pushed::FACTS, &["y"], &["p_y"], &[]);
    // However weak the damping is.
    check(WeaklyDamped::FACTS, &[], &[], &[]);
}

#[test]
fn functions_that_the_user_supplies() {
    check(Layered::FACTS, &["x", "y"], &["p_x", "p_y", "energy"], &[]);
    check(Modulated::FACTS, &["y"], &["p_y"], &[]);
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
    check(RotatingFrame::FACTS, &[], &["angular_momentum[2]", "energy"], &[]);
    assert_eq!(RotatingFrame::FACTS.energy_form, EnergyForm::Quadratic);
    assert_eq!(RotatingFrame::FACTS.linear_part, LinearPart::Open);
    let energy = RotatingFrame::equations().energy().to_string();
    assert!(energy.ends_with("(L₂ − L₀ by degree in the velocities)"), "{energy}");
}
