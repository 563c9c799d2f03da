//! Small oscillations of the spherical pendulum, the first problem of Milton's chapter 8:
//! T = 2π √(l/g) (1 + (a² + b²)/16 l²) and Δφ = 3π a b / 4 l² an orbit.

use std::f64::consts::{PI, TAU};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use lagrange_core::prelude::*;
use lagrange_systems::SphericalPendulum;

use crate::pendulum::{Orbit, crossings};

const PENDULUM: SphericalPendulum<f64> = SphericalPendulum { m: 1.0, g: 9.81, l: 1.0 };

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
