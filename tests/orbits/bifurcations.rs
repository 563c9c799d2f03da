//! Families of periodic orbits, and their bifurcations.

use std::f64::consts::{PI, TAU};

use lagrange_core::nalgebra::Complex;
use lagrange_core::orbits::{
    Bifurcation, BifurcationKind, Family, FamilyEnding, OrbitError, OrbitSearch, PeriodicOrbit,
};
use lagrange_core::{Error, prelude::*};
use lagrange_random::{Level, cases};

use crate::systems::Moon;

/// The pendulum of Taylor, *Classical Mechanics*, chapter 12.
#[derive(Clone, Lagrangian)]
#[coordinates(phi)]
#[define(omega_0 = 3*pi)]
#[lagrangian(phi_dot^2/2 + omega_0^2*cos(phi))]
#[dissipation(omega_0/4 * phi_dot^2)]
#[force(phi: gamma*omega_0^2*cos(omega*t))]
pub(crate) struct DrivenPendulum {
    pub(crate) gamma: f64,
    pub(crate) omega: f64,
}

/// Forces of the first five doublings, by `recompute.py`. Taylor's table 12.1 has 1.0663, 1.0793, 1.0821 and 1.0827.
const DOUBLINGS: [f64; 5] = [
    1.066_372_862_455_207,
    1.079_313_905_903_715_5,
    1.082_084_384_294_223_5,
    1.082_678_352_704_016,
    1.082_805_591_155_019,
];

#[test]
fn cascade_of_doublings() {
    let system = DrivenPendulum { gamma: 1.06, omega: TAU };
    // After the transients.
    let settled = system.motion(State::at_rest([-PI / 2.0])).to(30.0).unwrap();
    let start = settled.end().state().at_time(0.0);
    let search = system.periodic_orbit(&start).driven_by("omega", 1);
    let first = search.find().unwrap();
    let mut family = search.family(&first).in_parameter("gamma");
    let count = cases([2, 2, 5]);
    for (k, known) in DOUBLINGS.into_iter().take(count).enumerate() {
        let members = family
            .step(0.02 / 3.0_f64.powi(k as i32))
            .until_first(BifurcationKind::PeriodDoubling)
            .follow()
            .unwrap();
        assert_eq!(*members.ending(), FamilyEnding::Until);
        let doubling = members.first(BifurcationKind::PeriodDoubling).unwrap();
        assert!((doubling.value - known).abs() < 1e-10, "{k}: {:.15}", doubling.value);
        assert!((doubling.orbit.period - 2.0_f64.powi(k as i32)).abs() < 1e-14);
        let multiplier = doubling.orbit.multipliers().unwrap()[0];
        assert!((multiplier.re + 1.0).abs() < 1e-7, "{multiplier}");
        family = search.branch(doubling);
    }
}

/// Circular limit cycles of radius √ρ with a − b ρ + ρ² = 0, and an oscillator beside them.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - x^2/2 - p*y^2/2 - y^4/4)]
#[define(square = x^2 + x_dot^2)]
#[force(x: -(a - b*square + square^2)*x_dot)]
#[force(y: -c*y_dot)]
struct Cycle {
    a: f64,
    b: f64,
    p: f64,
    c: f64,
}

const CYCLE: Cycle = Cycle { a: 0.1, b: 1.0, p: 3.0, c: 0.1 };

fn around(system: &Cycle) -> OrbitSearch<Cycle> {
    let rho = system.b / 2.0 + (system.b * system.b / 4.0 - system.a).sqrt();
    system.periodic_orbit(&State::new([rho.sqrt(), 0.0], [0.0, 0.0])).period_near(6.3)
}

/// The stable and the unstable cycle meet at a = b²/4.
#[test]
fn fold_in_closed_form() {
    let search = around(&CYCLE);
    let first = search.find().unwrap();
    let family = search
        .family(&first)
        .in_parameter("a")
        .step(0.05)
        .until_first(BifurcationKind::Fold)
        .follow()
        .unwrap();
    let [fold] = family.bifurcations() else { panic!("{family}") };
    assert_eq!(fold.kind, BifurcationKind::Fold);
    assert!((fold.value - 0.25).abs() < 1e-12, "{:e}", fold.value - 0.25);
    let square = fold.orbit.start.q[0].powi(2) + fold.orbit.start.v[0].powi(2);
    // The cycle turns with the root of the distance from the fold.
    assert!((square - 0.5).abs() < 1e-6 && (fold.orbit.period - TAU).abs() < 1e-11);
    let last = family.orbits().last().unwrap();
    let square = last.start.q[0].powi(2) + last.start.v[0].powi(2);
    assert!((last.system.a - square + square * square).abs() < 1e-11 && square < 0.5);
}

/// The oscillator's damping changes sign at c = 0.
#[test]
fn torus_in_closed_form() {
    let search = around(&CYCLE);
    let first = search.find().unwrap();
    let family = search.family(&first).in_parameter("c").backwards().step(0.3).longest_step(0.3);
    let family = family.until_first(BifurcationKind::Torus).follow().unwrap();
    let [torus] = family.bifurcations() else { panic!("{family}") };
    assert!(torus.kind == BifurcationKind::Torus && torus.value.abs() < 1e-12, "{torus:?}");
    let error = search.branch(torus).follow().unwrap_err();
    assert!(
        matches!(&error, Error::Orbit(error) if matches!(**error, OrbitError::NoBranch { .. })),
        "{error}"
    );
}

/// The oscillator's rest y = 0 is left by y = ±√(−p) at p = 0.
#[test]
fn branches_in_closed_form() {
    let search = around(&Cycle { p: 0.3, ..CYCLE });
    let first = search.find().unwrap();
    let family = search.family(&first).in_parameter("p").backwards().step(0.3).longest_step(0.4);
    let family = family.until_first(BifurcationKind::BranchPoint).follow().unwrap();
    let [point] = family.bifurcations() else { panic!("{family}") };
    assert!(point.kind == BifurcationKind::BranchPoint && point.value.abs() < 1e-10, "{point:?}");
    let sides = [search.branch(point), search.branch(point).backwards()].map(|side| {
        let branch = side.orbits(3).step(0.05).follow().unwrap();
        let side = branch.orbits()[0].start.q[1].signum();
        for orbit in branch.orbits() {
            let (p, y) = (orbit.system.p, orbit.start.q[1]);
            assert!((y - side * (-p).sqrt()).abs() < 1e-9 && p < 0.0, "{p} {y}");
        }
        side
    });
    assert_eq!(sides[0], -sides[1]);
}

/// Without friction, of orbits that are their own mirror image in y: the branch y = ±√(−p) is not.
#[test]
fn broken_symmetry() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y)]
    #[lagrangian((x_dot^2 + y_dot^2)/2 - x^2/2 - p*y^2/2 - y^4/4)]
    struct Beside {
        p: f64,
    }
    let system = Beside { p: 0.3 };
    let start = State::at_rest([1.0, 0.0]);
    let search = system.periodic_orbit(&start).period_near(6.2).mirrored(&["x_dot", "y"]).energy(0.5);
    let first = search.find().unwrap();
    let family = search.family(&first).in_parameter("p").backwards().step(0.1);
    let family = family.until_first(BifurcationKind::BranchPoint).follow().unwrap();
    let point = family.first(BifurcationKind::BranchPoint).unwrap();
    assert!(point.value.abs() < 1e-9, "{family}");
    let branch = search.branch(point).orbits(5).step(0.05).follow().unwrap();
    for orbit in branch.orbits() {
        let (p, y) = (orbit.system.p, orbit.start.q[1]);
        assert!((y * y + p).abs() < 1e-8 && y.abs() > 0.01, "{p} {y}");
    }
}

/// Jacobi's constant and the period where orbits leave the plane: `recompute.py`, with 20 digits.
const HALO: [f64; 2] = [3.174_351_954_078_078, 2.742_994_069_462_154];
const AXIAL: [f64; 2] = [3.021_392_129_287_998, 3.949_998_674_303_37];

/// Orbits in the plane about the point between Earth and Moon, mirrored in the axis.
fn lyapunov() -> OrbitSearch<Moon> {
    let guess = State::new([0.8234, 0.0, 0.0], [0.0, 0.1263, 0.0]);
    let search = Moon::EARTHS.periodic_orbit(&guess).period_near(2.743).segments(4);
    search.mirrored(&["y", "x_dot", "z_dot"]).tolerance(1e-11)
}

fn check_point(point: &Bifurcation<Moon>, [jacobi, period]: [f64; 2]) {
    assert!((-2.0 * point.value - jacobi).abs() < 1e-12, "{:e}", -2.0 * point.value - jacobi);
    assert!((point.orbit.period - period).abs() < 1e-10, "{:e}", point.orbit.period - period);
}

/// Closed to 10⁻¹², with energies that grow up to the first fold.
fn check_halo(halo: &Family<Moon>) {
    for orbit in halo.orbits() {
        assert!(orbit.gap < 1e-12, "{:e} {:e}", orbit.gap, orbit.error);
        assert!(orbit.monodromy.symplectic_error() < 1e-12, "{:e}", orbit.monodromy.symplectic_error());
    }
    let last = halo.first(BifurcationKind::Fold).map_or(halo.orbits().len(), |fold| fold.after + 1);
    assert!(halo.orbits()[..last].windows(2).all(|pair| pair[0].energy() < pair[1].energy()));
}

#[test]
fn halo_orbits_leave_the_plane() {
    let search = lyapunov();
    let first = search.find().unwrap();
    let planar = search.family(&first).step(0.02).until_first(BifurcationKind::BranchPoint).follow().unwrap();
    let point = planar.first(BifurcationKind::BranchPoint).unwrap();
    check_point(point, HALO);
    let halo = search.branch(point).orbits(12).step(0.02).follow().unwrap();
    assert!(halo.orbits().last().unwrap().start.q[2].abs() > 0.02);
    check_halo(&halo);
}

/// The whole family down to the surface of the Moon, where it ends.
#[test]
fn halo_orbits_to_the_moon() {
    if Level::asked() < Level::Full {
        return;
    }
    let search = lyapunov();
    let first = search.find().unwrap();
    let planar = search.family(&first).orbits(40).longest_step(0.05).follow().unwrap();
    let points = planar.bifurcations().iter().filter(|found| found.kind == BifurcationKind::BranchPoint);
    let points: Vec<_> = points.collect();
    assert_eq!(points.len(), 2);
    check_point(points[0], HALO);
    check_point(points[1], AXIAL);
    // The radius of the Moon is 1737.4 km, its distance 384 400 km.
    let is_down = |orbit: &PeriodicOrbit<Moon>| {
        let moon = [1.0 - Moon::EARTHS.mu, 0.0, 0.0];
        let near = |state: &State<f64, 3>| (0..3).map(|i| (state.q[i] - moon[i]).powi(2)).sum::<f64>().sqrt();
        orbit.nodes.iter().map(near).fold(1.0, f64::min) < 1737.4 / 384_400.0
    };
    let halo = search.branch(points[0]).orbits(1000).longest_step(0.007).until(is_down).follow().unwrap();
    assert_eq!(*halo.ending(), FamilyEnding::Until);
    assert!(halo.orbits().len() >= 200);
    check_halo(&halo);
}

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[dissipation(c/2 * x_dot^2)]
#[force(x: cos(omega*t))]
struct Resonator {
    c: f64,
    omega: f64,
}

/// The period follows the frequency of the drive, at all nodes.
#[test]
fn resonance_in_closed_form() {
    let system = Resonator { c: 0.2, omega: 0.7 };
    let search = system.periodic_orbit(&State::at_rest([0.0])).driven_by("omega", 1).segments(3);
    let first = search.find().unwrap();
    let family = search.family(&first).in_parameter("omega").longest_step(0.3);
    let family = family.until(|orbit| orbit.system.omega > 1.4).follow().unwrap();
    assert!(family.bifurcations().is_empty() && *family.ending() == FamilyEnding::Until);
    for orbit in family.orbits() {
        let omega = orbit.system.omega;
        assert_eq!(orbit.period, TAU / omega);
        let response = Complex::new(1.0 - omega * omega, 0.2 * omega).inv();
        for node in &orbit.nodes {
            let exact = response * Complex::new(0.0, omega * node.t).exp();
            assert!((node.q[0] - exact.re).abs() < 1e-10, "{omega}, {}", node.t);
        }
    }
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, z)]
#[lagrangian((x_dot^2 + z_dot^2)/2 - 9.81*z)]
#[constraint(rod: (x^2 + z^2 - l^2)/2 = 0)]
#[dissipation(c/2 * (x_dot^2 + z_dot^2))]
#[force(x: cos(omega*t))]
struct OnARod {
    l: f64,
    c: f64,
    omega: f64,
}

#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(l^2/2*theta_dot^2 + 9.81*l*cos(theta))]
#[dissipation(c/2 * l^2*theta_dot^2)]
#[force(theta: l*cos(theta)*cos(omega*t))]
struct ByAngle {
    l: f64,
    c: f64,
    omega: f64,
}

/// A constraint that moves with the parameter of the family; the same orbits by an angle.
#[test]
fn length_of_a_rod() {
    let system = OnARod { l: 1.0, c: 0.5, omega: 2.0 };
    let search = system.periodic_orbit(&State::at_rest([0.1, -1.0])).driven_by("omega", 1).segments(2);
    let first = search.find().unwrap();
    let family = search.family(&first).in_parameter("l").step(0.1).orbits(4).follow().unwrap();
    assert!(family.orbits()[3].system.l > 1.1);
    for orbit in family.orbits() {
        let OnARod { l, c, omega } = orbit.system;
        let angle = ByAngle { l, c, omega };
        let same = angle
            .periodic_orbit(&State::at_rest([orbit.start.q[0] / l]))
            .driven_by("omega", 1)
            .find()
            .unwrap();
        assert!((l * same.start.q[0].sin() - orbit.start.q[0]).abs() < 1e-10);
        assert!((l * same.start.v[0] * same.start.q[0].cos() - orbit.start.v[0]).abs() < 1e-10);
        let determinant = |all: Vec<Complex<f64>>| all.into_iter().product::<Complex<f64>>().re;
        let [rod, theta] = [orbit.multipliers().unwrap(), same.multipliers().unwrap()].map(determinant);
        assert!((rod - theta).abs() < 1e-10 && (rod - (-c * orbit.period).exp()).abs() < 1e-10);
    }
}

#[test]
fn what_cannot_be_followed_is_said() {
    let system = Resonator { c: 0.2, omega: 0.7 };
    let search = system.periodic_orbit(&State::at_rest([0.0])).driven_by("omega", 1);
    let first = search.find().unwrap();
    // Without a parameter the orbit is isolated.
    let error = search.family(&first).follow().unwrap_err();
    assert!(
        matches!(&error, Error::Orbit(error) if **error == OrbitError::NoFamily { freedom: 0 }),
        "{error}"
    );
    let error = search.family(&first).in_parameter("omega_0").follow().unwrap_err();
    assert!(matches!(error, Error::UnknownName { .. }), "{error}");
    let error = search.family(&first).in_parameter("c").step(0.0).follow().unwrap_err();
    assert!(matches!(error, Error::Setting { .. }), "{error}");
}

/// Orbits in the plane of Earth and Moon about the point between them.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[define(r1 = sqrt((x + mu)^2 + y^2))]
#[define(r2 = sqrt((x - 1 + mu)^2 + y^2))]
#[lagrangian(((x_dot - y)^2 + (y_dot + x)^2)/2 + (1 - mu)/r1 + mu/r2)]
struct PlaneOfMoon {
    mu: f64,
}

/// Where the orbits get unstable another family is as near as the next member: the steps shorten, and the family does not change.
#[test]
fn orbits_of_one_family_stay_in_it() {
    let system = PlaneOfMoon { mu: Moon::EARTHS.mu };
    let point = system.equilibrium(&State::at_rest([0.84, 0.0]), &["x", "y"]).unwrap().state;
    let guess = State::new([point.q[0] - 0.005, 0.0], [0.0, 0.04]);
    let search = system.periodic_orbit(&guess).period_near(2.7).mirrored(&["y", "x_dot"]);
    let family = search.family(&search.find().unwrap()).orbits(47).follow().unwrap();
    for pair in family.orbits().windows(2) {
        let ratio = pair[1].period / pair[0].period;
        assert!((0.95..1.1).contains(&ratio), "{ratio} in {family}");
    }
    assert!(family.first(BifurcationKind::BranchPoint).is_none(), "{family}");
}
