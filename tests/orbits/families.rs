//! Bifurcations of periodic orbits in closed form, and families of further systems.

use std::f64::consts::{PI, TAU};

use lagrange_core::linearized::Stability;
use lagrange_core::nalgebra::Complex;
use lagrange_core::orbits::{BifurcationKind, FamilyEnding, OrbitError};
use lagrange_core::prelude::*;
use lagrange_random::cases;
use lagrange_systems::Pendulum;

use crate::bifurcations::around;
use crate::messages::orbit_error;
use crate::systems::{CYCLE, DRIVEN, Saddle};

/// A pendulum whose pivot is shaken up and down. At θ = 0, and at a = 0, the time has no effect.
#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 + (delta + a*cos(omega*t))*cos(theta))]
#[dissipation(c/2 * theta_dot^2)]
struct Shaken {
    delta: f64,
    a: f64,
    omega: f64,
    c: f64,
}

/// The pendulum of Taylor, *Classical Mechanics*, chapter 12.
#[derive(Clone, Lagrangian)]
#[coordinates(phi)]
#[define(omega_0 = 3*pi)]
#[lagrangian(phi_dot^2/2 + omega_0^2*cos(phi))]
#[dissipation(omega_0/4 * phi_dot^2)]
#[force(phi: gamma*omega_0^2*cos(omega*t))]
struct DrivenPendulum {
    gamma: f64,
    omega: f64,
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

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[force(x: mu*(1 - x^2)*x_dot)]
struct VanDerPol {
    mu: f64,
}

/// Period 6.663286859323130 at μ = 1, by `recompute.py`; the mean of the divergence gives the multiplier.
#[test]
fn limit_cycle() {
    let search = VanDerPol { mu: 1.0 }.periodic_orbit(&State::at_rest([1.9])).period_near(6.5);
    for segments in [1, 5] {
        let cycle = search.clone().segments(segments).find().unwrap();
        assert!((cycle.period - 6.663_286_859_323_13).abs() < 1e-10, "{}", cycle.period);
        assert_eq!(cycle.stability().unwrap(), Stability::AsymptoticallyStable);
        assert_eq!(cycle.monodromy.trivial(), 1);
        let determinant = cycle.monodromy.matrix().determinant();
        assert!((cycle.multipliers().unwrap()[0].re - determinant).abs() < 1e-10);
    }
}

/// The family ends where its orbits get too unstable for one segment, and lists nothing that is no orbit.
#[test]
fn family_of_relaxing_oscillations() {
    let search = VanDerPol { mu: 1.0 }.periodic_orbit(&State::new([2.0], [0.0])).period_near(6.6);
    let family = search.family(&search.find().unwrap()).in_parameter("mu").backwards().orbits(80);
    let family = family.follow().unwrap();
    for orbit in family.orbits() {
        assert!(orbit.gap < 1e-8 && orbit.error < 1e-3 && orbit.period > 6.0, "{orbit}");
    }
    assert!(family.bifurcations().iter().all(|found| found.orbit.period > 6.0), "{family}");
}

/// Up to the separatrix, where the monodromy grows without bound: swings of a pendulum have no bifurcations, and both of their multipliers
/// are 1.
#[test]
fn swings_up_to_the_separatrix() {
    let pendulum = Pendulum { m: 1.0, l: 1.0, g: 1.0 };
    let search = pendulum
        .periodic_orbit(&State::at_rest([std::f64::consts::PI - 0.0016]))
        .by(Dop853::with_tolerance(1e-13));
    let search = search.period_near(34.1);
    let family = search.family(&search.find().unwrap()).orbits(11).follow().unwrap();
    assert!(family.bifurcations().is_empty() && family.lost().is_empty(), "{family}");
    let last = family.orbits().last().unwrap();
    assert!(last.energy() > 1.0 - 1e-8 && last.monodromy.trivial() == 2, "{last}");
}

/// Signs that are not known tell of no bifurcation: the motion for half a period magnifies errors more than 10⁶ times.
#[test]
fn swings_beyond_round_off() {
    for amplitude in [1.6e-3, 0.6e-3].map(|below| PI - below) {
        let start = State::at_rest([amplitude]);
        let search = Pendulum { m: 1.0, l: 1.0, g: 1.0 }.periodic_orbit(&start).mirrored(&["theta_dot"]);
        let search = search.period_near(4.0 * (8.0 / (PI - amplitude)).ln());
        let first = search.clone().energy(-amplitude.cos()).find().unwrap();
        let search = search.period_near(first.period);
        let family = search.family(&search.find().unwrap()).step(0.1).longest_step(0.3).follow().unwrap();
        assert!(family.bifurcations().is_empty() && family.lost().is_empty(), "{family}");
        assert!(family.orbits().last().unwrap().energy() > 1.0 - 1e-12, "{family}");
    }
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

/// The period follows the frequency of the drive, at all nodes.
#[test]
fn resonance_in_closed_form() {
    let search = DRIVEN.periodic_orbit(&State::at_rest([0.0])).driven_by("w", 1).segments(3);
    let first = search.find().unwrap();
    let family = search.family(&first).in_parameter("w").longest_step(0.3);
    let family = family.until(|orbit| orbit.system.w > 1.4).follow().unwrap();
    assert!(family.bifurcations().is_empty() && *family.ending() == FamilyEnding::Until);
    for orbit in family.orbits() {
        let omega = orbit.system.w;
        assert_eq!(orbit.period, TAU / omega);
        let response = Complex::new(1.0 - omega * omega, 0.2 * omega).inv();
        for node in &orbit.nodes {
            let exact = response * Complex::new(0.0, omega * node.t).exp();
            assert!((node.q[0] - exact.re).abs() < 1e-10, "{omega}, {}", node.t);
        }
    }
}

/// Ends of the first three windows of Mathieu's swing, ẍ + (δ − 2 q cos 2t) x = 0: characteristic values b₁, a₁, b₂, a₂, b₃, a₃ for q = 0.3, by
/// `recompute.py`.
const CHARACTERISTIC: [f64; 6] = [
    0.689_165_935_613_862_5,
    1.288_323_638_326_833,
    3.992_502_927_044_682,
    4.037_061_874_936_018,
    9.005_208_948_994_37,
    9.006_051_213_331_22,
];

/// Steps that leap over several windows see each.
#[test]
fn windows_of_mathieus_swing() {
    let system = Shaken { delta: 0.5, a: -0.6, omega: 2.0, c: 0.0 };
    let search = system.periodic_orbit(&State::at_rest([0.0])).period(PI);
    let rest = search.find().unwrap();
    for longest in [0.3, 20.0] {
        let family =
            search.family(&rest).in_parameter("delta").step(longest).until(|orbit| orbit.system.delta > 10.0);
        let family = family.follow().unwrap();
        assert_eq!(family.bifurcations().len(), 6, "{family}");
        for (k, (found, exact)) in family.bifurcations().iter().zip(CHARACTERISTIC).enumerate() {
            let kind =
                if k / 2 == 1 { BifurcationKind::BranchPoint } else { BifurcationKind::PeriodDoubling };
            assert_eq!(found.kind, kind);
            assert!((found.value - exact).abs() < 1e-10, "{k}: {:e}", found.value - exact);
        }
    }
}

/// The time counts wherever it occurs, whatever the guess: no multiplier is split off, and no other period is found.
#[test]
fn clock_that_rests_at_the_guess() {
    let shaken = Shaken { delta: 1.0, a: 0.5, omega: 2.0, c: 0.1 };
    let guess = State::new([0.0], [2.0]);
    let orbit = shaken.periodic_orbit(&guess).driven_by("omega", 2).find().unwrap();
    let exact = shaken.monodromy(&orbit.start, orbit.period, Dop853::with_tolerance(1e-13)).unwrap();
    for (found, exact) in orbit.multipliers().unwrap().iter().zip(exact.multipliers().unwrap()) {
        assert!((found - exact).norm() < 1e-9, "{found} for {exact}");
    }
    let error = orbit_error(shaken.periodic_orbit(&guess).period_near(6.3).find());
    assert!(matches!(error, OrbitError::Clock { .. }), "{error}");
}

/// The product of the multipliers is e^{−c T} along a branch that leaves at θ = 0.
#[test]
fn swings_of_a_shaken_pendulum() {
    let shaken = Shaken { delta: 1.0, a: 0.1, omega: 2.0, c: 0.1 };
    let search = shaken.periodic_orbit(&State::at_rest([0.0])).driven_by("omega", 1);
    let hanging = search.family(&search.find().unwrap()).in_parameter("a");
    let hanging = hanging.until_first(BifurcationKind::PeriodDoubling).follow().unwrap();
    let doubling = hanging.first(BifurcationKind::PeriodDoubling).unwrap();
    let swinging = search.branch(doubling).orbits(5).follow().unwrap();
    for orbit in swinging.orbits() {
        let multipliers = orbit.multipliers().unwrap();
        let product = multipliers[0] * multipliers[1];
        assert!((product.re - (-0.1 * orbit.period).exp()).abs() < 1e-9, "{multipliers:?}");
    }
    assert!((swinging.orbits()[4].system.a - swinging.orbits()[0].system.a).abs() > 1e-6);
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

/// A mass on a spring, in a vertical plane.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - k/2*(sqrt(x^2 + y^2) - l)^2 - m*g*y)]
struct SpringPendulum {
    m: f64,
    g: f64,
    k: f64,
    l: f64,
}

/// Energies and periods at the ends of the window, by `recompute.py`.
const WINDOW: [[f64; 2]; 2] =
    [[-5.971_067_619_751_33, 2.237_874_500_518_84], [-5.942_796_595_846_104, 2.240_162_017_675_588]];

/// The swing from rest to rest is unstable between two branches: one of asymmetric swings, and one of loops that never rest.
#[test]
fn window_of_a_spring_pendulum() {
    let system = SpringPendulum { m: 1.0, g: 9.81, k: 60.0, l: 0.8 };
    let search = system.periodic_orbit(&State::at_rest([0.05, -0.9635])).period_near(1.97);
    let search = search.mirrored(&["x_dot", "y_dot"]);
    let family =
        search.family(&search.find().unwrap()).until(|orbit| orbit.energy() > -5.0).follow().unwrap();
    let [first, second] = family.bifurcations() else { panic!("{family}") };
    for (found, [energy, period]) in [first, second].into_iter().zip(WINDOW) {
        assert_eq!(found.kind, BifurcationKind::BranchPoint);
        assert!((found.value - energy).abs() < 1e-11, "{:e}", found.value - energy);
        assert!((found.orbit.period - period).abs() < 1e-11, "{:e}", found.orbit.period - period);
        assert!(found.orbit.error < 1e-11, "{:e}", found.orbit.error);
    }
    // An orbit of the window is a member.
    assert_eq!(second.after, first.after + 1);
    let inside = &family.orbits()[second.after];
    assert!((WINDOW[0][0]..WINDOW[1][0]).contains(&inside.energy()), "{family}");
    assert!(inside.multipliers().unwrap()[0].re > 1.01);
    // Swings of the first branch are not mirrored in x = 0; those of the second are nowhere at rest.
    let branch = |found, step| search.branch(found).step(step).orbits(3).follow().unwrap();
    // Straight on, the longer step ends at a swing that is mirrored.
    for orbit in branch(first, 0.01).orbits().iter().chain(branch(first, 0.8).orbits()) {
        let path = orbit.system.motion(orbit.start).to(0.5 * orbit.period).unwrap();
        assert!((path.end().state().q[0] + orbit.start.q[0]).abs() > 0.005, "{orbit}");
    }
    for orbit in branch(second, 0.01).orbits() {
        assert!(orbit.start.v[0].hypot(orbit.start.v[1]) > 0.01, "{orbit}");
    }
}

/// Two swings, of different lengths, that a drive couples.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - delta*(x^2 + 2.3*y^2)/2 - epsilon*cos(2*t)*x*y - (x^4 + y^4)/4)]
struct Coupled {
    delta: f64,
    epsilon: f64,
}

/// Pairs of multipliers that collide on the circle, and others that pass 1: the swing at rest is unstable on one side of each end.
#[test]
fn windows_of_coupled_swings() {
    let at = |delta| Coupled { delta, epsilon: 0.1 };
    let (rest, method) = (State::at_rest([0.0, 0.0]), Dop853::with_tolerance(1e-13));
    let search = at(0.1).periodic_orbit(&rest).period(PI);
    let family = search.family(&search.find().unwrap()).in_parameter("delta").step(50.0);
    let family = family.until(|orbit| orbit.system.delta > 5.0).follow().unwrap();
    assert!(family.bifurcations().len() == 6 && family.lost().is_empty(), "{family}");
    for (k, found) in family.bifurcations().iter().enumerate() {
        let kind = if k < 2 { BifurcationKind::Torus } else { BifurcationKind::BranchPoint };
        assert_eq!(found.kind, kind);
        let growth = [-1e-8, 1e-8].map(|by| {
            let around = at(found.value + by).monodromy(&rest, PI, method).unwrap();
            around.multipliers().unwrap()[0].norm() - 1.0
        });
        let (outside, inside) = if k % 2 == 0 { (growth[0], growth[1]) } else { (growth[1], growth[0]) };
        assert!(outside.abs() < 1e-9 && inside > 1e-6, "{k}: {growth:?}");
    }
}
/// Real multipliers of which two have the product 1 are no torus.
#[test]
fn neutral_saddle_is_no_torus() {
    let search =
        Saddle { h: 1.0, k: 0.1, a: 1.0, c: 1.0 }.periodic_orbit(&State::at_rest([0.0, 0.0])).period(TAU);
    let family = search.family(&search.find().unwrap()).in_parameter("k").longest_step(0.02).orbits(40);
    let family = family.follow().unwrap();
    let last = &family.orbits()[family.orbits().len() - 1];
    assert!(last.system.k > 0.175, "{family}");
    assert!(family.bifurcations().is_empty() && family.lost().is_empty(), "{family}");
}

/// A skate on a slope that turns.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian((x_dot^2 + y_dot^2 + k*phi_dot^2)/2 - h*x^2/2)]
#[constraint(blade: x_dot*sin(phi) - y_dot*cos(phi) = 0)]
struct Skate {
    k: f64,
    h: f64,
}

/// The energy of a motion on a constraint on velocities is a condition as any other.
#[test]
fn skate_of_known_energy() {
    let skate = Skate { k: 0.5, h: 1.0 };
    let guess = State::new([0.3, 0.0, 0.0], [0.2, 0.0, 2.0]);
    let search = skate.periodic_orbit(&guess).period_near(PI).advancing("phi", TAU);
    let free = search.find().unwrap();
    let energy = free.energy() + 0.05;
    let search = skate.periodic_orbit(&guess).period_near(PI).advancing("phi", TAU).energy(energy);
    let orbit = search.find().unwrap();
    assert!(
        (orbit.energy() - energy).abs() < 1e-12 && orbit.gap < 1e-11 && orbit.iterations < 15,
        "{orbit:?}"
    );
}

/// A mass on a spring whose pivot the swing passes: the force jumps there, and the family leaps to orbits of another number of turns.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - k/2*(sqrt(x^2 + (1 - y)^2) - 1)^2 - y)]
struct Sprung {
    k: f64,
}

#[test]
fn a_test_that_jumps_is_no_bifurcation() {
    let sprung = Sprung { k: 3.1 };
    let search = sprung.periodic_orbit(&State::new([0.0, -1.0 / 3.1], [0.0, 0.05]));
    let search = search.period_near(TAU / 3.1_f64.sqrt());
    let first = search.find().unwrap();
    let family = search.family(&first).until(|orbit| orbit.energy() > 2.295).follow().unwrap();
    assert!(family.bifurcations().is_empty() && !family.lost().is_empty(), "{family}");
}

/// Hénon and Heiles' potential with other coefficients.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + w*y^2)/2 - b*x^2*y + c*y^3/3)]
struct Heiles {
    w: f64,
    b: f64,
    c: f64,
}

#[test]
fn bifurcations_are_in_the_order_of_the_family() {
    let system = Heiles { w: 2.137835514780057, b: 0.6936920869830034, c: 0.46110995857013837 };
    let search = system.periodic_orbit(&State::new([0.0, 0.0], [0.0, 0.55])).period_near(4.3);
    let first = search.find().unwrap();
    let family = search.family(&first).until(|orbit| orbit.energy() > 7.58).follow().unwrap();
    let energies: Vec<f64> = family.bifurcations().iter().map(|bifurcation| bifurcation.value).collect();
    assert!(energies.len() > 1 && energies.is_sorted(), "{energies:?}");
}
