//! Small oscillations of the spherical pendulum, the first problem of Milton's chapter 8:
//! T = 2π √(l/g) (1 + (a² + b²)/16 l²) and Δφ = 3π a b / 4 l² an orbit.

use std::f64::consts::{PI, TAU};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use lagrange_core::prelude::*;

use crate::chapter_pendulums::pendulum::{Orbit, crossings};

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(string: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
struct Pendulum {
    m: f64,
    g: f64,
    l: f64,
}

const PENDULUM: Pendulum = Pendulum { m: 1.0, g: 9.81, l: 1.0 };

/// The exact motion on an ellipse with the half-axes a and a/2.
fn orbit(a: f64) -> Orbit {
    let height = |r: f64| r * r / (1.0 + (1.0 - r * r).sqrt());
    Orbit::between([height(a / 2.0), height(a)], PENDULUM.g)
}

fn laws(a: f64) -> [f64; 2] {
    let b = a / 2.0;
    [0.75 * PI * a * b, (a * a + b * b) / 16.0]
}

/// Precession and period of the integrated motion, the mean over the orbits between the first and the last passage
/// at the far end of the ellipse where the bob started. The sense of the motion is that of `sign`.
fn measured(a: f64, sign: f64) -> [f64; 2] {
    let orbit = orbit(a);
    let [low, high] = orbit.heights;
    let l_z = sign * (2.0 * PENDULUM.g * low * high * orbit.third).sqrt();
    let start = State::new([a, 0.0, high - 1.0], [0.0, l_z / a, 0.0]);
    let period = TAU / PENDULUM.g.sqrt();
    let path = PENDULUM.integrate(start, 21.0 * period, Dop853::default().fixed_step(period / 96.0)).unwrap();
    let place = |t: f64| *path.at(t).unwrap().state();
    let growth = |t: f64| place(t).q.xy().dot(&place(t).v.xy());
    let passages = crossings(path.steps().map(|s| s.time()), growth);
    let ends: Vec<_> = passages
        .into_iter()
        .map(|t| (t, place(t).q))
        .filter(|(_, q)| q.z > f64::midpoint(low, high) - 1.0 && q.x > 0.0)
        .map(|(t, q)| (t, q.y.atan2(q.x)))
        .collect();
    let (first, last) = (ends[0], ends[ends.len() - 1]);
    let orbits = (ends.len() - 1) as f64;
    [(last.1 - first.1) / orbits, (last.0 - first.0) / orbits]
}

/// With b = a/2, recomputed in multiple precision: Δφ and its ratio to the law, and the ratio of the period's excess.
const REFERENCE: [(f64, f64, f64, f64); 6] = [
    (0.2, 0.047_799_768_297_893_6, 1.014_342_587_100_94, 1.010_198_378_27),
    (0.1, 0.011_822_592_411_597_4, 1.003_532_811_982_11, 1.002_518_081_08),
    (0.05, 0.002_947_834_854_782_21, 1.000_879_975_588_63, 1.000_627_592_22),
    (0.025, 0.000_736_472_614_376_263, 1.000_219_793_320_9, 1.000_156_778_18),
    (0.0125, 0.000_184_087_807_003_871, 1.000_054_935_811_85, 1.000_039_187_06),
    (0.00625, 4.602_005_562_917_6e-5, 1.000_013_733_170_84, 1.000_009_796_3),
];

#[test]
fn quadrature_against_multiple_precision() {
    for (a, precession, ratio, excess) in REFERENCE {
        assert_relative_eq!(orbit(a).precession(), precession, max_relative = 1e-14);
        assert_abs_diff_eq!(orbit(a).precession() / laws(a)[0], ratio, epsilon = 2e-14);
        assert_abs_diff_eq!(orbit(a).period_excess() / laws(a)[1], excess, epsilon = 1e-11);
    }
}

/// The ratios to the laws tend to 1 with the square of the amplitude, over three decades.
#[test]
fn laws_are_approached_by_the_square_of_the_amplitude() {
    let errors = |a: f64| {
        let (orbit, [precession, excess]) = (orbit(a), laws(a));
        [orbit.precession() / precession - 1.0, orbit.period_excess() / excess - 1.0]
    };
    for a in (0..10).map(|k| 0.2 * 0.5_f64.powi(k)) {
        let (large, small) = (errors(a), errors(a / 2.0));
        for i in 0..2 {
            // The next term of the series is smaller by a², and ratio − 1 has an error of 10⁻¹⁵.
            let tolerance = a * a + 1e-15 / small[i];
            assert_abs_diff_eq!((large[i] / small[i]).log2(), 2.0, epsilon = tolerance);
        }
    }
    assert!(errors(0.2e-3)[0] < 2e-8);
}

/// The integrated motion, in both senses: its precession and period are those of the quadrature to round-off, so that
/// the ratio to the law is seen to go to 1 over three decades.
#[test]
fn motion_against_quadrature_over_three_decades() {
    for a in (0..=10).map(|k| 0.2 * 0.5_f64.powi(k)) {
        let (exact, [precession, period]) = (orbit(a), measured(a, 1.0));
        assert_abs_diff_eq!(precession, exact.precession(), epsilon = 2e-14);
        assert_abs_diff_eq!(period, 2.0 * exact.nutation(), epsilon = 1e-13);
        assert_abs_diff_eq!(precession / laws(a)[0], 1.0, epsilon = 0.36 * a * a + 2e-14 / laws(a)[0]);
    }
    assert_abs_diff_eq!(measured(0.1, -1.0)[0], -orbit(0.1).precession(), epsilon = 2e-14);
}

/// In a plane T = 2π √(l/g)/M(1, cos ½α), with the arithmetic-geometric mean; there is no precession.
#[test]
fn planar_swing() {
    for angle in [1e-3, 0.3, 1.5, 2.5_f64] {
        let (mut a, mut b) = (1.0, (angle / 2.0).cos());
        for _ in 0..8 {
            (a, b) = (f64::midpoint(a, b), f64::sqrt(a * b));
        }
        let exact = TAU / PENDULUM.g.sqrt() / a;
        let energy = PENDULUM.g * 2.0 * (angle / 2.0).sin().powi(2);
        assert_relative_eq!(2.0 * Orbit::of(energy, 0.0, PENDULUM.g).nutation(), exact, max_relative = 1e-14);
        assert_eq!(Orbit::of(energy, 0.0, PENDULUM.g).precession(), 0.0);

        let start = State::at_rest([angle.sin(), 0.0, -angle.cos()]);
        let path = PENDULUM.integrate(start, 6.0 * exact, Dop853::with_tolerance(1e-14)).unwrap();
        let passages = crossings(path.steps().map(|s| s.time()), |t| path.at(t).unwrap().state().q.x);
        assert_relative_eq!((passages[10] - passages[0]) / 5.0, exact, max_relative = 1e-11);
        assert!(path.steps().all(|s| s.state().q.y == 0.0));
    }
    // The limit of the law.
    assert_relative_eq!(
        Orbit::of(1e-9, 0.0, PENDULUM.g).nutation(),
        PI / 9.81_f64.sqrt(),
        max_relative = 1e-10
    );
}
