//! Derivatives across impacts and openings, by closed forms and by differences of whole motions.

use lagrange_core::contact::{Contact, ContactTrajectory, Contacts, Transition};
use lagrange_core::linearized::{DifferentiableMethod, Linearized, StateSensitivity};
use lagrange_core::nalgebra::Const;
use lagrange_core::prelude::*;

/// A ball over a floor.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[contact(floor: y >= r, restitution: e)]
struct Ball {
    m: f64,
    g: f64,
    r: f64,
    e: f64,
    floor: Contact,
}

/// From y₀ above the floor, with velocity w: v = √(w² + 2 g y₀) at the first impact, at t = (w + v)/g; then bounces of 2 eⁿ v/g.
/// After the third impact the ball is at y = r + u τ − g τ²/2 with u = e³ v, after all of (w + v + 2 (e + e²) v)/g.
#[test]
fn a_bouncing_ball_has_the_derivatives_of_its_series() {
    let (g, r, e, y, w, end) = (9.81_f64, 0.1, 0.8, 1.1, 0.5_f64, 1.9);
    let ball = Ball { m: 0.7, g, r, e, floor: Contact::Open };
    for tolerance in [1e-10, 1e-13] {
        let method = Dop853::with_tolerance(tolerance);
        let path = ball.motion(State::new([0.0, y], [0.3, w])).by(method).with_contacts().to(end).unwrap();
        assert_eq!(path.transitions().len(), 3);
        let names = ["y", "y_dot", "m", "g", "r", "e", "x_dot"];
        let found = path.sensitivity(&names, method).unwrap();
        let v = (w * w + 2.0 * g * (y - r)).sqrt();
        let (u, tau) = (e * e * e * v, end - (w + v + 2.0 * (e + e * e) * v) / g);
        assert!((path.end().q[1] - (r + u * tau - g * tau * tau / 2.0)).abs() < 1e-9);
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
        assert_eq!(&found.state, path.end());
    }
}

/// Derivatives of whole motions, by central differences with two steps.
pub(crate) fn check<L, D, const N: usize>(
    what: &str,
    names: &[&str],
    (method, tolerance): (D, f64),
    run: impl Fn(usize, f64) -> ContactTrajectory<L>,
) where
    L: Linearized<N = Const<N>, Scalar = f64> + Contacts + Clone,
    D: DifferentiableMethod<L>,
{
    let path = run(0, 0.0);
    let found: StateSensitivity<f64, Const<N>> = path.sensitivity(names, method).unwrap();
    for (j, name) in names.iter().enumerate() {
        let error = [1e-4, 1e-5].map(|h| {
            let values = [-2.0, -1.0, 1.0, 2.0].map(|part| *run(j, part * h).end());
            let [a, b, c, d] = &values;
            let mut error = 0.0_f64;
            for i in 0..N {
                let of = |x: fn(&State<f64, N>, usize) -> f64| {
                    (8.0 * (x(c, i) - x(b, i)) - (x(d, i) - x(a, i))) / (12.0 * h)
                };
                let [q, v] = [of(|state, i| state.q[i]), of(|state, i| state.v[i])];
                let scale = 1.0_f64.max(q.abs()).max(v.abs());
                error = error.max(((found.q[(i, j)] - q).abs()).max((found.v[(i, j)] - v).abs()) / scale);
            }
            error
        });
        let error = error[0].min(error[1]);
        println!("{what}, by {name}: {error:.1e}");
        assert!(error < tolerance, "{what}, by {name}: {error:e}");
    }
}

pub(crate) fn method() -> Dop853 {
    Dop853::with_tolerance(1e-13)
}

/// A pendulum on a rod, a curved wall that moves, and a restitution that depends on the velocity.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + n*x_dot*y_dot*x - m*g*y)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[contact(wall: a*sin(w*t) - x - y^2/5 >= 0, restitution: e*exp(-c*x_dot))]
struct Walled {
    m: f64,
    n: f64,
    g: f64,
    l: f64,
    a: f64,
    w: f64,
    e: f64,
    c: f64,
    wall: Contact,
}

#[test]
fn a_pendulum_bounces_off_a_curved_wall_that_moves() {
    let given = [1.1, 0.3, 9.81, 1.0, 0.12, 3.0, 0.9, 0.2];
    let names = ["m", "n", "g", "l", "a", "w", "e", "c"];
    let run = |j: usize, change: f64| {
        let mut given = given;
        given[j] += change;
        let [m, n, g, l, a, w, e, c] = given;
        let walled = Walled { m, n, g, l, a, w, e, c, wall: Contact::Open };
        // The projection along the gradient is that of the derivatives of the start.
        let start = walled.make_consistent(&State::new([-0.8, -0.6], [0.0, 0.0])).unwrap().0;
        walled.motion(start).by(method()).with_contacts().to(2.4).unwrap()
    };
    let impacts = run(0, 0.0).transitions().len();
    assert!(impacts >= 2, "{impacts}");
    check::<_, _, 2>("a wall", &names, (method(), 1e-7), run);
}

/// A bead that slides off a sphere, falls on a plane without restitution, and slides on along it.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[contact(sphere: x^2 + y^2 - a^2 >= 0)]
#[contact(plane: y + h - s*x >= 0)]
struct Bead {
    m: f64,
    g: f64,
    a: f64,
    h: f64,
    s: f64,
    sphere: Contact,
    plane: Contact,
}

#[test]
fn a_bead_slides_off_a_sphere_and_along_a_plane() {
    let given = [9.81, 1.0, 1.2, 0.2];
    let run = |j: usize, change: f64| {
        let mut given = given;
        given[j] += change;
        let [g, a, h, s] = given;
        let bead = Bead { m: 1.0, g, a, h, s, sphere: Contact::Closed, plane: Contact::Open };
        let start = bead.make_consistent(&State::new([0.1, 0.995], [0.3, -0.03])).unwrap().0;
        bead.motion(start).by(method()).with_contacts().to(1.5).unwrap()
    };
    let path = run(0, 0.0);
    let [Transition::Opens { .. }, Transition::Impact { .. }, Transition::Closes { .. }] = path.transitions()
    else {
        panic!("{:?}", path.transitions())
    };
    check::<_, _, 2>("a bead", &["g", "a", "h", "s"], (method(), 1e-7), run);
}

/// Two blocks: the second one is pushed while it rests at a wall, and both push at the impact.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * x_dot^2 + n/2 * y_dot^2 - k/2 * (y - d)^2)]
#[contact(wall: y >= 0)]
#[contact(blocks: x - y - b >= 0, restitution: e)]
struct Blocks {
    m: f64,
    n: f64,
    k: f64,
    d: f64,
    b: f64,
    e: f64,
    wall: Contact,
    blocks: Contact,
}

#[test]
fn an_impact_is_passed_on_to_a_wall() {
    let given = [1.0, 2.0, 3.0, -0.5, 0.1, 0.6];
    let run = |j: usize, change: f64| {
        let mut given = given;
        given[j] += change;
        let [m, n, k, d, b, e] = given;
        let blocks = Blocks { m, n, k, d, b, e, wall: Contact::Closed, blocks: Contact::Open };
        blocks.motion(State::new([1.0, 0.0], [-1.0, 0.0])).by(method()).with_contacts().to(2.0).unwrap()
    };
    let path = run(0, 0.0);
    let [Transition::Impact { impulses, .. }] = path.transitions() else {
        panic!("{:?}", path.transitions())
    };
    assert_eq!(impulses.len(), 2);
    check::<_, _, 2>("blocks", &["m", "n", "k", "d", "b", "e"], (method(), 1e-8), run);
}

#[test]
fn what_has_no_derivative_is_named() {
    let ball = Ball { m: 1.0, g: 9.81, r: 0.0, e: 0.5, floor: Contact::Open };
    let of = |start, end| {
        let path = ball.motion(start).by(method()).with_contacts().to(end).unwrap();
        path.sensitivity(&["y", "e"], method()).unwrap_err()
    };
    let rests = of(State::at_rest([0.0, 1.0]), 5.0);
    assert!(matches!(rests, Error::NoDerivativeAcross { contact: "floor", .. }), "{rests}");
    assert!(rests.to_string().contains("`floor`") && rests.to_string().contains("accumulate"), "{rests}");
    let starts = of(State::new([0.0, 0.0], [0.0, -1.0]), 0.1);
    assert!(matches!(starts, Error::NoDerivativeAcross { contact: "floor", time: 0.0, .. }), "{starts}");

    // Two blocks that hit their walls at one time.
    let pair = Pair { left: Contact::Open, right: Contact::Open };
    let path = pair.motion(State::new([1.0, 1.0], [-1.0, -1.0])).with_contacts().to(2.0).unwrap();
    let both = path.sensitivity(&["x"], method()).unwrap_err();
    assert!(matches!(both, Error::NoDerivativeAcross { time, .. } if (time - 1.0).abs() < 1e-12), "{both}");
}

/// A plank on two supports at ±1, on which a weight falls at the place d.
#[derive(Clone, Lagrangian)]
#[coordinates(y, theta, z)]
#[lagrangian(y_dot^2/2 + theta_dot^2/6 + m*z_dot^2/2 - 9.81*(y + m*z))]
#[contact(left: y - theta >= 0)]
#[contact(right: y + theta >= 0)]
#[contact(weight: z - y - d*theta >= 0, restitution: 1/2)]
struct Plank {
    m: f64,
    d: f64,
    left: Contact,
    right: Contact,
    weight: Contact,
}

/// Between the supports both push, beside them one is lifted, and above one the other does neither, though its rate after the
/// impact may be round-off of the impulses.
#[test]
fn a_weight_that_falls_above_a_support_is_named() {
    for (d, is_named) in [(0.8, false), (1.0, true), (1.2, false)] {
        for height in [0.5, 0.6875, 0.71875, 0.875, 1.0] {
            let [left, right, weight] = [Contact::Closed, Contact::Closed, Contact::Open];
            let plank = Plank { m: 0.3, d, left, right, weight };
            let start = State::at_rest([0.0, 0.0, height]);
            let path = plank.motion(start).by(method()).with_contacts().to(0.5).unwrap();
            match path.sensitivity(&["d"], method()) {
                Ok(_) => assert!(!is_named, "{d}, {height}"),
                Err(error) => {
                    let is_left = matches!(error, Error::NoDerivativeAcross { contact: "left", .. });
                    assert!(is_named && is_left, "{error}");
                }
            }
        }
    }
}

/// A ball that is thrown up to a ceiling and just reaches it, at the speed v: the derivative grows like 1/v, down to heights that
/// are round-off.
#[test]
fn a_ball_that_just_reaches_a_ceiling() {
    let thrown = Thrown { g: 2.0, ceiling: Contact::Open };
    let mut counts = [0; 2];
    for k in 0..60 {
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
    assert!(counts.iter().all(|count| *count > 20), "{counts:?}");
}

/// A belt that moves away from a ball that follows.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(m/2 * y_dot^2)]
#[contact(belt: y - w*t >= 0, restitution: 1/2)]
struct Belt {
    m: f64,
    w: f64,
    belt: Contact,
}

/// At 10⁻⁹ of the speed of both.
#[test]
fn a_gap_that_closes_too_slowly_is_named() {
    let belt = Belt { m: 1.0, w: 1.0, belt: Contact::Open };
    for (slower, is_grazing) in [(1e-9, true), (1e-7, false)] {
        let start = State::new([slower], [1.0 - slower]);
        let path = belt.motion(start).by(method()).with_contacts().to(2.0).unwrap();
        assert!(matches!(path.transitions(), [Transition::Impact { .. }]), "{path:?}");
        match path.sensitivity(&["y", "w"], method()) {
            Err(error) => {
                assert!(is_grazing && matches!(error, Error::Grazing { event: "belt", .. }), "{error}");
            }
            // y⁺ = w t + (w − v)/2 (t − t₁) with t₁ = y₀/(w − v)
            Ok(end) => {
                assert!(!is_grazing);
                let expected = -0.5;
                assert!((end.q[(0, 0)] - expected).abs() < 1e-8, "{}", end.q[(0, 0)] - expected);
            }
        }
    }
}

/// Two blocks with a wall each.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[contact(left: x >= 0, restitution: 1)]
#[contact(right: y >= 0, restitution: 1)]
struct Pair {
    left: Contact,
    right: Contact,
}

/// A ball below a ceiling.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - g*y)]
#[contact(ceiling: -y >= 0, restitution: 1/2)]
struct Thrown {
    g: f64,
    ceiling: Contact,
}

/// A ball whose restitution swings in time.
#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - g*y)]
#[contact(floor: y >= 0, restitution: e + b*sin(w*t))]
struct Swinging {
    g: f64,
    e: f64,
    b: f64,
    w: f64,
    floor: Contact,
}

/// The law is differentiated at its own rate, and not at that of the time: from the first impact on, after a fall for 1 s with 2 m/s,
/// the velocity is 2 (e + b sin w t) − g (end − t).
#[test]
fn a_restitution_may_vary_faster_than_the_time() {
    for (w, start) in [(3.0, 0.0), (3.0, 50.0), (300.0, 0.0), (300.0, 50.0)] {
        let ball = Swinging { g: 2.0, e: 0.5, b: 0.2, w, floor: Contact::Open };
        let path = ball.motion(State { t: start, ..State::at_rest([1.0]) });
        let path = path.by(Dop853::with_tolerance(1e-13)).with_contacts().to(start + 1.2).unwrap();
        let along = path.sensitivity(&["e", "w", "y"], Dop853::with_tolerance(1e-13)).unwrap();
        let (t, phase) = (start + 1.0, w * (start + 1.0));
        // The fall takes √y, to a velocity of 2√y.
        let by_height = (0.5 + 0.2 * phase.sin()) + (0.2 * w * phase.cos() * 2.0 + 2.0) * 0.5;
        for (k, expected) in [2.0, 0.4 * t * phase.cos(), by_height].into_iter().enumerate() {
            let (found, size) = (along.v[(0, k)], 1.0 + expected.abs());
            assert!((found - expected).abs() < 1e-9 * size, "w = {w}, from {start}, {k}: {found} {expected}");
        }
    }
}
