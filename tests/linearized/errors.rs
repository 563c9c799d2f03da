//! What is wrong is said, with the names at fault.

use lagrange_core::{
    Direction, StateDerivatives,
    error::{Entry, Row},
    number::FourLanes,
};
use lagrange_core::{linearized::Stability, prelude::*};

/// A pendulum on a rod whose length is said again to be an input.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: x^2 + y^2 = l^2)]
#[force(x: push)]
struct Pendulum<'a> {
    m: f64,
    g: &'a f64,
    l: f64,
    push: f64,
}

const PENDULUM: Pendulum<'_> = Pendulum { m: 1.0, g: &9.81, l: 2.0, push: 0.0 };
const HANGING: [f64; 2] = [0.0, -2.0];

fn message<T: std::fmt::Debug>(result: Result<T, Error>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn names_are_checked() {
    let state = State::at_rest(HANGING);
    let message = message(PENDULUM.linearize(&state, &["pusch"]));
    assert_eq!(message, "there is no parameter `pusch`: did you mean `push`?");
    assert_eq!(
        self::message(PENDULUM.linearize(&state, &["colour"])),
        "there is no parameter `colour`: there are `m`, `g`, `l`, `push`; a field is a parameter if an expression of the system names it"
    );
    let error = PENDULUM.linearize(&state, &["push", "push"]).unwrap_err();
    assert_eq!(error, Error::RepeatedName { name: "push".into() });
    let Err(Error::UnknownName { kind, known, .. }) = PENDULUM.equilibrium(&state, &["z"]) else {
        panic!("z is no unknown");
    };
    assert_eq!((kind, known.len()), ("coordinate, velocity or parameter", 8));
}

#[test]
fn a_state_off_the_constraints_has_no_linear_system() {
    let error = PENDULUM.linearize(&State::at_rest([0.0, -1.0]), &[]).unwrap_err();
    assert!(matches!(error, Error::Inconsistent { constraint: "rod", .. }), "{error}");
}

#[test]
fn an_input_that_shifts_a_constraint_is_refused() {
    let error = PENDULUM.linearize(&State::at_rest(HANGING), &["push", "l"]).unwrap_err();
    assert_eq!(error, Error::InputShiftsConstraint { input: "l", constraint: "rod" });
}

#[test]
fn what_is_behind_a_reference_cannot_be_sought() {
    let error = PENDULUM.equilibrium(&State::at_rest(HANGING), &["g"]).unwrap_err();
    assert_eq!(error, Error::ParameterFixed { name: "g" });
    let error = PENDULUM.inputs_for(&State::at_rest(HANGING), &[0.0, 0.0].into(), &["g"]).unwrap_err();
    assert_eq!(error, Error::ParameterFixed { name: "g" });
    // It can be differentiated by, though.
    let jacobian = PENDULUM.jacobian(&State::at_rest(HANGING)).unwrap();
    let by_g = jacobian.multipliers.parameters[(0, 1)];
    // 2 λ y = m g
    assert!((by_g - 1.0 / (2.0 * -2.0)).abs() < 1e-15, "{by_g}");
}

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y - k/2*x^2)]
struct Falling {
    m: f64,
    g: f64,
    k: f64,
}

#[test]
fn where_nothing_rests_the_force_that_is_left_is_named() {
    let falling = Falling { m: 2.0, g: 9.81, k: 3.0 };
    let error = falling.equilibrium(&State::at_rest([1.0, 1.0]), &[]).unwrap_err();
    let Error::NoEquilibrium { row, residual, best, .. } = &error else { panic!("{error}") };
    assert_eq!(*row, Row::Coordinate("y"));
    assert!((residual - 2.0 * 9.81).abs() < 1e-14);
    assert_eq!(best.len(), 2);
    let text = error.to_string();
    assert!(text.contains("the row of coordinate `y` leaves 1.962e1"), "{text}");
    assert!(text.contains("y = 1.0;") && text.contains("start closer, or let other"), "{text}");
}

/// Its place is prescribed: it rests at no moment at which that moves.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
#[constraint(drive: x = cos(t))]
struct Driven;

#[test]
fn what_is_driven_does_not_rest() {
    let error = Driven.equilibrium(&State::at_rest([0.5]).at_time(1.0), &[]).unwrap_err();
    assert!(matches!(error, Error::NoEquilibrium { row: Row::Constraint("drive"), .. }), "{error}");
    // Nor where it turns round: there it is accelerated.
    assert!(Driven.equilibrium(&State::at_rest([1.0]), &[]).is_err());
}

/// A force with a kink in its derivative, and one that grows like a root.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[force(y: sqrt(x))]
struct Root;

#[test]
fn a_derivative_that_is_not_finite_is_named() {
    let at_the_root = State::at_rest([0.0, 1.0]).at_time(2.0);
    let expected =
        Error::DerivativeNotFinite { row: Row::Coordinate("y"), entry: Entry::Coordinate("x"), time: 2.0 };
    assert_eq!(Root.jacobian(&at_the_root), Err(expected.clone()));
    assert_eq!(Root.linearize(&at_the_root, &[]), Err(expected.clone()));
    assert_eq!(Root.equilibrium(&at_the_root, &[]).unwrap_err(), expected);
    assert!(expected.to_string().contains("by `x` is not finite at t = 2; row of coordinate `y`"));
    assert_eq!(Root.jacobian_by(&at_the_root, &["y", "x", "y_dot"]), Err(expected.clone()));
    // What was not asked for does no harm, nor what lies in another lane.
    assert_eq!(Root.jacobian_by(&at_the_root, &["y", "y_dot"]).unwrap().accelerations.as_slice(), [0.0; 4]);
    let slopes = Root.residual_slopes(&at_the_root, &Root.solve(&at_the_root).unwrap());
    let mut both = Direction::<FourLanes, 2>::zero();
    (both.q[0], both.q[1]) = (FourLanes::from([1.0, 0.0, 1.0, 0.0]), FourLanes::from([0.0, 1.0, 1.0, 0.0]));
    let change = Root.residual_change_with(&slopes, &both).motion[1].to_array();
    assert_eq!(change.map(f64::is_finite), [false, true, false, true]);
    let off = State::at_rest([f64::NAN, 1.0]);
    assert!(matches!(Root.equilibrium(&off, &[]), Err(Error::StateNotFinite { .. })));
    // Beyond the root the force itself is no number.
    let beyond = Root.equilibrium(&State::at_rest([-1.0, 1.0]), &["y"]).unwrap_err();
    assert_eq!(beyond, Error::EquationsNotFinite { row: Row::Coordinate("y"), time: 0.0 });
}

/// A spring of any power: ∂/∂n of xⁿ is xⁿ ln x, which is not a number at 0.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m*x_dot^2/2)]
#[force(x: push - k*x^n - c*x)]
struct Spring {
    m: f64,
    k: f64,
    n: f64,
    c: f64,
    push: f64,
}

#[test]
fn a_derivative_that_does_not_exist_leaves_the_others() {
    let spring = Spring { m: 2.0, k: 1.0, n: 3.0, c: 8.0, push: 0.0 };
    let near = spring.linearize(&State::at_rest([0.0]), &["push"]).unwrap();
    assert_eq!(near.a.as_slice(), [0.0, -4.0, 1.0, 0.0]);
    assert_eq!(near.b.as_slice(), [0.0, 0.5]);
    let error = spring.linearize(&State::at_rest([0.0]), &["n"]).unwrap_err();
    let entry = Entry::Parameter("n");
    assert_eq!(error, Error::DerivativeNotFinite { row: Row::Coordinate("x"), entry, time: 0.0 });
}

/// Without mass at the pole: the azimuth has no inertia where θ = 0.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi)]
#[lagrangian((theta_dot^2 + sin(theta)^2*phi_dot^2)/2 + cos(theta))]
struct Polar;

#[test]
fn at_a_pole_there_is_an_equilibrium_but_no_motion_to_differentiate() {
    let found = Polar.equilibrium(&State::at_rest([0.2, 0.7]), &[]).unwrap();
    assert!(found.state.q[0].abs() < 1e-15);
    assert_eq!(found.undetermined(), ["phi"]);
    let error = Polar.linearize(&State::at_rest([0.0, 0.7]), &[]).unwrap_err();
    assert!(error.to_string().contains("`phi`"), "{error}");
}

/// A pendulum in its angle.
#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 + g*cos(theta))]
struct Swing {
    g: f64,
}

/// Two carts that a spring joins, on a rail that is straight, or bends where x = 0.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - k/2*(y - x - l)^2 - bend*x^2/2)]
struct Carts {
    k: f64,
    l: f64,
    bend: f64,
}

#[test]
fn what_moves_on_into_other_forces_is_not_steady() {
    let swing = Swing { g: 9.81 };
    // At π/2 the force does not change to first order; where it vanishes, it does.
    for guess in [0.1, std::f64::consts::FRAC_PI_2 - 1e-3] {
        let error = swing.equilibrium(&State::new([guess], [1.0]), &[]).unwrap_err();
        let row = Row::Coordinate("theta");
        assert_eq!(error, Error::NotSteady { coordinate: "theta", row, time: 0.0 });
    }
    let text = message(swing.equilibrium(&State::new([0.1], [1.0]).at_time(2.0), &[]));
    let expected = "no steady motion with these velocities at t = 2: the row of coordinate `theta` changes as `theta` moves; give it no velocity";
    assert_eq!(text, expected);
    // Together the carts may move, with the spring as long as it likes to be.
    let carts = Carts { k: 7.3, l: 0.3, bend: 0.0 };
    let found = carts.equilibrium(&State::new([0.1, 0.2], [1.7, 1.7]), &[]).unwrap();
    assert!((found.state.q[1] - found.state.q[0] - 0.3).abs() < 1e-15, "{found:?}");
    let apart = carts.equilibrium(&State::new([0.1, 0.2], [1.7, 1.6]), &[]).unwrap_err();
    assert!(matches!(apart, Error::NotSteady { coordinate: "x", .. }), "{apart}");
    let bent = Carts { bend: 1.0, ..carts };
    let error = bent.equilibrium(&State::new([0.1, 0.2], [1.7, 1.7]), &[]).unwrap_err();
    assert!(matches!(error, Error::NotSteady { row: Row::Coordinate("x"), .. }), "{error}");
}

/// A groove whose walls steepen and flatten along it, but that runs straight.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[force(y: (1 - y - sin(y))*(2 + cos(x)))]
struct Groove;

/// At its bottom, which is hit but for round-off, the forces stay zero.
#[test]
fn what_moves_along_equilibria_is_steady() {
    for x in [0.5, 1.0, 2.0, 4.0] {
        let y = Groove.equilibrium(&State::new([x, 0.9], [1.0, 0.0]), &["y"]).unwrap().state.q[1];
        assert!((y + y.sin() - 1.0).abs() < 1e-15, "{y}");
    }
}

/// Three carts that two springs join, pulled apart.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2 - k/2*(0.3*(y - x - 1)^2 + 0.7*(z - y - 1)^2))]
#[force(x: -1.3)]
#[force(z: 1.3)]
struct Train {
    k: f64,
}

/// The changes by each coordinate cancel but for round-off; at the guess the springs are too soft for any.
#[test]
fn what_moves_as_one_is_steady() {
    for speed in [0.3, 1.1, 1.7, 2.9] {
        let guess = State::new([0.0, 3.0, 7.0], [speed; 3]);
        let found = Train { k: 1e-9 }.equilibrium(&guess, &["k", "y"]).unwrap();
        let stretch = found.state.q[1] - 1.0;
        assert!((stretch - 3.5).abs() < 1e-14, "{found:?}");
        assert!((0.3 * found.system.k * stretch - 1.3).abs() < 1e-14, "{}", found.system.k);
    }
}

/// A sphere that rolls down a slope, held by a spring.
#[derive(Clone, Lagrangian)]
#[coordinates(x, phi)]
#[lagrangian(m/2*x_dot^2 + 2/5*m*a^2/2*phi_dot^2 + m*g*sin(0.3)*x - k/2*x^2)]
#[constraint(no_slip: x_dot - a*phi_dot = 0)]
struct RollingSphere {
    m: f64,
    a: f64,
    g: f64,
    k: f64,
}

/// As it starts, ẍ = a φ̈: another radius is another acceleration across the constraint.
#[test]
fn an_input_that_changes_what_accelerations_are_allowed_is_refused() {
    let sphere = RollingSphere { m: 2.1, a: 0.1, g: 9.81, k: 5.0 };
    let start = State::at_rest([0.0, 1.0]);
    let error = sphere.linearize(&start, &["a"]).unwrap_err();
    assert_eq!(error, Error::InputShiftsConstraint { input: "a", constraint: "no_slip" });
    assert!(error.to_string().contains("which motions are allowed"), "{error}");
    assert!(sphere.linearize(&start, &["k", "g"]).is_ok());
    // Where it rests, but for round-off, nothing rolls, with any radius.
    let rest = sphere.equilibrium(&start, &["x"]).unwrap().state;
    let nearly = State::at_rest([rest.q[0] * (1.0 + 4.0 * f64::EPSILON), 1.0]);
    assert!(sphere.solve(&nearly).unwrap().accelerations[1] != 0.0);
    let near = sphere.linearize(&nearly, &["a"]).unwrap();
    assert!(near.b.amax() < 1e-12, "{}", near.b);
}

#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m*x_dot^2/2 - k*x^2/2)]
struct Oscillator {
    m: f64,
    k: f64,
}

#[test]
fn numbers_too_large_are_named_and_never_stable() {
    let error = Oscillator { m: 1e-200, k: 1e200 }.linearize(&State::at_rest([0.0]), &[]).unwrap_err();
    let (row, entry) = (Row::Coordinate("x"), Entry::Coordinate("x"));
    assert_eq!(error, Error::DerivativeNotFinite { row, entry, time: 0.0 });
    let mut near = Oscillator { m: 1.0, k: 1.0 }.linearize(&State::at_rest([0.0]), &[]).unwrap();
    for entry in [f64::NAN, f64::INFINITY] {
        near.a[(1, 0)] = entry;
        assert_eq!(near.stability(), Err(Error::EigenvaluesNotFound));
        assert_eq!(near.natural_frequencies(), Err(Error::EigenvaluesNotFound));
    }
    let text = Error::EigenvaluesNotFound.to_string();
    assert!(text.contains("eigenvalues or singular values"), "{text}");
}

/// Two constraints leave nothing to move.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
#[constraint(wall: x = 1)]
struct Fixed;

#[test]
fn what_cannot_move_comes_back() {
    let near = Fixed.linearize(&State::at_rest([1.0]), &[]).unwrap();
    assert_eq!((near.a.shape(), near.stability()), ((0, 0), Ok(Stability::AsymptoticallyStable)));
}

/// A cyclic coordinate, and a rotation of which one entry counts.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[parameter(r: rotation)]
#[lagrangian(x_dot^2/2 + y_dot^2/2 - r[0][1]*y)]
struct Sliding {
    r: [[f64; 2]; 2],
}

#[test]
fn a_number_that_the_equations_do_not_use_must_be_finite_too() {
    let says = |system: &Sliding, state: &State<f64, 2>, text: &str| {
        let found = [
            message(system.solve(state)),
            message(system.check_consistent(state)),
            message(system.state_jacobian(state)),
            message(system.jacobian(state)),
            message(system.jacobian_by(state, &["y"])),
            message(system.inputs_for(state, &[1.0, 0.0].into(), &["x", "y"])),
            message(system.linearize(state, &[])),
        ];
        found.iter().for_each(|found| assert_eq!(found, text));
    };
    let turned = Sliding { r: [[0.6, 0.8], [-0.8, 0.6]] };
    for x in [f64::NAN, f64::INFINITY] {
        let text = format!("`x` is {x} in the state given: every entry must be finite");
        says(&turned, &State::at_rest([x, 0.0]), &text);
        let broken = Sliding { r: [[x, 0.8], [-0.8, 0.6]] };
        says(
            &broken,
            &State::at_rest([0.0; 2]),
            "the parameter `r` is not a rotation: one of its entries is not finite",
        );
    }
}
