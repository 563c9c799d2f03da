//! Constraints that can be integrated: what the type says of them, and that their integrals are constant along motions. Which
//! constraints can be is tested with the derive (`pipeline_tests/integrability.rs`).

use approx::assert_relative_eq;
use lagrange_core::facts::{Classification, Evidence, Extent, Integrability, Integrals};
use lagrange_core::{ConstraintKind, prelude::*};

const fn proved(integrability: Integrability) -> Classification {
    Classification { integrability, evidence: Evidence::Proved }
}

/// Milton (8.4)–(8.5).
#[derive(Lagrangian)]
#[coordinates(X, phi)]
#[lagrangian(m/2 * X_dot^2 + m*a^2/4 * phi_dot^2 + m*g*X)]
#[constraint(no_slip: X_dot - a*phi_dot = 0)]
struct Cylinder {
    m: f64,
    a: f64,
    g: f64,
}

#[test]
fn cylinder_8_5() {
    // A constant of the type: known to the compiler.
    const CLASSES: &[Classification] = Cylinder::CONSTRAINT_CLASSES;
    const INTEGRALS: Option<Integrals> = Cylinder::INTEGRALS;
    assert_eq!(CLASSES, [proved(Integrability::Exact)]);
    assert_eq!(INTEGRALS, Some(Integrals { count: 1, of: 1, evidence: Evidence::Proved }));
    assert_eq!(INTEGRALS.map(Integrals::extent), Some(Extent::All));
    assert_eq!(Cylinder::CONSTRAINT_KINDS, [ConstraintKind::Velocity], "it is enforced as it is written");
    let text = Cylinder::equations().text();
    assert!(text.contains("no_slip: Ẋ − a φ̇ = 0   (integrable: X − a φ is constant)"), "{text}");
    let cylinder = Cylinder { m: 1.0, a: 0.2, g: 9.81 };
    let state = State::new([3.0, 5.0], [0.4, 2.0]);
    assert_eq!(cylinder.constraint_integral(0, &state), Some(2.0));
    assert_eq!(cylinder.constraint_integral(1, &state), None);
}

/// A ball on a turntable, Milton (8.4).
#[derive(Lagrangian)]
#[coordinates(r: [2], q: [4])]
#[define(omega = quat_rate(q, q_dot))]
#[lagrangian(m/2*dot(r_dot, r_dot) + m*a^2/5*dot(omega, omega))]
#[constraint(unit: dot(q, q) = 1)]
#[constraint(rolling: r_dot = [a*omega[1] - w*r[1], w*r[0] - a*omega[0]])]
struct Turntable {
    m: f64,
    a: f64,
    w: f64,
}

/// Where |q| = 1 points are computed: a verdict of points.
#[test]
fn sphere_8_4() {
    let said = [Turntable::CONSTRAINT_CLASSES, &[Classification::UNDECIDED]].concat();
    assert_eq!(
        said.iter().map(Classification::to_string).collect::<Vec<_>>(),
        [
            "holonomic (proved)",
            "nonholonomic (as far as 8 random points show)",
            "nonholonomic (as far as 8 random points show)",
            "whether it can be integrated is not decided (no random point was found at which it could be judged)",
        ]
    );
    let integrals = Turntable::INTEGRALS.expect("a decision");
    assert_eq!((integrals.count, integrals.of, integrals.extent()), (0, 2, Extent::None));
    assert!(Turntable::equations().text().contains("(nonholonomic"), "{}", Turntable::equations());
}

/// Integrable, exactly and with a factor, along time too; a supplied function comes in by its rate.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2) + m*sin(t)*(x + z))]
#[constraint(ray: x*y_dot - y*x_dot = 0)]
#[constraint(driven: z_dot - der(h(t)) + x*y_dot*y + x_dot*y^2/2 = 0)]
#[function(h(t))]
struct Guided {
    m: f64,
    h: Swing,
}

/// sin 2t
struct Swing;

impl Function<1, 1> for Swing {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 1] {
        [(t * S::constant(2.0)).sin()]
    }
}

#[test]
fn integrals_are_constant_along_the_motion() {
    let classes = [Integrability::IntegratingFactor, Integrability::Exact].map(proved);
    assert_eq!(Guided::CONSTRAINT_CLASSES, classes);
    let guided = Guided { m: 1.0, h: Swing };
    let rough = State::new([1.0, 0.5, 0.0], [0.3, 0.0, 0.0]);
    let (start, _) = guided.make_consistent(&rough).unwrap();
    let path = guided.integrate(start, 2.0, Dop853::with_tolerance(1e-12)).unwrap();
    let [ray, driven] = [0, 1].map(|row| guided.constraint_integral(row, &start).expect("an integral"));
    for sample in path.steps() {
        let state = sample.state();
        let [x, y, z] = state.q.data.0[0];
        assert_relative_eq!(guided.constraint_integral(0, state).unwrap(), ray, epsilon = 1e-10);
        assert_relative_eq!(guided.constraint_integral(1, state).unwrap(), driven, epsilon = 1e-10);
        // And they are what they should be, not constants.
        assert_relative_eq!(y / x, 0.5, epsilon = 1e-10);
        assert_relative_eq!(z - (2.0 * state.t).sin() + x * y * y / 2.0, driven, epsilon = 1e-10);
    }
    assert!((path.end().coordinate("x").unwrap() - 1.0).abs() > 0.1, "it has moved");
}

/// Integrable only together: the velocity of a turning disc.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(x_dot^2 + y_dot^2)]
#[constraint(turning: [x_dot, y_dot] = [-w*y, w*x])]
struct Carried {
    w: f64,
}

/// Two contact forms of opposite curl: their sum is d(z + u − x y), and no other combination is integrable.
#[derive(Lagrangian)]
#[coordinates(x, y, z, u)]
#[lagrangian(x_dot^2 + y_dot^2 + z_dot^2 + u_dot^2)]
#[constraint(forms: [z_dot - y*x_dot, u_dot - x*y_dot] = 0)]
struct Forms;

#[test]
fn constraints_may_be_integrable_together_only() {
    assert_eq!(Carried::CONSTRAINT_CLASSES, [proved(Integrability::Together); 2]);
    assert!(Carried::CONSTRAINT_CLASSES[0].integrability.is_integrable());
    assert!(Carried::equations().text().contains("(integrable together with the others)"));
    assert_eq!(Forms::INTEGRALS.map(Integrals::extent), Some(Extent::Some));
    assert!(Forms::equations().text().contains("1 of 2 velocity constraints"), "{}", Forms::equations());
}
