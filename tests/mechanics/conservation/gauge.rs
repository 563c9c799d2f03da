//! L and L + d/dt f(q, t) have the same motion, and the added term is found.

use approx::assert_relative_eq;
use lagrange_core::facts::{EnergyForm, Facts, LinearPart};
use lagrange_core::{nalgebra::Const, prelude::*};
use lagrange_random::Random;
use lagrange_systems::random_state;

macro_rules! pendulum {
    ($name:ident $(, $added:expr)?) => {
        #[derive(Lagrangian)]
        #[coordinates(x, y)]
        #[define(l_0 = m/2 * (x_dot^2 + (1 + x^2) * y_dot^2) - m*g*x*cos(y) + b*x*y_dot*sin(t))]
        #[lagrangian(l_0 $(+ $added)?)]
        struct $name {
            m: f64,
            g: f64,
            b: f64,
        }
    };
}

pendulum!(Plain);
pendulum!(Transcendental, der(exp(x * t) * sin(y) + atan2(y, 2 + cos(x))));
pendulum!(
    WrittenOut,
    m * (3 * x ^ 2 * y * x_dot + x ^ 3 * y_dot) / (1 + t ^ 2) - 2 * m * t * x ^ 3 * y / (1 + t ^ 2) ^ 2
);

fn totals(facts: Facts) -> Vec<&'static str> {
    facts.total_derivatives.iter().map(|total| total.terms).collect()
}

fn check<L: Lagrangian<N = Const<2>, M = Const<0>, Scalar = f64>>(gauged: &L, terms: &str) {
    let (plain, random) = (Plain { m: 1.3, g: 9.81, b: 0.7 }, &mut Random(3));
    let mut differs = false;
    for _ in 0..20 {
        let state = random_state(random);
        let expected = plain.solve(&state).expect("a regular state").accelerations;
        let found = gauged.solve(&state).expect("a regular state").accelerations;
        for (found, expected) in found.iter().zip(&expected) {
            assert_relative_eq!(found, expected, epsilon = 1e-13, max_relative = 1e-13);
        }
        differs |= (plain.momentum(&state) - gauged.momentum(&state)).norm() > 0.1;
    }
    assert!(differs, "the added term changes the momenta");
    assert_eq!(totals(L::FACTS), [terms]);
}

#[test]
fn a_total_derivative_changes_no_acceleration_and_is_found() {
    assert!(totals(Plain::FACTS).is_empty());
    assert!(!Plain::equations().text().contains("Total time derivatives"));
    let terms = "d/dt (exp(x t) sin y + atan2(y, 2 + cos x))";
    check(&Transcendental { m: 1.3, g: 9.81, b: 0.7 }, terms);
    let terms = "m (3 x² y ẋ + x³ ẏ)/(1 + t²) − 2 m t x³ y/(1 + t²)²";
    check(&WrittenOut { m: 1.3, g: 9.81, b: 0.7 }, terms);
    assert!(WrittenOut::equations().text().contains("Total time derivatives in the Lagrangian"));
}

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(
    m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z
    + a*y*x_dot + b*z*x_dot + a*x*y_dot + c*z_dot - g*t*z_dot - g*z + c
)]
struct InPieces {
    m: f64,
    g: f64,
    a: f64,
    b: f64,
    c: f64,
}

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) + y*z*x_dot + z*x*y_dot + x*y*z_dot)]
struct InThree {
    m: f64,
}

#[test]
fn terms_that_are_total_derivatives_together() {
    assert_eq!(totals(InPieces::FACTS), ["a y ẋ + a x ẏ", "c ż", "−g t ż − g z", "c"]);
    assert_eq!(InPieces::FACTS.linear_part, LinearPart::Open, "b z ẋ");
    assert_eq!(totals(InThree::FACTS), ["y z ẋ + z x ẏ + x y ż"]);
    assert!(matches!(InThree::FACTS.linear_part, LinearPart::Closed(_)));
}

/// Milton (8.36) and (8.40): with a prescribed velocity of the frame, m v·V(t) is no total derivative, but
/// closed: it adds no force that depends on the velocity.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(V(t): [3] = velocity)]
#[define(v = r_dot)]
#[lagrangian(m/2 * dot(v, v) + m * dot(v, V(t)) + m/2 * dot(V(t), V(t)))]
struct MovingFrame {
    m: f64,
    velocity: Ramp,
}

struct Ramp;

impl Function<1, 3> for Ramp {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 3] {
        [t, t * t, t * t * t]
    }
}

#[test]
fn moving_frame_8_36() {
    assert_eq!(totals(MovingFrame::FACTS).len(), 1, "m/2 V(t)²");
    assert!(matches!(MovingFrame::FACTS.linear_part, LinearPart::Closed(_)));
    assert_eq!(MovingFrame::FACTS.energy_form, EnergyForm::Quadratic);
    let frame = MovingFrame { m: 2.0, velocity: Ramp };
    let solution = frame.solve(&State::new([0.0; 3], [0.1; 3]).at_time(0.5)).unwrap();
    assert_relative_eq!(solution.accelerations[2], -3.0 * 0.25, max_relative = 1e-14);
}
