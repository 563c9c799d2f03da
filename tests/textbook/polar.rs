//! The spherical pendulum in polar coordinates: Milton (8.23)–(8.31), with θ counted from the downward vertical.

use std::f64::consts::{PI, TAU};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use lagrange_core::prelude::*;
use lagrange_random::cases;
use lagrange_systems::{PolarPendulum, SphericalPendulum};

use crate::pendulum::{Orbit, crossings};

const G: f64 = 9.81;
const PENDULUM: PolarPendulum<f64> = PolarPendulum { m: 1.0, g: G, l: 1.0 };

/// At a turning point, this far from the downward vertical.
fn turning(angle: f64, phi_dot: f64) -> State<f64, 2> {
    State::new([angle, 0.0], [0.0, phi_dot])
}

fn orbit(start: &State<f64, 2>) -> Orbit {
    Orbit::of(PENDULUM.energy(start) + G, PENDULUM.momentum(start)[1], G)
}

/// Generic; from small to nearly over the top.
fn pendulums() -> impl Iterator<Item = State<f64, 2>> {
    let starts = [(2.2, -2.5), (PI / 3.0, 1.5), (0.1, 1.0), (PI / 2.0, 1.0), (3.0, 4.0)];
    starts.into_iter().take(cases([1, 5, 5])).map(|(angle, phi_dot)| turning(angle, phi_dot))
}

/// The nutation period and the precession of each, recomputed with 60 digits both by elliptic functions and by
/// direct quadrature, which agree.
#[test]
fn quadratures_8_28_and_8_31_against_elliptic_functions() {
    let reference = [
        (turning(0.1, 1.0), 1.003_723_877_220_113_3, 0.007_510_623_962_887_884),
        (turning(PI / 3.0, 1.5), 1.078_462_326_167_675, 1.026_619_775_091_092_4),
        (turning(PI / 2.0, 1.0), 1.176_933_241_758_156_8, 1.176_933_241_758_156_8),
    ];
    for (start, nutation, precession) in reference {
        let orbit = orbit(&start);
        assert_relative_eq!(orbit.nutation(), nutation, max_relative = 4e-15);
        assert_relative_eq!(orbit.precession(), precession, max_relative = 1e-13);
    }
}

/// The roots of (8.26) for the second of them.
#[test]
fn turning_points_8_26() {
    let orbit = orbit(&turning(PI / 3.0, 1.5));
    assert_relative_eq!(orbit.heights[0], 1.0 - 0.936_201_625_733_074_5, max_relative = 1e-14);
    assert_relative_eq!(orbit.heights[1], 0.5, max_relative = 1e-14);
    assert_relative_eq!(orbit.third, 2.0 + 0.022_210_800_045_001, max_relative = 1e-14);
}

/// E (8.24) and L_z (8.25), as the chapter writes them, and conserved.
#[test]
fn energy_8_24_and_angular_momentum_8_25() {
    let pendulum = PolarPendulum { m: 1.3, g: G, l: 0.7 };
    let (m, g, l) = (pendulum.m, pendulum.g, pendulum.l);
    for start in pendulums() {
        let path = pendulum.integrate(start, 50.0, Dop853::with_tolerance(1e-12)).unwrap();
        let (energy, l_z) = (pendulum.energy(&start), pendulum.momentum(&start)[1]);
        for sample in path.steps() {
            let s = sample.state();
            let ([theta, _], [theta_dot, phi_dot]) = (s.q.data.0[0], s.v.data.0[0]);
            let sine = theta.sin();
            let kinetic = m * l * l / 2.0 * (theta_dot.powi(2) + (sine * phi_dot).powi(2));
            assert_abs_diff_eq!(pendulum.energy(s), kinetic - m * g * l * theta.cos(), epsilon = 1e-13);
            assert_relative_eq!(pendulum.momentum(s)[1], m * l * l * sine * sine * phi_dot, epsilon = 1e-14);
            assert_abs_diff_eq!(pendulum.energy(s), energy, epsilon = 1e-9);
            assert_abs_diff_eq!(pendulum.momentum(s)[1], l_z, epsilon = 1e-9);
        }
    }
}

/// The times of the lower turning points, where θ̇ passes through zero from below, and the azimuth at them.
fn lower_turning_points(path: &Trajectory<&PolarPendulum<f64>>) -> Vec<(f64, f64)> {
    let rate = |t: f64| path.at(t).unwrap().state().v[0];
    let times = crossings(path.steps().map(|s| s.time()), rate);
    let azimuth = |t: f64| path.at(t).unwrap().state().q[1];
    let lower = times.into_iter().filter(|t| path.at(*t).unwrap().acceleration("theta").unwrap() > 0.0);
    lower.map(|t| (t, azimuth(t))).collect()
}

/// Compares period and precession of every nutation in 30 s with the quadratures.
fn check_nutations(start: State<f64, 2>) {
    let orbit = orbit(&start);
    let path = PENDULUM.integrate(start, 30.0, Dop853::with_tolerance(1e-14)).unwrap();
    let turns = lower_turning_points(&path);
    assert!(turns.len() > 12, "{} turning points", turns.len());
    for pair in turns.windows(3) {
        assert_abs_diff_eq!(pair[1].0 - pair[0].0, orbit.nutation(), epsilon = 1e-9);
        let ellipse = (pair[2].1 - pair[0].1).abs() - TAU;
        assert_abs_diff_eq!(ellipse, orbit.precession(), epsilon = 1e-9);
    }
}

#[test]
fn period_8_28_and_precession_8_31_of_the_integrated_motion() {
    pendulums().for_each(check_nutations);
}

/// The cone: the angle stays, the azimuth grows by √(g/(l cos α)) t.
#[test]
fn conical_pendulum() {
    let rate = (G / 0.8_f64.cos()).sqrt();
    let path = PENDULUM.integrate(turning(0.8, rate), 30.0, Dop853::with_tolerance(1e-14)).unwrap();
    for sample in path.steps() {
        assert_abs_diff_eq!(sample.state().q[0], 0.8, epsilon = 1e-11);
        assert_relative_eq!(sample.state().q[1], rate * sample.time(), epsilon = 1e-10);
    }
}

/// Near the cone it nutates with Ω² = (g/l)(1 + 3 cos² α)/cos α; the quadrature says the same, and so does the motion.
#[test]
fn nutation_about_the_cone() {
    let cosine = 0.8_f64.cos();
    let conical = turning(0.8, (G / cosine).sqrt());
    let frequency = (G * (1.0 + 3.0 * cosine * cosine) / cosine).sqrt();
    assert_relative_eq!(orbit(&conical).nutation(), TAU / frequency, max_relative = 1e-12);

    check_nutations(turning(0.8, 1.02 * (G / cosine).sqrt()));
}

/// Both forms of the pendulum move alike, with the multiplier and without.
#[test]
fn polar_and_cartesian_are_one_motion() {
    let cartesian = SphericalPendulum { m: PENDULUM.m, g: G, l: PENDULUM.l };
    for start in pendulums() {
        let method = Dop853::with_tolerance(1e-12).absolute_tolerance(1e-13);
        let polar = PENDULUM.integrate(start, 50.0, method).unwrap();
        let [q, v] = on_the_sphere(&start);
        let other = cartesian.integrate(State::new(q, v), 50.0, method).unwrap();
        for (a, b) in polar.samples(1001).zip(other.samples(1001)) {
            let [q, v] = on_the_sphere(a.state());
            for i in 0..3 {
                assert_abs_diff_eq!(q[i], b.state().q[i], epsilon = 1e-8);
                assert_abs_diff_eq!(v[i], b.state().v[i], epsilon = 1e-8);
            }
        }
    }
}

/// Position and velocity for l = 1.
fn on_the_sphere(s: &State<f64, 2>) -> [[f64; 3]; 2] {
    let ((st, ct), (sp, cp)) = (s.q[0].sin_cos(), s.q[1].sin_cos());
    let (along, across) = (s.v[0], st * s.v[1]);
    let velocity = [ct * cp * along - sp * across, ct * sp * along + cp * across, st * along];
    [[st * cp, st * sp, -ct], velocity]
}
