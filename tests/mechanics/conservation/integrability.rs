//! What kind of constraint it is, as a type tells it: the constants of the trait, the integrals that were
//! found, and the equations as text. That the integrals are constant is seen on integrated motions.

use approx::assert_relative_eq;
use lagrange_core::{
    ConstraintKind,
    facts::{Classification, Evidence, Extent, Integrability, Integrals},
    prelude::*,
};

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

const fn proved(integrability: Integrability) -> Classification {
    Classification { integrability, evidence: Evidence::Proved }
}

#[test]
fn cylinder_8_5() {
    // A constant of the type: known to the compiler.
    const CLASSES: &[Classification] = Cylinder::CONSTRAINT_CLASSES;
    const INTEGRALS: Option<Integrals> = Cylinder::INTEGRALS;
    assert_eq!(CLASSES, [proved(Integrability::Exact)]);
    assert_eq!(INTEGRALS, Some(Integrals { count: 1, of: 1, evidence: Evidence::Proved }));
    assert_eq!(Cylinder::CONSTRAINT_KINDS, [ConstraintKind::Velocity], "it is enforced as it is written");
    let text = Cylinder::equations().text();
    assert!(text.contains("no_slip: Ẋ − a φ̇ = 0   (integrable: X − a φ is constant)"), "{text}");
    let cylinder = Cylinder { m: 1.0, a: 0.2, g: 9.81 };
    let state = State::new([3.0, 5.0], [0.4, 2.0]);
    assert_eq!(cylinder.constraint_integral(0, &state), Some(2.0));
    assert_eq!(cylinder.constraint_integral(1, &state), None);
}

/// A sphere with a point on its axis of spin marked, in Euler's angles z-x-z: Milton (8.4) in two dimensions.
#[derive(Lagrangian)]
#[coordinates(x, y, phi, th, psi)]
#[define(wx = th_dot*cos(phi) + psi_dot*sin(th)*sin(phi))]
#[define(wy = th_dot*sin(phi) - psi_dot*sin(th)*cos(phi))]
#[define(wz = phi_dot + psi_dot*cos(th))]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*a^2/5*(wx^2 + wy^2 + wz^2))]
#[constraint(rolling: [x_dot - a*wy, y_dot + a*wx] = 0)]
struct Sphere {
    m: f64,
    a: f64,
}

/// The same with a unit quaternion.
#[derive(Lagrangian)]
#[coordinates(r: [2], q: [4])]
#[define(omega = quat_rate(q, q_dot))]
#[lagrangian(m/2*dot(r_dot, r_dot) + m*a^2/5*dot(omega, omega))]
#[constraint(unit: dot(q, q) = 1)]
#[constraint(rolling: r_dot = [a*omega[1], -a*omega[0]])]
struct Ball {
    m: f64,
    a: f64,
}

/// On a turntable: affine.
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

#[test]
fn sphere_8_4() {
    assert_eq!(Sphere::CONSTRAINT_CLASSES, [proved(Integrability::Nonholonomic); 2]);
    assert_eq!(Sphere::INTEGRALS, Some(Integrals { count: 0, of: 2, evidence: Evidence::Proved }));
    assert!(Sphere::equations().text().contains("(nonholonomic)"), "{}", Sphere::equations());
    let kinds = Ball::CONSTRAINT_CLASSES.iter().map(|class| class.integrability);
    assert!(kinds.eq([Integrability::Holonomic, Integrability::Nonholonomic, Integrability::Nonholonomic]));
    // Where |q| = 1 points are computed: a verdict of points.
    assert_eq!(Ball::CONSTRAINT_CLASSES[1].evidence, Evidence::Held(8));
    let said = [Ball::CONSTRAINT_CLASSES[0], Ball::CONSTRAINT_CLASSES[1], Classification::UNDECIDED];
    assert_eq!(
        said.map(|class| class.to_string()),
        [
            "holonomic (proved)",
            "nonholonomic (as far as 8 random points show)",
            "whether it can be integrated is not decided (no random point was found at which it could be judged)",
        ]
    );
    assert_eq!(Turntable::CONSTRAINT_CLASSES, Ball::CONSTRAINT_CLASSES);
    for integrals in [Ball::INTEGRALS, Turntable::INTEGRALS] {
        let integrals = integrals.expect("a decision");
        assert_eq!((integrals.count, integrals.of, integrals.extent()), (0, 2, Extent::None));
    }
}

/// Two wheels on an axle: Goldstein, Poole and Safko, chapter 1, exercise 5.
#[derive(Lagrangian)]
#[coordinates(x, y, th, u, v)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + i/2*th_dot^2 + m*a^2/4*(u_dot^2 + v_dot^2) + m*g*x)]
#[constraint(edge: x_dot*cos(th) + y_dot*sin(th) = 0)]
#[constraint(left: x_dot*sin(th) - y_dot*cos(th) - b/2*th_dot - a*u_dot = 0)]
#[constraint(right: x_dot*sin(th) - y_dot*cos(th) + b/2*th_dot - a*v_dot = 0)]
struct Axle {
    m: f64,
    i: f64,
    a: f64,
    b: f64,
    g: f64,
}

#[test]
fn two_wheels_on_an_axle() {
    let integrals = Axle::INTEGRALS.expect("a decision");
    assert_eq!((integrals.count, integrals.of, integrals.extent()), (1, 3, Extent::Some));
    assert!(Axle::equations().text().contains("1 of 3 velocity constraints"), "{}", Axle::equations());
    // The one integral, found by Goldstein: b θ + a (u − v).
    let axle = Axle { m: 1.0, i: 0.3, a: 0.2, b: 0.7, g: 2.0 };
    let rough = axle.state_from(&[("th", 0.4), ("u_dot", 1.0), ("v_dot", -0.6)]).unwrap();
    let (start, _) = axle.make_consistent(&rough).unwrap();
    let path = axle.integrate(start, 3.0, Dop853::with_tolerance(1e-12)).unwrap();
    for sample in path.steps() {
        let [_, _, th, u, v] = sample.state().q.data.0[0];
        assert_relative_eq!(0.7 * th + 0.2 * (u - v), 0.7 * 0.4, epsilon = 1e-10);
    }
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
    let &[ray, driven] = Guided::CONSTRAINT_CLASSES else { panic!("a class for each") };
    assert_eq!(ray, proved(Integrability::IntegratingFactor));
    assert_eq!(driven, proved(Integrability::Exact));
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

/// Only together: the velocity of a turning disc.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(x_dot^2 + y_dot^2)]
#[constraint(turning: [x_dot, y_dot] = [-w*y, w*x])]
struct Carried {
    w: f64,
}

/// Only on the surface z = b.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(x_dot^2 + y_dot^2 + z_dot^2)]
#[constraint(table: z = b)]
#[constraint(slope: x_dot - z*y_dot = 0)]
struct OnATable {
    b: f64,
}

#[derive(Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2)]
struct Free;

#[test]
fn sets() {
    assert_eq!(Carried::CONSTRAINT_CLASSES, [proved(Integrability::Together); 2]);
    assert_eq!(Carried::INTEGRALS.map(Integrals::extent), Some(Extent::All));
    assert!(Carried::equations().text().contains("(integrable together with the others)"));
    let &[table, slope] = OnATable::CONSTRAINT_CLASSES else { panic!("a class for each") };
    assert_eq!(table, proved(Integrability::Holonomic));
    assert_eq!(slope.integrability, Integrability::Exact);
    assert!(slope.integrability.is_integrable());
    assert_eq!(OnATable::INTEGRALS.map(Integrals::extent), Some(Extent::All));
    assert_eq!(Free::INTEGRALS, Some(Integrals::VOID));
}
