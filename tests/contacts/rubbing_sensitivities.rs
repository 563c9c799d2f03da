//! Derivatives across friction, by closed forms: sticking, sliding, reversals.

use lagrange_core::contact::{Contact, Contacts, Transition};
use lagrange_core::linearized::{DifferentiableMethod, Linearized};
use lagrange_core::prelude::*;
use lagrange_systems::{Belt, Block, Sphere};

use crate::method;

/// Fails if a method has other derivatives of the first coordinate, by more than this.
fn has_derivatives<L>(path: &Trajectory<L>, names: &[&str], expected: &[f64], most: f64)
where
    L: Linearized<Scalar = f64> + Contacts + Clone,
    Dop853: DifferentiableMethod<L>,
    Taylor: DifferentiableMethod<L>,
    Radau<5>: DifferentiableMethod<L>,
{
    let radau = Radau::with_tolerance(1e-13).stages::<5>();
    let all = [
        path.sensitivity(names, method()).unwrap().q,
        path.sensitivity(names, Taylor::default()).unwrap().q,
        path.sensitivity(names, radau).unwrap().q,
    ];
    for (found, method) in all.iter().zip(["Dop853", "Taylor", "Radau"]) {
        for (j, expected) in expected.iter().enumerate() {
            let error = (found[(0, j)] - expected) / expected.abs().max(1.0);
            assert!(error.abs() < most, "by {method}, by {}: {error:e}", names[j]);
        }
    }
}

/// It rolls from t = 2 v₀/(7 μ g) on, so that x = 5/7 v₀ t + 2/49 v₀²/(μ g).
#[test]
fn a_thrown_sphere_has_the_derivatives_of_where_it_rolls() {
    let (g, r, mu, end) = (9.81, 0.3, 0.25, 1.0);
    let sphere = Sphere { m: 0.4, g, r, e: 0.0, mu, floor: Contact::Closed };
    let names = ["x_dot", "mu", "g", "r", "m"];
    for speed in [2.0, -2.0] {
        let motion = sphere.motion(State::new([0.0, r, 0.0], [speed, 0.0, 0.0]));
        let path = motion.by(method()).with_contacts().to(end).unwrap();
        let square = 2.0 / 49.0 * speed * speed.abs() / (mu * g);
        let expected = [5.0 / 7.0 * end + 2.0 * square / speed, -square / mu, -square / g, 0.0, 0.0];
        has_derivatives(&path, &names, &expected, 1e-11);
        let v = path.sensitivity(&names, method()).unwrap().v;
        assert!((v[(0, 0)] - 5.0 / 7.0).abs() < 1e-12, "{v}");
    }
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
    let block = Belt { m, k, speed, hold, pull, ..Belt::default() };
    // While it sticks at first, slides, sticks again, and after some cycles.
    for (end, transitions) in [(2.0, 0), (3.0, 1), (5.5, 2), (20.0, 7)] {
        let path = block.motion(State::new([0.0], [speed])).by(method()).with_contacts().to(end).unwrap();
        assert!(path.transitions().len() >= transitions, "{:?}", path.transitions());
        let by = |j: usize| {
            let at = |part: f64| {
                let mut moved = given;
                moved[j] += part * 1e-4;
                place(moved, end)
            };
            (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / 12e-4
        };
        let mut expected = [0, 1, 2, 3, 4].map(by);
        // The velocity of the start is a number of its own.
        if transitions == 0 {
            expected[2] = end;
        }
        has_derivatives(&path, &names, &expected, 1e-9);
    }
}

/// Thrown up, it slides by x₁ = v²/(2 g (s + μ)) in the time t₁ = v/(g (s + μ)), and back with the acceleration g (s − μ).
#[test]
fn a_block_that_slides_back_has_the_derivatives_of_both_ways() {
    let (g, s, mu, v, end) = (9.81, 0.6, 0.25, 2.0, 0.8);
    let block = Block { m: 1.0, g, s, mu, floor: Contact::Closed, ..Block::default() };
    let names = ["x_dot", "g", "s", "mu", "m"];
    let path = block.motion(State::new([0.0; 2], [v, 0.0])).by(method()).with_contacts().to(end).unwrap();
    let (up, down) = (g * (s + mu), g * (s - mu));
    let [Transition::Reverses { friction: "floor_friction", time }] = path.transitions() else {
        panic!("{:?}", path.transitions())
    };
    assert!((time - v / up).abs() < 1e-13, "{time}");
    assert!(path.to_string().contains("\n1 reversal; closed at the end: `floor`\n"), "{path}");
    let tau = end - v / up;
    assert!((path.end().state().q[0] - (v * v / (2.0 * up) - down * tau * tau / 2.0)).abs() < 1e-12);
    let by = |dv: f64, dup: f64, ddown: f64| {
        let dtau = -dv / up + v / (up * up) * dup;
        v / up * dv - v * v / (2.0 * up * up) * dup - ddown * tau * tau / 2.0 - down * tau * dtau
    };
    let expected = [by(1.0, 0.0, 0.0), by(0.0, s + mu, s - mu), by(0.0, g, g), by(0.0, g, -g), 0.0];
    let largest = expected.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
    has_derivatives(&path, &names, &expected, 1e-11 / largest);
}

/// From rest it slides down, by −g (s − μ) t²/2: what changes its velocity there has one derivative for each direction.
#[test]
fn a_block_that_begins_to_slide_has_no_derivative_by_its_velocity() {
    let (g, s, mu) = (9.81, 0.6, 0.25);
    let block = Block { m: 1.0, g, s, mu, floor: Contact::Closed, ..Block::default() };
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
        let block = Block { m: 1.0, g: 9.81, s: 0.6, mu, floor: Contact::Closed, ..Block::default() };
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
