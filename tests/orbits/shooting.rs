//! Periodic orbits by single and multiple shooting.

use std::f64::consts::{PI, TAU};

use lagrange_core::linearized::Stability;
use lagrange_core::nalgebra::Complex;
use lagrange_core::orbits::{BifurcationKind, OrbitError, PeriodicOrbit};
use lagrange_core::{Error, prelude::*};

use crate::systems::{Moon, Planet, ThreeMasses, eight};

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 + 1/sqrt(x^2 + y^2 + z^2))]
struct Comet;

/// Every orbit of a planet closes, so all multipliers are 1. Of the matrix itself, a Jordan block, they are found to 10⁻⁷ only.
#[test]
fn planets_have_multipliers_1() {
    for eccentricity in [0.0, 0.3, 0.7] {
        let perihelion: f64 = 1.0 - eccentricity;
        let speed = ((1.0_f64 + eccentricity) / perihelion).sqrt();
        let guess = State::new([perihelion, 0.0], [0.0, speed + 0.01]);
        let orbit = Planet.periodic_orbit(&guess).period(TAU).find().unwrap();
        let tilted = State::new([perihelion, 0.0, 0.0], [0.0, 0.8 * speed, 0.6 * speed]);
        let comet = Comet.periodic_orbit(&tilted).period_near(6.2).segments(4).find().unwrap();
        for multipliers in [orbit.multipliers().unwrap(), comet.multipliers().unwrap()] {
            for multiplier in multipliers {
                assert!((multiplier - Complex::new(1.0, 0.0)).norm() < 1e-9, "{eccentricity}: {multiplier}");
            }
        }
        assert!(orbit.error < 1e-11 && comet.error < 1e-11, "{:e} {:e}", orbit.error, comet.error);
        // Kepler's third law, with the energy.
        let axis = -0.5 / comet.energy();
        assert!((comet.period - TAU * axis.powf(1.5)).abs() < 1e-10);
    }
}

/// Angles 2π ν of the multipliers of the figure of eight: `recompute.py`, with 40 digits. Published are 0.00842272 and
/// 0.29809253 (Simó, "Dynamical properties of the figure eight solution of the three-body problem", 2002).
const EIGHT_TURNS: [f64; 2] = [0.298_092_529_004_750_1, 0.008_422_724_708_131_378];

fn turns<L: Linearized<Scalar = f64>>(orbit: &PeriodicOrbit<L>) -> Vec<f64> {
    orbit.multipliers().unwrap().iter().filter(|x| x.im > 0.0).map(|x| x.arg() / TAU).collect()
}

#[test]
fn figure_of_eight() {
    let (start, period) = eight();
    let [few, many] = [3, 30].map(|segments| {
        ThreeMasses.periodic_orbit(&start).period_near(period).segments(segments).find().unwrap()
    });
    for orbit in [&few, &many] {
        // To the closest orbit of the same energy or another.
        let size = (orbit.period / period).powf(2.0 / 3.0);
        assert!((size - 1.0).abs() < 1e-9, "{size}");
        assert!(orbit.error < 1e-10, "{:e}", orbit.error);
        for known in EIGHT_TURNS {
            let off = turns(orbit).iter().map(|turn| (turn - known).abs()).fold(1.0, f64::min);
            assert!(off < 1e-10, "{known} by {off:e}");
        }
        assert!(orbit.monodromy.symplectic_error() < 1e-12);
    }
    for multiplier in few.multipliers().unwrap() {
        let all = many.multipliers().unwrap();
        let off = all.iter().map(|x| (x - multiplier).norm()).fold(1.0, f64::min);
        // Those of motions of the whole, and of its turning, are 1 in Jordan blocks.
        let bound = if (multiplier - Complex::new(1.0, 0.0)).norm() < 1e-4 { 1e-5 } else { 1e-9 };
        assert!(off < bound, "{multiplier} by {off:e}");
    }
}

#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 + cos(theta))]
struct Pendulum;

/// Complete elliptic integral of the first kind by the arithmetic-geometric mean.
fn complete(modulus: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - modulus * modulus).sqrt());
    for _ in 0..6 {
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    PI / 2.0 / a
}

#[test]
fn pendulum_of_known_energy_period_or_symmetry() {
    let period = 4.0 * complete(0.5_f64.sin());
    let near = || Pendulum.periodic_orbit(&State::new([0.9], [0.2])).period_near(6.5);
    let by_energy = near().energy(-(1.0_f64.cos())).find().unwrap();
    assert!((by_energy.period - period).abs() < 1e-11);
    let by_period = Pendulum.periodic_orbit(&State::at_rest([0.95])).period(period).find().unwrap();
    assert!((by_period.energy() + 1.0_f64.cos()).abs() < 1e-10);
    let mirrored = Pendulum.periodic_orbit(&State::at_rest([0.9])).period_near(6.5).mirrored(&["theta_dot"]);
    let mirrored = mirrored.energy(-(1.0_f64.cos())).segments(3).find().unwrap();
    assert!((mirrored.period - period).abs() < 1e-11 && (mirrored.start.q[0] - 1.0).abs() < 1e-11);
    assert_eq!(mirrored.nodes.len(), 6);
    // dT/dE fills the one entry of the Jordan block.
    for orbit in [by_energy, by_period, mirrored] {
        assert!(orbit.multipliers().unwrap().iter().all(|x| (x - Complex::new(1.0, 0.0)).norm() < 1e-12));
        assert_eq!(orbit.monodromy.trivial(), 2);
    }
}

/// Over the top: the angle advances by 2π in 2 k K(k) with k² = 2/(E + 1).
#[test]
fn pendulum_that_turns_over() {
    let energy = 1.7;
    let modulus = (2.0_f64 / (energy + 1.0)).sqrt();
    let search = Pendulum.periodic_orbit(&State::new([0.0], [2.3])).period_near(3.3).advancing("theta", TAU);
    let orbit = search.clone().energy(energy).segments(2).find().unwrap();
    assert!((orbit.period - 2.0 * modulus * complete(modulus)).abs() < 1e-11, "{}", orbit.period);
    let mirrored = search.mirrored(&["theta"]).energy(energy).find().unwrap();
    assert!((mirrored.period - orbit.period).abs() < 1e-11);
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

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - g*z)]
#[constraint(string: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
struct Spherical {
    g: f64,
    l: f64,
}

/// A cone of a spherical pendulum: nutation ω² = g (1 + 3 cos² θ)/(l cos θ).
#[test]
fn cone_with_its_constraint() {
    let (g, l, theta) = (9.81, 0.7, 0.6_f64);
    let rate = (g / (l * theta.cos())).sqrt();
    let (x, z) = (l * theta.sin(), -l * theta.cos());
    let guess = State::new([x, 0.0, z], [0.0, x * rate * 1.001, 0.0]);
    let cone = Spherical { g, l }.periodic_orbit(&guess).period(TAU / rate).segments(4).find().unwrap();
    assert!((cone.start.q[2] - z).abs() < 1e-9, "{}", cone.start);
    assert!(cone.gap < 1e-11 && cone.error < 1e-11, "{:e} {:e}", cone.gap, cone.error);
    let nutation = (g * (1.0 + 3.0 * theta.cos().powi(2)) / (l * theta.cos())).sqrt() * TAU / rate;
    let index = cone.stability_indices().unwrap()[0];
    assert!((index.re - nutation.cos()).abs() < 1e-8, "{index}");
    assert!(cone.monodromy.symplectic_error() < 1e-12);
}

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[dissipation(c/2 * x_dot^2)]
#[force(x: cos(omega*t))]
struct Driven {
    c: f64,
    omega: f64,
}

/// Amplitude and phase of the forced oscillation; multipliers exp(s T).
#[test]
fn forced_oscillation() {
    let (c, omega) = (0.2_f64, 1.3);
    let system = Driven { c, omega };
    let orbit = system.periodic_orbit(&State::at_rest([0.0])).driven_by("omega", 1).find().unwrap();
    let response = Complex::new(1.0 - omega * omega, c * omega).inv();
    assert!((orbit.start.q[0] - response.re).abs() < 1e-11);
    assert!((orbit.start.v[0] + omega * response.im).abs() < 1e-11);
    let modulus = (-c * orbit.period / 2.0).exp();
    assert!(orbit.multipliers().unwrap().iter().all(|x| (x.norm() - modulus).abs() < 1e-11));
    assert_eq!(orbit.monodromy.trivial(), 0);
}

#[test]
fn what_cannot_be_found_is_said() {
    let start = State::at_rest([0.9]);
    let found = |error: Error| match error {
        Error::Orbit(error) => *error,
        other => panic!("{other}"),
    };
    let search = || Pendulum.periodic_orbit(&start);
    assert_eq!(found(search().find().unwrap_err()), OrbitError::NoPeriod);
    // No swing is that fast.
    let error = found(search().period(5.0).find().unwrap_err());
    assert!(matches!(error, OrbitError::Equilibrium { .. }), "{error}");
    let driven = Driven { c: 0.2, omega: 1.0 };
    let error = found(driven.periodic_orbit(&start).period_near(6.0).find().unwrap_err());
    assert!(matches!(error, OrbitError::Clock { .. }), "{error}");
    let error = found(
        VanDerPol { mu: 1.0 }
            .periodic_orbit(&State::at_rest([2.0]))
            .period_near(6.6)
            .mirrored(&["x_dot"])
            .find()
            .unwrap_err(),
    );
    assert!(matches!(error, OrbitError::NotMirrored { .. } | OrbitError::NotClosed { .. }), "{error}");
    for error in [
        search().period_near(6.0).mirrored(&["phi"]).find().unwrap_err(),
        driven.periodic_orbit(&start).driven_by("frequency", 1).find().unwrap_err(),
    ] {
        assert!(matches!(error, Error::UnknownName { .. }), "{error}");
    }
    for error in [search().period(-1.0).find().unwrap_err(), search().period(f64::NAN).find().unwrap_err()] {
        assert!(matches!(error, Error::Setting { name: "period of an orbit", .. }), "{error}");
    }
}

/// Lyapunov's orbit between Earth and Moon, of which deviations grow 2361-fold: the same multipliers of 3 and of 30 segments.
#[test]
fn unstable_orbit_in_few_or_many_segments() {
    let guess = State::new([0.8234, 0.0, 0.0], [0.0, 0.1263, 0.0]);
    let near = Moon::EARTHS.periodic_orbit(&guess).period_near(2.743).energy(-1.587_178_946);
    let [few, many] =
        [3, 30].map(|segments| near.clone().segments(segments).find().unwrap().multipliers().unwrap());
    assert!((few[0].re - 2361.3).abs() < 1.0, "{few:?}");
    for (x, y) in few.iter().zip(&many) {
        assert!((x - y).norm() < 1e-9 * x.norm().max(1.0), "{few:?} {many:?}");
    }
}

/// A pendulum whose pivot is shaken up and down. At θ = 0, and at a = 0, the time has no effect.
#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 + (1 + a*cos(omega*t))*cos(theta))]
#[dissipation(c/2 * theta_dot^2)]
struct Shaken {
    a: f64,
    omega: f64,
    c: f64,
}

/// The time counts wherever it occurs, whatever the guess: no multiplier is split off, and no other period is found.
#[test]
fn clock_that_rests_at_the_guess() {
    let shaken = Shaken { a: 0.5, omega: 2.0, c: 0.1 };
    let guess = State::new([0.0], [2.0]);
    let orbit = shaken.periodic_orbit(&guess).driven_by("omega", 2).find().unwrap();
    let exact = shaken.monodromy(&orbit.start, orbit.period, Dop853::with_tolerance(1e-13)).unwrap();
    for (found, exact) in orbit.multipliers().unwrap().iter().zip(exact.multipliers().unwrap()) {
        assert!((found - exact).norm() < 1e-9, "{found} for {exact}");
    }
    let error = shaken.periodic_orbit(&guess).period_near(6.3).find().unwrap_err();
    assert!(matches!(&error, Error::Orbit(error) if matches!(**error, OrbitError::Clock { .. })), "{error}");
    // The product of the multipliers is e^{−c T} along a branch that leaves at θ = 0.
    let search = Shaken { a: 0.1, ..shaken }.periodic_orbit(&State::at_rest([0.0])).driven_by("omega", 1);
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

/// A period that is not the drive's, and a drive that is none.
#[test]
fn periods_that_drive_nothing() {
    let shaken = Shaken { a: 0.7, omega: 2.0, c: 0.1 };
    let guess = State::new([0.0], [1.0]);
    for search in [shaken.periodic_orbit(&guess).period(3.0), shaken.periodic_orbit(&guess).driven_by("a", 1)]
    {
        let error = search.find().unwrap_err();
        let is_named = |error: &OrbitError| {
            matches!(error, OrbitError::NotItsClock { .. } | OrbitError::NotClosed { .. })
        };
        assert!(matches!(&error, Error::Orbit(error) if is_named(error)), "{error}");
    }
    let cycle = Relaxing { mu: 1.0 };
    let error = cycle.periodic_orbit(&State::new([2.0], [0.0])).driven_by("mu", 1).find().unwrap_err();
    assert!(matches!(&error, Error::Orbit(error) if **error == OrbitError::NoClock), "{error}");
}

/// Hanging at rest meets no condition on the energy either.
#[test]
fn energy_that_changes_cannot_be_fixed() {
    let shaken = Shaken { a: 0.1, omega: 2.0, c: 0.1 };
    let driven = shaken.periodic_orbit(&State::at_rest([0.0])).driven_by("omega", 1).energy(5.0).find();
    let cycle = VanDerPol { mu: 1.0 }.periodic_orbit(&State::at_rest([1.9])).period_near(6.6);
    for (error, is_driven) in [(driven.unwrap_err(), true), (cycle.energy(1.0).find().unwrap_err(), false)] {
        assert!(
            matches!(&error, Error::Orbit(error) if **error == OrbitError::EnergyChanges { is_driven }),
            "{error}"
        );
        assert!(error.to_string().contains("leave out `energy`"), "{error}");
    }
}

/// Van der Pol's oscillator.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
#[force(x: mu*(1 - x^2)*x_dot)]
struct Relaxing {
    mu: f64,
}

/// The family ends where its orbits get too unstable for one segment, and lists nothing that is no orbit.
#[test]
fn family_of_relaxing_oscillations() {
    let search = Relaxing { mu: 1.0 }.periodic_orbit(&State::new([2.0], [0.0])).period_near(6.6);
    let family = search.family(&search.find().unwrap()).in_parameter("mu").backwards().orbits(80);
    let family = family.follow().unwrap();
    for orbit in family.orbits() {
        assert!(orbit.gap < 1e-8 && orbit.error < 1e-3 && orbit.period > 6.0, "{orbit}");
    }
    assert!(family.bifurcations().iter().all(|found| found.orbit.period > 6.0), "{family}");
}

/// Orbits of a planet fill a space: nothing bifurcates among those of one energy.
#[test]
fn planets_do_not_bifurcate() {
    let guess = State::new([0.5, 0.0], [0.0, 3.0_f64.sqrt()]);
    let search = Planet.periodic_orbit(&guess).period_near(6.3).mirrored(&["y", "x_dot"]).energy(-0.5);
    let family = search.family(&search.find().unwrap()).backwards().orbits(30).follow().unwrap();
    assert!(family.bifurcations().is_empty() && family.lost().is_empty(), "{family}");
}

/// A saddle beside a spring, both with friction, both driven.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + x^2/2 - k*y^2/2 + cos(t)*(x + y))]
#[dissipation(x_dot^2/4 + y_dot^2/2)]
struct Saddle {
    k: f64,
}

/// Real multipliers of which two have the product 1 are no torus.
#[test]
fn neutral_saddle_is_no_torus() {
    let search = Saddle { k: 0.1 }.periodic_orbit(&State::at_rest([0.0, 0.0])).period(TAU);
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
