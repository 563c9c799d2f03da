//! Derivatives across impacts and openings, by closed forms and by differences of whole motions.

use lagrange_core::contact::Transition;
use lagrange_core::prelude::*;
use lagrange_random::cases;
use lagrange_systems::{Ball, Slot};

use crate::method;

/// From y₀ above the floor, with velocity w: v = √(w² + 2 g y₀) at the first impact, at t = (w + v)/g; then bounces of 2 eⁿ v/g.
/// After the third impact the ball is at y = r + u τ − g τ²/2 with u = e³ v, after all of (w + v + 2 (e + e²) v)/g.
#[test]
fn a_bouncing_ball_has_the_derivatives_of_its_series() {
    let (g, r, e, y, w, end) = (9.81_f64, 0.1, 0.8, 1.1, 0.5_f64, 1.9);
    let ball = Ball { m: 0.7, g, r, e, ..Ball::default() };
    for tolerance in [1e-10, 1e-13] {
        let method = Dop853::with_tolerance(tolerance);
        let path = ball.motion(State::new([0.0, y], [0.3, w])).by(method).with_contacts().to(end).unwrap();
        assert_eq!(path.transitions().len(), 3);
        let names = ["y", "y_dot", "m", "g", "r", "e", "x_dot"];
        let found = path.sensitivity(&names, method).unwrap();
        let v = (w * w + 2.0 * g * (y - r)).sqrt();
        let (u, tau) = (e * e * e * v, end - (w + v + 2.0 * (e + e * e) * v) / g);
        assert!((path.end().state().q[1] - (r + u * tau - g * tau * tau / 2.0)).abs() < 1e-9);
        let by = |dv: f64, dw: f64, dg: f64, de: f64, dr: f64| {
            let du = e * e * e * dv + 3.0 * e * e * v * de;
            let sum = w + v + 2.0 * (e + e * e) * v;
            let dsum = dw + dv + 2.0 * (e + e * e) * dv + 2.0 * (1.0 + 2.0 * e) * v * de;
            let dtau = -dsum / g + sum / (g * g) * dg;
            [dr + du * tau + (u - g * tau) * dtau - dg * tau * tau / 2.0, du - g * dtau - tau * dg]
        };
        let expected = [
            by(g / v, 0.0, 0.0, 0.0, 0.0),
            by(w / v, 1.0, 0.0, 0.0, 0.0),
            [0.0; 2],
            by((y - r) / v, 0.0, 1.0, 0.0, 0.0),
            by(-g / v, 0.0, 0.0, 0.0, 1.0),
            by(0.0, 0.0, 0.0, 1.0, 0.0),
            [0.0; 2],
        ];
        for (j, [dy, dv]) in expected.into_iter().enumerate() {
            let error = (found.q[(1, j)] - dy).abs().max((found.v[(1, j)] - dv).abs());
            assert!(error < 1e3 * tolerance, "by {}: {error:e}", names[j]);
        }
        assert!((found.q[(0, 6)] - end).abs() < 1e-12 && found.t.amax() == 0.0);
        assert_eq!(&found.state, path.end().state());
    }
}

#[test]
fn what_has_no_derivative_is_named() {
    let ball = Ball { m: 1.0, g: 9.81, e: 0.5, ..Ball::default() };
    let of = |start, end| {
        let path = ball.motion(start).by(method()).with_contacts().to(end).unwrap();
        path.sensitivity(&["y", "e"], method()).unwrap_err()
    };
    let rests = of(State::at_rest([0.0, 1.0]), 5.0);
    assert!(matches!(rests, Error::NoDerivativeAcross { contact: "floor", .. }), "{rests}");
    assert!(rests.to_string().contains("`floor`") && rests.to_string().contains("accumulate"), "{rests}");
    let starts = of(State::new([0.0, 0.0], [0.0, -1.0]), 0.1);
    assert!(matches!(starts, Error::NoDerivativeAcross { contact: "floor", time: 0.0, .. }), "{starts}");
}

/// A ball that is thrown up to a ceiling and just reaches it, at the speed v: the derivative grows like 1/v, down to heights that
/// are round-off.
#[test]
fn a_ball_that_just_reaches_a_ceiling() {
    let thrown = Slot { g: 2.0, e: [0.0, 0.5], low: -9.0, ..Slot::default() };
    let mut counts = [0; 2];
    for k in (0..60).step_by(cases([2, 1, 1])) {
        let start = State::new([-1.0 + 1e-6 * 0.5_f64.powi(k)], [2.0]);
        let speed = (4.0 * (start.q[0] + 1.0)).sqrt();
        let path = thrown.motion(start).by(method()).with_contacts().to(1.5).unwrap();
        let end = path.sensitivity(&["y"], method()).unwrap();
        match path.legs().len() {
            1 => assert!(speed < 1e-7 && (end.q[(0, 0)] - 1.0).abs() < 1e-9, "{speed:e}: {end:?}"),
            _ => {
                // After the impact, y = −v τ/2 − τ² with τ = t − 1 + v/2.
                let tau = 0.5 + speed / 2.0;
                let expected = (-tau / 2.0 - (speed / 2.0 + 2.0 * tau) / 2.0) * 2.0 / speed;
                // The square of the speed is known to the round-off of the height, and the derivative says what it was.
                let off = speed * speed * (1.0 - (expected / end.q[(0, 0)]).powi(2));
                assert!(off.abs() < 8e-15 + 2e-9 * speed * speed, "{speed:e}: {off:e}");
            }
        }
        counts[usize::from(path.legs().len() > 1)] += 1;
    }
    assert!(counts.iter().all(|count| 3 * count > counts[0] + counts[1]), "{counts:?}");
}

/// A ceiling that comes down catches a ball which is slower by 10⁻⁹ of its speed.
#[test]
fn a_gap_that_closes_too_slowly_is_named() {
    let slot = Slot { e: [0.0, 0.5], low: -9.0, speed: 1.0, ..Slot::default() };
    for (slower, is_grazing) in [(1e-9, true), (1e-7, false)] {
        let start = State::new([-slower], [slower - 1.0]);
        let path = slot.motion(start).by(method()).with_contacts().to(2.0).unwrap();
        assert!(matches!(path.transitions(), [Transition::Impact { .. }]), "{path:?}");
        match path.sensitivity(&["y", "speed"], method()) {
            Err(error) => {
                assert!(is_grazing && matches!(error, Error::Grazing { event: "ceiling", .. }), "{error}");
            }
            // y⁺ = w t + (w − v)/2 (t − t₁) with t₁ = y₀/(w − v), downwards.
            Ok(end) => {
                assert!(!is_grazing);
                let expected = -0.5;
                assert!((end.q[(0, 0)] - expected).abs() < 1e-8, "{}", end.q[(0, 0)] - expected);
            }
        }
    }
}
