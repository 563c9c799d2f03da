//! Derivatives across friction: sticking, sliding, reversals and impacts, by closed forms and by differences of whole motions.

use lagrange_core::Scalar;
use lagrange_core::contact::{Contact, ContactTrajectory, Friction, Transition};
use lagrange_core::prelude::*;
use lagrange_random::cases;

use crate::sensitivities::{check, method};

/// A sphere thrown on a floor.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + m*r^2/5 * phi_dot^2 - m*g*y)]
#[contact(floor: y - r >= 0, friction(mu): x_dot - r*phi_dot)]
struct Sphere<T> {
    m: T,
    g: T,
    r: T,
    mu: T,
    floor: Contact,
}

/// It rolls from t = 2 v₀/(7 μ g) on, so that x = 5/7 v₀ t + 2/49 v₀²/(μ g).
#[test]
fn a_thrown_sphere_has_the_derivatives_of_where_it_rolls() {
    let (g, r, mu, end) = (9.81, 0.3, 0.25, 1.0);
    let sphere = Sphere { m: 0.4, g, r, mu, floor: Contact::Closed };
    let names = ["x_dot", "mu", "g", "r", "m"];
    for speed in [2.0, -2.0] {
        let motion = || sphere.motion(State::new([0.0, r, 0.0], [speed, 0.0, 0.0]));
        let all = [
            motion().by(method()).with_contacts().to(end).unwrap().sensitivity(&names, method()).unwrap(),
            motion().with_contacts().to(end).unwrap().sensitivity(&names, Taylor::default()).unwrap(),
            motion().with_contacts().to(end).unwrap().sensitivity(&names, radau()).unwrap(),
        ];
        let square = 2.0 / 49.0 * speed * speed.abs() / (mu * g);
        let expected = [5.0 / 7.0 * end + 2.0 * square / speed, -square / mu, -square / g, 0.0, 0.0];
        for (found, method) in all.iter().zip(["Dop853", "Taylor", "Radau"]) {
            for (j, expected) in expected.iter().enumerate() {
                let error = found.q[(0, j)] - expected;
                assert!(error.abs() < 1e-11, "by {method}, by {}: {error:e}", names[j]);
            }
            assert!((found.v[(0, 0)] - 5.0 / 7.0).abs() < 1e-12, "{found:?}");
        }
    }
}

fn radau() -> Radau<5> {
    Radau::with_tolerance(1e-13).stages::<5>()
}

/// A block on a belt, held by a spring: from the limit on it slides with less.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[friction(belt: x_dot - speed, limit: hold, sliding: pull)]
struct Belt<T> {
    m: T,
    k: T,
    speed: T,
    hold: T,
    pull: T,
    belt: Friction,
}

/// It sticks until k x = hold, slides about pull/k from the distance a = (hold − pull)/k and the speed v of the belt, and sticks
/// again at the mirrored place.
#[test]
fn a_block_on_a_belt_has_the_derivatives_of_its_cycle() {
    let given = [1.3, 4.0, 0.2, 2.0, 1.0];
    let names = ["m", "k", "speed", "hold", "pull"];
    let place = |[m, k, v, hold, pull]: [f64; 5], t: f64| {
        let (omega, a) = ((k / m).sqrt(), (hold - pull) / k);
        let slides = (std::f64::consts::PI + 2.0 * (v / omega / a).atan()) / omega;
        let sticks = 2.0 * a / v;
        let tau = t - hold / k / v;
        let tau = tau - (tau / (slides + sticks)).floor() * (slides + sticks);
        match tau < slides {
            true => pull / k + a * (omega * tau).cos() + v / omega * (omega * tau).sin(),
            false => pull / k - a + v * (tau - slides),
        }
    };
    let [m, k, speed, hold, pull] = given;
    let block = Belt { m, k, speed, hold, pull, belt: Friction::Sticks };
    // While it sticks at first, slides, sticks again, and after some cycles.
    for (end, transitions) in [(2.0, 0), (3.0, 1), (5.5, 2), (20.0, 7)] {
        let motion = || block.motion(State::new([0.0], [speed])).by(method()).with_contacts();
        let path = motion().to(end).unwrap();
        assert!(path.transitions().len() >= transitions, "{:?}", path.transitions());
        let all = [
            path.sensitivity(&names, method()).unwrap(),
            path.sensitivity(&names, Taylor::default()).unwrap(),
            path.sensitivity(&names, radau()).unwrap(),
        ];
        for j in 0..names.len() {
            let at = |part: f64| {
                let mut moved = given;
                moved[j] += part * 1e-4;
                place(moved, end)
            };
            let mut expected = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / 12e-4;
            // The velocity of the start is a number of its own.
            if names[j] == "speed" && transitions == 0 {
                expected = end;
            }
            for (found, method) in all.iter().zip(["Dop853", "Taylor", "Radau"]) {
                let error = (found.q[(0, j)] - expected) / expected.abs().max(1.0);
                assert!(error.abs() < 1e-9, "{end}, by {method}, by {}: {error:e}", names[j]);
            }
        }
    }
}

/// A number from −1 to 1, by a linear congruence.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Kinds of transitions, with what they are of.
fn kinds<L: Lagrangian>(path: &ContactTrajectory<L>) -> Vec<String> {
    let kind = |transition: &Transition<L::Scalar>| match transition {
        Transition::Impact { impulses, .. } => {
            format!("impact {:?}", impulses.iter().map(|(name, _)| *name).collect::<Vec<_>>())
        }
        Transition::Rests { contact, .. } => format!("rests {contact}"),
        Transition::Closes { contact, .. } => format!("closes {contact}"),
        Transition::Opens { contact, .. } => format!("opens {contact}"),
        Transition::Sticks { friction, .. } => format!("sticks {friction}"),
        Transition::Slips { friction, .. } => format!("slips {friction}"),
        Transition::Reverses { friction, .. } => format!("reverses {friction}"),
    };
    path.transitions().iter().map(kind).collect()
}

/// Two blocks on a plate that swings, one pressed on by the other's spring and one with dry friction between both.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + z_dot^2) + n/2 * y_dot^2 - k/2 * (x - y)^2 - c*x^4/4 - m*g*z + b*x*z)]
#[dissipation(d/2 * (x_dot - y_dot)^2)]
#[contact(plate: z >= 0, friction(mu + nu*x): x_dot - a*omega*cos(omega*t))]
#[friction(brake: y_dot - x_dot/3, limit: hold + q*y^2, sliding: pull)]
struct Shaken {
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
    for case in 0..cases([3, 9, 100]) {
        let mut seed = 1 + case as u64;
        let base = [1.0, 1.5, 6.0, 0.5, 9.81, 0.5, 0.1, 0.15, 0.02, 0.08, 5.0, 0.6, 0.1, 0.25];
        let given = base.map(|x| x * (1.0 + 0.3 * random(&mut seed)));
        let start = [0.2, 0.2, 0.3, 0.6].map(|size| size * random(&mut seed));
        let end = 1.5 + 0.5 * random(&mut seed);
        let run = |j: usize, change: f64| {
            let mut given = given;
            given[j] += change;
            let [m, n, k, c, g, b, d, mu, nu, a, omega, hold, q, pull] = given;
            let (plate, brake) = (Contact::Closed, Friction::Sticks);
            let system = Shaken { m, n, k, c, g, b, d, mu, nu, a, omega, hold, q, pull, plate, brake };
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

/// A rod with two ends that may hit the floor.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) + i/2 * theta_dot^2 - m*g*y)]
#[contact(left: y - l*sin(theta) >= 0, restitution: e, friction(mu): x_dot + l*sin(theta)*theta_dot)]
#[contact(right: y + l*sin(theta) >= 0, restitution: e, friction(nu): x_dot - l*sin(theta)*theta_dot)]
struct Rod {
    m: f64,
    i: f64,
    g: f64,
    l: f64,
    e: f64,
    mu: f64,
    nu: f64,
    left: Contact,
    right: Contact,
}

/// Rods whose impacts stick and slide, with restitution and without.
#[test]
fn random_rods_that_fall_agree_with_differences() {
    let names = ["m", "i", "g", "l", "mu", "nu", "e"];
    let (mut all, mut refused) = (Vec::new(), Vec::new());
    for case in 0..cases([6, 16, 100]) {
        let mut seed = 1000 + case as u64;
        let base = [1.0, 0.1, 9.81, 0.5, 0.4, 0.3, 0.5];
        let mut given = base.map(|x| x * (1.0 + 0.5 * random(&mut seed)));
        // Without restitution, they slide and stick on an end.
        let is_plastic = case % 2 == 0;
        given[6] *= f64::from(!is_plastic);
        let names = &names[..names.len() - usize::from(is_plastic)];
        let [x, y, angle] = [0.0, 1.0, 0.6].map(|size| size * random(&mut seed));
        let velocities = [1.0, 0.5, 3.0].map(|size| size * random(&mut seed));
        let start = State::new([x, 1.2 + 0.3 * y, angle], velocities);
        let end = 0.6 + 0.2 * random(&mut seed);
        let run = |j: usize, change: f64| {
            let mut given = given;
            given[j] += change;
            let [m, i, g, l, mu, nu, e] = given;
            let rod = Rod { m, i, g, l, e, mu, nu, left: Contact::Open, right: Contact::Open };
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

/// A block on an incline.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*(y + s*x))]
#[contact(floor: y >= 0, friction(mu): x_dot)]
struct Incline<T> {
    m: T,
    g: T,
    s: T,
    mu: T,
    floor: Contact,
}

/// Thrown up, it slides by x₁ = v²/(2 g (s + μ)) in the time t₁ = v/(g (s + μ)), and back with the acceleration g (s − μ).
#[test]
fn a_block_that_slides_back_has_the_derivatives_of_both_ways() {
    let (g, s, mu, v, end) = (9.81, 0.6, 0.25, 2.0, 0.8);
    let block = Incline { m: 1.0, g, s, mu, floor: Contact::Closed };
    let names = ["x_dot", "g", "s", "mu", "m"];
    let path = block.motion(State::new([0.0; 2], [v, 0.0])).by(method()).with_contacts().to(end).unwrap();
    let all = [
        path.sensitivity(&names, method()).unwrap(),
        path.sensitivity(&names, Taylor::default()).unwrap(),
        path.sensitivity(&names, radau()).unwrap(),
    ];
    let (up, down) = (g * (s + mu), g * (s - mu));
    let [Transition::Reverses { friction: "floor_friction", time }] = path.transitions() else {
        panic!("{:?}", path.transitions())
    };
    assert!((time - v / up).abs() < 1e-13, "{time}");
    assert!(path.to_string().contains("0 slips, 1 reversal\n"), "{path}");
    let tau = end - v / up;
    assert!((path.end().q[0] - (v * v / (2.0 * up) - down * tau * tau / 2.0)).abs() < 1e-12);
    let by = |dv: f64, dup: f64, ddown: f64| {
        let dtau = -dv / up + v / (up * up) * dup;
        v / up * dv - v * v / (2.0 * up * up) * dup - ddown * tau * tau / 2.0 - down * tau * dtau
    };
    let expected = [by(1.0, 0.0, 0.0), by(0.0, s + mu, s - mu), by(0.0, g, g), by(0.0, g, -g), 0.0];
    for (found, method) in all.iter().zip(["Dop853", "Taylor", "Radau"]) {
        for (j, expected) in expected.into_iter().enumerate() {
            let error = found.q[(0, j)] - expected;
            assert!(error.abs() < 1e-11, "by {method}, by {}: {error:e}", names[j]);
        }
    }
}

/// From rest it slides down, by −g (s − μ) t²/2: what changes its velocity there has one derivative for each direction.
#[test]
fn a_block_that_begins_to_slide_has_no_derivative_by_its_velocity() {
    let (g, s, mu) = (9.81, 0.6, 0.25);
    let block = Incline { m: 1.0, g, s, mu, floor: Contact::Closed };
    let path = block.motion(State::at_rest([0.0; 2])).with_contacts().to(1.0).unwrap();
    let found = path.sensitivity(&["s", "mu"], method()).unwrap();
    assert!(
        (found.q[(0, 0)] + g / 2.0).abs() < 1e-11 && (found.q[(0, 1)] - g / 2.0).abs() < 1e-11,
        "{found:?}"
    );
    let error = path.sensitivity(&["x_dot"], method()).unwrap_err();
    assert!(
        matches!(error, Error::NoDerivativeAcross { contact: "floor_friction", time: 0.0, .. }),
        "{error}"
    );
    assert!(error.to_string().contains("from rest"), "{error}");
}

/// Thrown up with s = μ, it stops with its force at the limit: it stays for a larger μ, and slides back for a smaller one.
#[test]
fn a_block_that_stops_at_the_limit_is_named() {
    for (mu, is_decided) in [(0.6, false), (0.6 + 1e-6, true), (0.6 - 1e-6, true)] {
        let block = Incline { m: 1.0, g: 9.81, s: 0.6, mu, floor: Contact::Closed };
        let path = block.motion(State::new([0.0; 2], [2.0, 0.0])).with_contacts().to(1.0).unwrap();
        match path.sensitivity(&["mu"], method()) {
            Ok(_) => assert!(is_decided),
            Err(error) => {
                assert!(!is_decided && error.to_string().contains("at the limit"), "{mu}: {error}");
                assert!(
                    matches!(error, Error::NoDerivativeAcross { contact: "floor_friction", .. }),
                    "{error}"
                );
            }
        }
    }
}

/// A puck on a floor, drawn along it in two directions.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z - k/2 * (x - a)^2 - c/2 * (y - b*t)^2)]
#[contact(floor: z >= 0, friction(mu): [x_dot, y_dot])]
struct Puck {
    m: f64,
    g: f64,
    k: f64,
    c: f64,
    a: f64,
    b: f64,
    mu: f64,
    floor: Contact,
}

#[test]
fn a_puck_that_slides_in_the_plane_agrees_with_differences() {
    let names = ["m", "g", "k", "c", "a", "b", "mu"];
    let given = [1.0, 9.81, 4.0, 3.0, 1.0, 0.5, 0.2];
    let puck = |given: [f64; 7]| {
        let [m, g, k, c, a, b, mu] = given;
        Puck { m, g, k, c, a, b, mu, floor: Contact::Closed }
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
    // Pulled by a spring that is drawn away.
    let drawn =
        puck(given).motion(State::at_rest([0.9, 0.0, 0.0])).by(radau()).with_contacts().to(2.0).unwrap();
    let slips = drawn.sensitivity(&names, radau()).unwrap_err();
    let pulled =
        puck(given).motion(State::at_rest([3.0, 0.0, 0.0])).by(radau()).with_contacts().to(0.1).unwrap();
    let begins = pulled.sensitivity(&names, radau()).unwrap_err();
    for (error, path) in [(stops, &path), (slips, &drawn), (begins, &pulled)] {
        let at = path.transitions().first().map_or(0.0, Transition::time);
        let is_named = matches!(error, Error::NoDerivativeAcross { contact: "floor_friction[0]", time, .. } if time == at);
        assert!(is_named && error.to_string().contains("two velocities"), "{error}");
    }
}
