//! Windows of instability that lie between two neighbours of a family.

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
        assert!((found.value - energy).abs() < 1e-5, "{:e}", found.value - energy);
        assert!((found.orbit.period - period).abs() < 1e-5, "{:e}", found.orbit.period - period);
    }
    // An orbit of the window is a member.
    assert_eq!(second.after, first.after + 1);
    let inside = &family.orbits()[second.after];
    assert!((WINDOW[0][0]..WINDOW[1][0]).contains(&inside.energy()), "{family}");
    assert!(inside.multipliers().unwrap()[0].re > 1.01);
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
    9.006_051_213_331_221,
];

/// Steps that leap over several windows see each.
#[test]
fn windows_of_mathieus_swing() {
    let system = Mathieu { delta: 0.5, epsilon: 0.3 };
    let search = system.periodic_orbit(&State::at_rest([0.0])).period(std::f64::consts::PI);
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
