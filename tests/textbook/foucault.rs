//! Foucault's pendulum: the pendulum on a string (8.11) in the rotating frame (8.44).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use lagrange_core::prelude::*;
use lagrange_systems::Foucault;

use crate::pendulum::{Orbit, crossings};

/// On an Earth that turns 20 times a day, for the twentieth of a day.
const SPAN: f64 = 86_164.1 / 20.0;

fn at(latitude: f64) -> Foucault<f64> {
    Foucault { m: 28.0, g: 9.81, l: 67.0, rate: TAU / SPAN, latitude }
}

/// Let go at this distance to the east, with a velocity of this part of Ω_z a to the south: with 1 the bob hangs still
/// for an observer who does not turn, and swings through the centre.
fn start(pendulum: &Foucault<f64>, a: f64, part: f64) -> State<f64, 3> {
    let south = part * pendulum.rate * pendulum.latitude.sin() * a;
    State::new([a, 0.0, -(pendulum.l.powi(2) - a * a).sqrt()], [0.0, -south, 0.0])
}

/// The mean rate of the swing's azimuth: each is the mean of two neighbouring far ends.
fn rate_of_plane(pendulum: &Foucault<f64>, start: State<f64, 3>) -> f64 {
    let path = pendulum.integrate(start, SPAN, Dop853::with_tolerance(1e-11)).unwrap();
    let place = |t: f64| *path.at(t).unwrap().state();
    let growth = |t: f64| place(t).q.xy().dot(&place(t).v.xy());
    let (mut ends, mut azimuth) = (Vec::new(), 0.0);
    for t in crossings(path.steps().map(|s| s.time()), growth) {
        let q = place(t).q;
        if q.xy().norm() > start.q.x / 2.0 {
            azimuth += (q.y.atan2(q.x) - azimuth + FRAC_PI_2).rem_euclid(PI) - FRAC_PI_2;
            ends.push((t, azimuth));
        }
    }
    let mean = |i: usize| [ends[i].0 + ends[i + 1].0, ends[i].1 + ends[i + 1].1];
    let (first, last) = (mean(0), mean(ends.len() - 2));
    (last[1] - first[1]) / (last[0] - first[0])
}

/// The rate at which the ellipse of one that is let go from rest precesses on its own.
fn as_an_ellipse(pendulum: &Foucault<f64>, a: f64) -> f64 {
    let (l_z, square) = (pendulum.rate * pendulum.latitude.sin() * a * a, pendulum.l * pendulum.l);
    let energy = pendulum.g * (pendulum.l + start(pendulum, a, 0.0).q.z) + (l_z / a).powi(2) / 2.0;
    let orbit = Orbit::of(energy / square, l_z / square, pendulum.g / pendulum.l);
    l_z.signum() * orbit.precession() / (2.0 * orbit.nutation())
}

/// At the pole the frame turns about the vertical: the motion is that of the spherical pendulum, with −Ω added.
#[test]
fn at_the_pole_the_law_is_exact() {
    let pendulum = at(FRAC_PI_2);
    let straight = rate_of_plane(&pendulum, start(&pendulum, 6.0, 1.0));
    assert_relative_eq!(straight, -pendulum.rate, max_relative = 1e-8);
    let released = rate_of_plane(&pendulum, start(&pendulum, 6.0, 0.0));
    assert_relative_eq!(released, -pendulum.rate + as_an_ellipse(&pendulum, 6.0), max_relative = 1e-8);
}

/// Elsewhere the plane turns by 2π sin(latitude) a day, up to terms of the order of (a/l)² and (Ω/ω)².
#[test]
fn turns_by_the_sine_of_the_latitude() {
    for (degrees, a) in [(70.0, 3.0), (48.846, 3.0), (48.846, 0.3), (-30.0, 3.0), (-30.0, 0.3_f64)] {
        let pendulum = at(f64::to_radians(degrees));
        let law = -pendulum.rate * pendulum.latitude.sin();
        let orders = (a / pendulum.l).powi(2) + pendulum.rate.powi(2) * pendulum.l / pendulum.g;
        let rate = rate_of_plane(&pendulum, start(&pendulum, a, 1.0));
        assert_relative_eq!(rate, law, max_relative = orders);
    }
}

/// At the equator a swing to the east stays in its plane.
#[test]
fn at_the_equator_it_does_not_turn() {
    let pendulum = at(0.0);
    assert_abs_diff_eq!(rate_of_plane(&pendulum, start(&pendulum, 3.0, 0.0)), 0.0, epsilon = 1e-12);
}
