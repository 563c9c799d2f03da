//! Derivatives across events, by closed forms and by laws.

use lagrange_core::prelude::*;
use lagrange_systems::{DrivenSpring, Flying, Sticking, Touching};
use num_dual::Dual64;

pub(crate) fn method() -> Dop853 {
    Dop853::with_tolerance(1e-13).max_step(0.2)
}

/// The height after three bounces: v₀eⁿ is the speed after impact n, 2v₀eⁿ/g until the next.
fn third_flight(t: f64, [h, g, e]: [Dual64; 3]) -> Dual64 {
    let v = (h * g * 2.0).sqrt();
    let third = v / g * (e * 2.0 + e * e * 2.0 + 1.0);
    let (tau, up) = (-third + t, v * e * e * e);
    up * tau - g * tau * tau * 0.5
}

#[test]
fn a_ball_after_three_bounces() {
    let (h, g, e) = (1.3, 9.81, 0.8);
    let (ball, floor) = (Flying { m: 0.2, g }, Touching { m: 0.2, g });
    let mut lands = ball.differentiable_event("lands", |s| s.coordinate("y")).falling().terminal();
    let start = State::new([0.0, h], [0.5, 0.0]);
    let mut at = ball.sensitivity(&start, &["y", "g", "m", "x_dot"]).unwrap().with(&["e"]).unwrap();
    for _ in 0..3 {
        let flight = ball.motion_with_derivatives(&at).by(method()).event(&mut lands).towards(10.0).unwrap();
        let landing = flight.derivatives_at_end().unwrap();
        // At the event the height is zero whatever changes.
        assert!(landing.q.row(1).amax() < 1e-14);
        at = floor.impact_sensitivity(landing, "floor", ("e", e)).unwrap();
    }
    let end = at.state.t + 0.3;
    let flight = ball.motion_with_derivatives(&at).by(method()).event(&mut lands).towards(end).unwrap();
    for t in [at.state.t + 1e-9, at.state.t + 0.13, end] {
        let [one, d] = [Dual64::from_re, |x| Dual64::from_re(x).derivative()];
        let exact = [
            third_flight(t, [d(h), one(g), one(e)]).eps,
            third_flight(t, [one(h), d(g), one(e)]).eps,
            0.0,
            0.0,
            third_flight(t, [one(h), one(g), d(e)]).eps,
        ];
        let found = flight.derivatives_at(t).unwrap();
        for (j, exact) in exact.into_iter().enumerate() {
            let found = found.q[(1, j)];
            assert!((found - exact).abs() < 1e-12 * (1.0 + exact.abs()), "{t}, {j}: {found} for {exact}");
        }
        // Whatever it does, it goes on along x.
        assert!((found.q[(0, 3)] - t).abs() < 1e-13 && found.q[(0, 4)].abs() < 1e-15);
    }
    let by = flight.derivative(end, "y", "e").unwrap();
    assert_eq!(by, flight.derivatives_at_end().unwrap().q[(1, 4)]);
}

/// Place and velocity of a block on a belt: it rides until the spring pulls with `hold`, swings about pull/k to the mirror
/// image of that place, and is caught there.
fn stick_slip(t: f64, [m, k, belt, pull, hold]: [Dual64; 5]) -> [Dual64; 2] {
    let (first, d, omega) = (hold / k / belt, (hold - pull) / k, (k / m).sqrt());
    let slips = ((omega * d / belt).atan() * -2.0 + std::f64::consts::TAU) / omega;
    let since = -first + t;
    if since.re < 0.0 {
        return [belt * t, belt];
    }
    if since.re < slips.re {
        let (sin, cos) = (omega * since).sin_cos();
        return [pull / k + d * cos + belt / omega * sin, belt * cos - omega * d * sin];
    }
    [pull / k - d + belt * (since - slips), belt]
}

#[test]
fn stick_and_slip_from_system_to_system() {
    let values @ [m, k, belt, pull, hold] = [0.7, 3.0, 0.4, 1.1, 1.7];
    let (sticking, slipping) = (Sticking { m, k, belt }, DrivenSpring { m, k, c: 0.0, a: pull, w: 0.0 });
    let mut gives = sticking
        .differentiable_event("gives", |s| Ok(s.multiplier("friction")? - s.number("hold", hold)))
        .rising()
        .terminal();
    let mut catches = slipping
        .differentiable_event("catches", |s| Ok(s.velocity("x")? - s.number("belt", belt)))
        .rising()
        .terminal();
    let start = State::new([0.0], [belt]);
    let start = sticking.sensitivity(&start, &["m", "k", "belt"]).unwrap().with(&["a", "hold"]).unwrap();
    let method = Dop853::with_tolerance(1e-13);
    let ride = sticking.motion_with_derivatives(&start).by(method).event(&mut gives).towards(50.0).unwrap();
    let slip = slipping
        .motion_with_derivatives(ride.derivatives_at_end().unwrap())
        .by(method)
        .event(&mut catches)
        .towards(50.0)
        .unwrap();
    let caught = slip.derivatives_at_end().unwrap();
    let again = sticking.motion_with_derivatives(caught).by(method).towards(caught.state.t + 0.5).unwrap();
    for (leg, part) in (0..30).map(|k| (k % 3, f64::from(1 + k / 3) / 11.0)) {
        let (start, end) = match leg {
            0 => (0.0, ride.end().time()),
            1 => (ride.end().time(), caught.state.t),
            _ => (caught.state.t, caught.state.t + 0.5),
        };
        let t = start + part * (end - start);
        let found = match leg {
            0 => ride.derivatives_at(t),
            1 => slip.derivatives_at(t),
            _ => again.derivatives_at(t),
        };
        let found = found.unwrap();
        for j in 0..5 {
            let one = |i: usize| {
                if i == j { Dual64::from_re(values[i]).derivative() } else { Dual64::from_re(values[i]) }
            };
            let [x, v] = stick_slip(t, std::array::from_fn(one));
            let off = (found.q[(0, j)] - x.eps).abs().max((found.v[(0, j)] - v.eps).abs());
            assert!(off < 1e-11 * (1.0 + x.eps.abs() + v.eps.abs()), "{t}, {j}: off by {off:e}");
        }
    }
    // δ(F q̇ + b) = 0 of the belt: it is as fast as the belt, whatever the speed of that.
    assert!(
        again.derivatives_at_end().unwrap().v.column(2)[0] == 1.0
            && again.derivatives_at_end().unwrap().v.column(0)[0] == 0.0
    );
}

/// Where the mass matrix is singular and constraints say the same twice, the general solve serves. Of the two ends of a lever,
/// of which one has the mass, the other is stopped: ẋ⁺ = −e ẋ.
#[test]
fn singular_and_dependent_systems_have_derivatives_of_impacts() {
    #[derive(Lagrangian)]
    #[coordinates(x, z)]
    #[lagrangian(m/2 * x_dot^2)]
    #[constraint(lever: c[0]*(z - r*x) = 0)]
    #[constraint(again: c[1]*(z^2/2 - r^2*x^2/2) = 0)]
    #[constraint(stop: c[2]*(z - 1) = 0)]
    struct Lever {
        m: f64,
        r: f64,
        /// Were one of them zero, the other constraints would be needed.
        c: [f64; 3],
    }
    let (lever, e) = (Lever { m: 4.0, r: 2.0, c: [1.0; 3] }, 0.5);
    let before = lever.sensitivity(&State::new([0.5, 1.0], [1.0, 2.0]), &["m"]).unwrap().with(&["e", "by"]);
    let mut before = before.unwrap();
    // Faster on the constraints.
    (before.v[(0, 2)], before.v[(1, 2)]) = (1.0, 2.0);
    let after = lever.impact_sensitivity(&before, "stop", ("e", e)).unwrap();
    let expected = [[0.0, 0.0], [-1.0, -2.0], [-e, -2.0 * e]];
    for (j, [x, z]) in expected.into_iter().enumerate() {
        assert!((after.v[(0, j)] - x).abs() < 1e-13 && (after.v[(1, j)] - z).abs() < 1e-13, "{}", after.v);
    }
}
