//! Windows of instability that lie between two neighbours of a family.

use std::f64::consts::PI;

use lagrange_core::orbits::BifurcationKind;
use lagrange_core::prelude::*;

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

/// Mathieu's swing, ẍ + (δ − 2 ε cos 2t) x = 0 for small x.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - (delta - 2*epsilon*cos(2*t))*x^2/2 - x^4/4)]
struct Mathieu {
    delta: f64,
    epsilon: f64,
}

/// Ends of the first three windows of the swing at rest: characteristic values b₁, a₁, b₂, a₂, b₃, a₃ for q = ε = 0.3, by
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
    let system = Mathieu { delta: 0.5, epsilon: 0.3 };
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
