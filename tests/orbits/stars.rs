//! Orbits of planets, stars and moons.

use std::f64::consts::TAU;

use lagrange_core::nalgebra::Complex;
use lagrange_core::orbits::{Bifurcation, BifurcationKind, Family, FamilyEnding, OrbitSearch, PeriodicOrbit};
use lagrange_core::prelude::*;
use lagrange_random::Level;
use lagrange_systems::{Planet, ThreeBodies};

/// Three equal masses in a plane.
#[derive(Clone, Lagrangian)]
#[coordinates(a: [2], b: [2], c: [2])]
#[lagrangian((dot(a_dot, a_dot) + dot(b_dot, b_dot) + dot(c_dot, c_dot))/2 + 1/norm(a - b) + 1/norm(b - c) + 1/norm(c - a))]
struct ThreeMasses;

/// The figure of eight (Chenciner and Montgomery, *Annals of Mathematics* 152, 2000): start and period by `recompute.py`, of which the
/// first eight digits are those published.
const EIGHT: [f64; 5] = [
    0.970_004_36,
    -0.243_087_538_924_877_45,
    0.466_203_687_306_882_35,
    0.432_365_726_412_457_87,
    6.325_914_030_368_495,
];

fn eight() -> (State<f64, 6>, f64) {
    let [x, y, vx, vy, period] = EIGHT;
    (State::new([x, y, -x, -y, 0.0, 0.0], [vx, vy, vx, vy, -2.0 * vx, -2.0 * vy]), period)
}

/// A small body near Earth and Moon, in the frame that turns with them. Jacobi's constant is −2 times the energy.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[define(r1 = sqrt((x + mu)^2 + y^2 + z^2))]
#[define(r2 = sqrt((x - 1 + mu)^2 + y^2 + z^2))]
#[lagrangian(((x_dot - y)^2 + (y_dot + x)^2 + z_dot^2)/2 + (1 - mu)/r1 + mu/r2)]
struct Moon {
    mu: f64,
}

impl Moon {
    const EARTHS: Self = Self { mu: 0.012_150_585_609_624_04 };
}

const PLANET: Planet<f64> = Planet { mu: 1.0 };

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
        let orbit = PLANET.periodic_orbit(&guess).period(TAU).find().unwrap();
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

/// Orbits of a planet fill a space: nothing bifurcates among those of one energy.
#[test]
fn planets_do_not_bifurcate() {
    let guess = State::new([0.5, 0.0], [0.0, 3.0_f64.sqrt()]);
    let search = PLANET.periodic_orbit(&guess).period_near(6.3).mirrored(&["y", "x_dot"]).energy(-0.5);
    let family = search.family(&search.find().unwrap()).backwards().orbits(30).follow().unwrap();
    assert!(family.bifurcations().is_empty() && family.lost().is_empty(), "{family}");
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

/// Where the orbits get unstable another family is as near as the next member: the steps shorten, and the family does not change.
#[test]
fn orbits_of_one_family_stay_in_it() {
    let system = ThreeBodies { mu: Moon::EARTHS.mu };
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
