//! Derivatives across contacts and friction, by differences of whole motions.

use lagrange_core::contact::{Contact, Contacts, Friction, Transition};
use lagrange_core::linearized::{DifferentiableMethod, Linearized, StateSensitivity};
use lagrange_core::nalgebra::Const;
use lagrange_core::prelude::*;
use lagrange_random::cases;
use lagrange_systems::{Puck, Rod, Shaken, Stack, Walled};

use crate::{Congruence, kinds, method};

/// Derivatives of whole motions, by central differences with two steps.
fn check<L, D, const N: usize>(
    what: &str,
    names: &[&str],
    (method, tolerance): (D, f64),
    run: impl Fn(usize, f64) -> Trajectory<L>,
) where
    L: Linearized<N = Const<N>, Scalar = f64> + Contacts + Clone,
    D: DifferentiableMethod<L>,
{
    let path = run(0, 0.0);
    let found: StateSensitivity<f64, Const<N>> = path.sensitivity(names, method).unwrap();
    for (j, name) in names.iter().enumerate() {
        let error = [1e-4, 1e-5].map(|h| {
            let values = [-2.0, -1.0, 1.0, 2.0].map(|part| *run(j, part * h).end().state());
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

#[test]
fn a_pendulum_bounces_off_a_curved_wall_that_moves() {
    let given = [1.1, 0.3, 9.81, 1.0, 0.12, 0.2, 0.05, 3.0, 0.9, 0.2];
    let names = ["m", "n", "g", "l", "a", "b", "d", "w", "e", "c"];
    let run = |k: usize, change: f64| {
        let mut given = given;
        given[k] += change;
        let [m, n, g, l, a, b, d, w, e, c] = given;
        let walled = Walled { m, n, g, l, a, b, d, w, e, c, wall: Contact::Open };
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

/// Two blocks on a plate that swings, one pressed on by the other's spring and one with dry friction between both.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + z_dot^2) + n/2 * y_dot^2 - k/2 * (x - y)^2 - c*x^4/4 - m*g*z + b*x*z)]
#[dissipation(d/2 * (x_dot - y_dot)^2)]
#[contact(plate: z >= 0, friction(mu + nu*x): x_dot - a*omega*cos(omega*t))]
#[friction(brake: y_dot - x_dot/3, limit: hold + q*y^2, sliding: pull)]
struct Brake {
    m: f64,
    n: f64,
    k: f64,
    c: f64,
    g: f64,
    b: f64,
    d: f64,
    mu: f64,
    nu: f64,
    a: f64,
    omega: f64,
    hold: f64,
    q: f64,
    pull: f64,
    plate: Contact,
    brake: Friction,
}

/// With seeds, from which some motions stick and slip and others reverse.
#[test]
fn random_blocks_that_stick_and_slip_agree_with_differences() {
    let names = ["m", "n", "k", "c", "g", "b", "d", "mu", "nu", "a", "omega", "hold", "q", "pull"];
    let mut all = Vec::new();
    for case in 0..cases([9, 9, 100]) {
        let mut random = Congruence(1 + case as u64);
        let mut random = || random.between(-1.0, 1.0);
        let base = [1.0, 1.5, 6.0, 0.5, 9.81, 0.5, 0.1, 0.15, 0.02, 0.08, 5.0, 0.6, 0.1, 0.25];
        let given = base.map(|x| x * (1.0 + 0.3 * random()));
        let start = [0.2, 0.2, 0.3, 0.6].map(|size| size * random());
        let end = 1.5 + 0.5 * random();
        let run = |j: usize, change: f64| {
            let mut given = given;
            given[j] += change;
            let [m, n, k, c, g, b, d, mu, nu, a, omega, hold, q, pull] = given;
            let (plate, brake) = (Contact::Closed, Friction::Sticks);
            let system = Brake { m, n, k, c, g, b, d, mu, nu, a, omega, hold, q, pull, plate, brake };
            let [x, y, v, u] = start;
            system.motion(State::new([x, y, 0.0], [v, u, 0.0])).by(method()).with_contacts().to(end).unwrap()
        };
        all.extend(kinds(&run(0, 0.0)));
        check::<_, _, 3>(&format!("case {case}"), &names, (method(), 1e-6), run);
    }
    for kind in ["sticks plate_friction", "slips plate_friction", "sticks brake", "slips brake"] {
        assert!(all.iter().filter(|of| *of == kind).count() >= 2, "{kind}: {all:?}");
    }
}

/// Rods whose impacts stick and slide, with restitution and without.
#[test]
fn random_rods_that_fall_agree_with_differences() {
    let names = ["m", "j", "g", "a", "mu[0]", "mu[1]", "e"];
    let (mut all, mut refused) = (Vec::new(), Vec::new());
    for case in 0..cases([6, 16, 100]) {
        let mut random = Congruence(1000 + case as u64);
        let mut random = || random.between(-1.0, 1.0);
        let base = [1.0, 0.1, 9.81, 0.5, 0.4, 0.3, 0.5];
        let mut given = base.map(|x| x * (1.0 + 0.5 * random()));
        // Without restitution, they slide and stick on an end.
        let is_plastic = case % 2 == 0;
        given[6] *= f64::from(!is_plastic);
        let names = &names[..names.len() - usize::from(is_plastic)];
        let [x, y, angle] = [0.0, 1.0, 0.6].map(|size| size * random());
        let velocities = [1.0, 0.5, 3.0].map(|size| size * random());
        let start = State::new([x, 1.2 + 0.3 * y, angle], velocities);
        let end = 0.6 + 0.2 * random();
        let run = |j: usize, change: f64| {
            let mut given = given;
            given[j] += change;
            let [m, j, g, a, mu, nu, e] = given;
            let rod = Rod { m, j, g, a, e, mu: [mu, nu], left: -9.0, ..Rod::default() };
            rod.motion(start).by(method()).with_contacts().to(end).unwrap()
        };
        let path = run(0, 0.0);
        match path.sensitivity(names, method()) {
            Err(error) => refused.push(error.to_string()),
            Ok(_) => {
                all.extend(kinds(&path));
                check::<_, _, 3>(&format!("case {case}"), names, (method(), 1e-6), run);
            }
        }
    }
    assert!(refused.len() < all.len() / 4, "{refused:?}, {all:?}");
}

/// Drawn along the floor in two directions.
#[test]
fn a_puck_that_slides_in_the_plane_agrees_with_differences() {
    let names = ["m", "g", "k", "c", "a", "b", "mu"];
    let given = [1.0, 9.81, 4.0, 3.0, 1.0, 0.5, 0.2];
    let puck = |given: [f64; 7]| {
        let [m, g, k, c, a, b, mu] = given;
        Puck { m, g, k, c, a, b, mu, floor: Contact::Closed, ..Puck::default() }
    };
    let run = |start, end: f64| {
        move |j: usize, change: f64| {
            let mut given = given;
            given[j] += change;
            puck(given).motion(start).by(method()).with_contacts().to(end).unwrap()
        }
    };
    let thrown = State::new([0.0; 3], [0.8, -1.0, 0.0]);
    check::<_, _, 3>("a puck that is thrown", &names, (method(), 1e-7), run(thrown, 0.5));
    let mut still = given;
    still[5] = 0.0;
    let path = puck(still).motion(thrown).by(method()).with_contacts().to(3.0).unwrap();
    let stops = path.sensitivity(&names, method()).unwrap_err();
    let radau = Radau::with_tolerance(1e-13).stages::<5>();
    let pulled = |x: f64, end: f64| {
        puck(given).motion(State::at_rest([x, 0.0, 0.0])).by(radau).with_contacts().to(end).unwrap()
    };
    // Pulled by a spring that is drawn away.
    let (drawn, begun) = (pulled(0.9, 2.0), pulled(3.0, 0.1));
    let slips = drawn.sensitivity(&names, radau).unwrap_err();
    let begins = begun.sensitivity(&names, radau).unwrap_err();
    for (error, path) in [(stops, &path), (slips, &drawn), (begins, &begun)] {
        let at = path.transitions().first().map_or(0.0, Transition::time);
        let is_named = matches!(error, Error::NoDerivativeAcross { contact: "floor_friction[0]", time, .. } if time == at);
        assert!(is_named && error.to_string().contains("two velocities"), "{error}");
    }
}

#[test]
fn impacts_at_one_time_are_named() {
    // One body hits the floor, and the others one another, at one time.
    let pair = Stack { m: [1.0; 3], e: [1.0; 3], ..Stack::default() };
    let path = pair.motion(State::new([1.0, 2.0, 3.0], [-1.0, 0.0, -1.0])).with_contacts().to(1.5).unwrap();
    let both = path.sensitivity(&["y[0]"], method()).unwrap_err();
    assert!(matches!(both, Error::NoDerivativeAcross { time, .. } if (time - 1.0).abs() < 1e-12), "{both}");
}

/// The law is differentiated at its own rate, and not at that of the time: from the first impact on, after a fall for 1 s with 2 m/s,
/// the velocity is 2 (e + c sin w t) − g (end − t).
#[test]
fn a_restitution_may_vary_faster_than_the_time() {
    for (w, start) in [(3.0, 0.0), (3.0, 50.0), (300.0, 0.0), (300.0, 50.0)] {
        let ball = Shaken { m: 1.0, g: 2.0, e: 0.5, c: 0.2, w, ..Shaken::default() };
        let path = ball.motion(State { t: start, ..State::at_rest([1.0]) });
        let path = path.by(method()).with_contacts().to(start + 1.2).unwrap();
        let along = path.sensitivity(&["e", "w", "y"], method()).unwrap();
        let (t, phase) = (start + 1.0, w * (start + 1.0));
        // The fall takes √y, to a velocity of 2√y.
        let by_height = (0.5 + 0.2 * phase.sin()) + (0.2 * w * phase.cos() * 2.0 + 2.0) * 0.5;
        for (k, expected) in [2.0, 0.4 * t * phase.cos(), by_height].into_iter().enumerate() {
            let (found, size) = (along.v[(0, k)], 1.0 + expected.abs());
            assert!((found - expected).abs() < 1e-9 * size, "w = {w}, from {start}, {k}: {found} {expected}");
        }
    }
}
