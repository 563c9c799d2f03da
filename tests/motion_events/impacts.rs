//! Velocities that jump because a constraint is hit.

use lagrange_core::error::Row;
use lagrange_core::{Crossing, Dop853, prelude::*};

use crate::Rod;

/// Of the rod alone: 1/m* = 1/m + a² cos²θ / (m a²/3) is what its end weighs upwards, and Λ = −(1 + e) m* ẏ_end.
#[test]
fn a_rod_that_hits_the_ground_with_its_end_turns() {
    let rod = Rod { m: 3.0, a: 0.5, g: 9.81 };
    for (theta, e) in [(0.4_f64, 0.0), (0.4, 0.7), (1.2, 1.0), (-2.0, 0.3)] {
        let before = State::new([0.3, rod.a * theta.sin(), theta], [0.2, -1.5, 0.6]).at_time(3.0);
        let impact = rod.impact(&before, "ground", e).unwrap();
        let end = |s: &State<f64, 3>| s.v[1] - rod.a * theta.cos() * s.v[2];
        let effective = rod.m / (1.0 + 3.0 * theta.cos().powi(2));
        let impulse = -(1.0 + e) * effective * end(&before);
        let after = impact.state;
        assert!((impact.impulse("ground").unwrap() - impulse).abs() < 1e-14);
        assert!((end(&after) + e * end(&before)).abs() < 1e-15);
        assert_eq!((after.t, after.q, after.v[0]), (before.t, before.q, before.v[0]));
        assert!((after.v[1] - before.v[1] - impulse / rod.m).abs() < 1e-15);
        let turn = -impulse * rod.a * theta.cos() / (rod.m * rod.a * rod.a / 3.0);
        assert!((after.v[2] - before.v[2] - turn).abs() < 1e-14);
        // (1 − e²) of the energy of the end is lost.
        let lost = rod.energy(&before) - rod.energy(&after);
        assert!((lost - (1.0 - e * e) * effective / 2.0 * end(&before).powi(2)).abs() < 1e-13, "{lost}");
    }
}

/// A bob on a rod, and a wall that moves: the rod holds on, the wall throws the bob back.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[constraint(wall: x - w*t = 0)]
struct Walled {
    m: f64,
    g: f64,
    l: f64,
    w: f64,
}

#[test]
fn the_other_constraints_hold_on() {
    let system = Walled { m: 2.0, g: 9.81, l: 1.0, w: 0.25 };
    let (t, e) = (1.2, 0.6);
    let (x, y) = (0.3, -(1.0 - 0.09_f64).sqrt());
    // Along the rod nothing moves: ẋ = −y ω, ẏ = x ω.
    let omega = -2.0;
    let before = State::new([x, y], [-y * omega, x * omega]).at_time(t);
    let impact = system.impact(&before, "wall", e).unwrap();
    let after = impact.state;
    assert!((after.v[0] - 0.25 + e * (before.v[0] - 0.25)).abs() < 1e-14);
    assert!((x * after.v[0] + y * after.v[1]).abs() < 1e-14);
    let momentum = 2.0 * (after.v - before.v);
    let impulses = [impact.impulse("rod").unwrap(), impact.impulse("wall").unwrap()];
    assert!((momentum[0] - x * impulses[0] - impulses[1]).abs() < 1e-13);
    assert!((momentum[1] - y * impulses[0]).abs() < 1e-13);
    assert_eq!(impact.impulses.as_slice(), impulses);
}

/// Where the mass matrix is singular and where constraints say the same twice, the general solve serves.
#[test]
fn singular_and_dependent_systems_have_impacts() {
    #[derive(Lagrangian)]
    #[coordinates(x, z)]
    #[lagrangian(m/2 * x_dot^2)]
    #[constraint(lever: c[0]*(z - 2*x) = 0)]
    #[constraint(again: c[1]*(z^2/2 - 2*x^2) = 0)]
    #[constraint(stop: c[2]*(z - 1) = 0)]
    struct Lever {
        m: f64,
        /// Were one of them zero, the other constraints would be needed.
        c: [f64; 3],
    }
    let lever = Lever { m: 4.0, c: [1.0; 3] };
    let impact = lever.impact(&State::new([0.5, 1.0], [1.0, 2.0]), "stop", 0.5).unwrap();
    assert!((impact.state.v[0] + 0.5).abs() < 1e-14 && (impact.state.v[1] + 1.0).abs() < 1e-14);
    // 4 (−0.5 − 1) = −2 Λ_lever − 2 Λ_again, 0 = Λ_lever + Λ_again + Λ_stop.
    let [lever, again, stop] = impact.impulses.into();
    assert!((lever + again - 3.0).abs() < 1e-13 && (stop + 3.0).abs() < 1e-13);
}

#[test]
fn what_cannot_be_hit_is_named() {
    let rod = Rod { m: 3.0, a: 0.5, g: 9.81 };
    let on = State::new([0.0, 0.5 * 0.4_f64.sin(), 0.4], [0.0, -1.0, 0.0]);
    let error = rod.impact(&on, "floor", 0.5).err().unwrap();
    assert!(error.to_string().contains("there is no constraint `floor`"), "{error}");
    let error = rod.impact(&State { q: [0.0, 1.0, 0.4].into(), ..on }, "ground", 0.5).err().unwrap();
    assert!(
        matches!(error, Error::Inconsistent { constraint: Row::Constraint("ground"), rate: false, .. }),
        "{error}"
    );
    for e in [-0.1, f64::NAN, f64::INFINITY] {
        let error = rod.impact(&on, "ground", e).err().unwrap();
        assert!(matches!(error, Error::Restitution { .. }), "{error}");
    }
    let error = rod.impact(&State { v: [f64::NAN; 3].into(), ..on }, "ground", 0.5).err().unwrap();
    assert!(matches!(error, Error::StateNotFinite { .. }), "{error}");
}

/// A free rod by one system, its impacts by the one that has the ground: the energy is kept where e = 1.
#[test]
fn a_rod_bounces_on_its_ends() {
    #[derive(Lagrangian)]
    #[coordinates(x, y, theta)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*a^2/6 * theta_dot^2 - m*g*y)]
    struct Flying {
        m: f64,
        a: f64,
        g: f64,
    }
    let (flying, ground) = (Flying { m: 3.0, a: 0.5, g: 9.81 }, Rod { m: 3.0, a: 0.5, g: 9.81 });
    let start = State::new([0.0, 1.0, 0.3], [0.4, 0.0, 0.0]);
    let method = Dop853::with_tolerance(1e-12).max_step(0.1);
    let mut motion = Motion::new(&flying, start, method).unwrap();
    let end = |s: &State<f64, 3>, a: f64| s.q[1] - a * s.q[2].sin();
    let mut left = flying.event("left", |s| end(s.state(), 0.5)).falling();
    let mut right = flying.event("right", |s| end(s.state(), -0.5)).falling();
    let mut bounces = 0;
    while let Some(Crossing { event, state, .. }) =
        motion.advance_to_event(5.0, &mut [&mut left, &mut right]).unwrap()
    {
        // The other end is the one that points half a turn further.
        let turn = if event == "left" { 0.0 } else { std::f64::consts::PI };
        let mut turned = state;
        turned.q[2] += turn;
        let mut after = ground.impact(&turned, "ground", 1.0).unwrap().state;
        after.q[2] -= turn;
        motion.set_state(after).unwrap();
        bounces += 1;
        assert!((flying.energy(motion.state()) / flying.energy(&start) - 1.0).abs() < 1e-11);
        assert!((motion.state().v[0] - 0.4).abs() < 1e-15);
    }
    assert!(bounces > 8 && (motion.state().t - 5.0).abs() == 0.0, "{bounces}");
    assert!(motion.state().q[1] > 0.0);
}
