//! Bodies at rest that begin to slide.

use lagrange_core::contact::{Contact, Friction, Transition};
use lagrange_core::prelude::*;

/// A block at rest on a table that tilts begins to slide where tan(ω t) = μ, with a force that grows slowly: its direction is
/// stiff, which `Radau` follows.
#[test]
fn a_block_begins_to_slide_in_the_plane() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, z)]
    #[define(alpha = omega*t)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + m*g*(sin(alpha)*(x*c + y*s) - cos(alpha)*z))]
    #[contact(plane: z >= 0, friction(mu): [x_dot, y_dot])]
    struct Tilting {
        m: f64,
        g: f64,
        omega: f64,
        c: f64,
        s: f64,
        mu: f64,
        plane: Contact,
    }
    let (omega, mu) = (0.1, 0.5_f64);
    let table = Tilting { m: 2.0, g: 10.0, omega, c: 0.6, s: 0.8, mu, plane: Contact::Closed };
    let motion = table.motion(State::at_rest([0.0; 3])).by(Radau::with_tolerance(1e-10));
    let path = motion.with_contacts().to(6.0).unwrap();
    let begins = mu.atan() / omega;
    let [Transition::Slips { time, .. }] = path.transitions() else { panic!("{:?}", path.transitions()) };
    assert!((time - begins).abs() < 1e-11, "{time} for {begins}");
    // v̇ = g (sin ωt − μ cos ωt).
    let speed = |t: f64| 10.0 / omega * (-(omega * t).cos() - mu * (omega * t).sin());
    let expected = speed(6.0) - speed(begins);
    let v = path.end().v;
    assert!((v[0] - 0.6 * expected).abs() < 1e-8 && (v[1] - 0.8 * expected).abs() < 1e-8, "{v:?} {expected}");
}

/// A puck at rest begins to slide along a load that turns: against implicit steps by hand, v' = the projection of v + h F/m onto
/// zero by h μ g.
#[test]
fn a_puck_begins_to_slide_along_a_load_that_turns() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, y, z)]
    #[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
    #[force(x: m*(b*t + sin(omega*t)))]
    #[force(y: m*c*t)]
    #[contact(floor: z >= 0, friction(mu): [x_dot, y_dot])]
    struct Puck {
        m: f64,
        g: f64,
        b: f64,
        c: f64,
        omega: f64,
        mu: f64,
        floor: Contact,
    }
    let (omega, mu, h) = (3.0_f64, 0.5, 1e-5);
    for (b, c) in [(0.2, 1.0), (1.0, 0.2), (-0.4, -0.7)] {
        let (mut q, mut v) = ([0.0; 2], [0.0; 2]);
        for step in 0..300_000 {
            let t = (f64::from(step) + 0.5) * h;
            let free = [v[0] + h * (b * t + (omega * t).sin()), v[1] + h * c * t];
            let speed = f64::hypot(free[0], free[1]);
            let kept = (1.0 - h * mu / speed).max(0.0);
            for i in 0..2 {
                q[i] += h * (v[i] + kept * free[i]) / 2.0;
                v[i] = kept * free[i];
            }
        }
        let puck = Puck { m: 2.0, g: 1.0, b, c, omega, mu, floor: Contact::Closed };
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let motion = puck.motion(State::at_rest([0.0; 3])).by(Radau::with_tolerance(tolerance));
            let path = motion.with_contacts().to(3.0).unwrap();
            let found = path.end().q;
            let off = f64::hypot(found[0] - q[0], found[1] - q[1]);
            assert!(off < 1e-5, "({b}, {c}), {tolerance}: {found:?} for {q:?}");
        }
    }
}

/// A cart on four wheels, of which two on a diagonal carry it: all begin to slide at once, at μ m g, also those without a limit.
#[test]
fn four_wheels_begin_to_slide_at_once() {
    #[derive(Clone, Lagrangian)]
    #[coordinates(x, z, a, b)]
    #[lagrangian((m*x_dot^2 + m*z_dot^2 + a_dot^2 + b_dot^2)/2 - m*g*z)]
    #[force(x: t)]
    #[define(along = [1, -1, -1, 1])]
    #[define(across = [1, 1, -1, -1])]
    #[contact(wheel[i in 0..4]: z + across[i]*a - along[i]*b >= 0, friction(mu): x_dot)]
    struct Cart {
        m: f64,
        g: f64,
        mu: f64,
        wheel: [Contact; 4],
    }
    let cart = Cart { m: 1.0, g: 10.0, mu: 0.2, wheel: [Contact::Closed; 4] };
    let path = cart.motion(State::at_rest([0.0; 4])).with_contacts().to(5.0).unwrap();
    let slips = path.transitions().iter().filter(|of| matches!(of, Transition::Slips { .. }));
    assert!(slips.clone().count() > 0 && slips.map(Transition::time).all(|time| (time - 2.0).abs() < 1e-11));
    // ẍ = t − μ g.
    assert!((path.end().q[0] - 4.5).abs() < 1e-11 && (path.end().v[0] - 4.5).abs() < 1e-11);
}

/// A block that a turning pull keeps near the limit of its friction, beside a body that swings.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2)]
#[force(x: 49/50*cos(3*t) + t/100)]
#[force(y: 49/50*sin(3*t))]
#[force(z: -sin(t))]
#[friction(rub: [x_dot, y_dot], limit: 1, sliding: 1)]
struct Turned {
    rub: Friction,
}

/// Its velocity is much smaller than the tolerance when it begins to slide. Stages guessed from the step before took 3,354 steps, with
/// those refused.
#[test]
fn a_block_begins_to_slide_in_few_steps() {
    let motion = Turned { rub: Friction::Sticks }.motion(State::new([0.0; 3], [0.0, 0.0, 1.0]));
    let path = motion.by(Radau::with_tolerance(1e-6)).with_contacts().to(30.0).unwrap();
    assert_eq!(path.transitions().len(), 27);
    let statistics = path.statistics();
    let steps = statistics.accepted + statistics.rejected;
    assert!(steps < 2_400, "{steps} steps");
}
