//! Further systems in which something is wrong, or that do not rest.

use lagrange_core::error::{Entry, Row};
use lagrange_core::linearized::{BaseParameters, Stability};
use lagrange_core::{StateDerivatives, prelude::*};
use lagrange_random::Random;
use lagrange_systems::Flying;

use crate::errors::message;
use crate::mechanisms::RollingSphere;
use crate::regressor::{Body, NAMES, bars, body, somewhere};

#[test]
fn where_nothing_rests_the_force_that_is_left_is_named() {
    let falling = Flying { m: 2.0, g: 9.81 };
    let error = falling.equilibrium(&State::at_rest([1.0, 1.0]), &[]).unwrap_err();
    let Error::NoEquilibrium { row, residual, best, .. } = &error else { panic!("{error}") };
    assert_eq!(*row, Row::Coordinate("y"));
    assert!((residual - 2.0 * 9.81).abs() < 1e-14);
    assert_eq!(best.len(), 2);
    let text = error.to_string();
    assert!(text.contains("the row of coordinate `y` leaves 1.962e1"), "{text}");
    assert!(text.contains("y = 1.0;") && text.contains("start closer, or let other"), "{text}");
}

/// A mass whose place is prescribed: it rests at no moment at which that moves.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
#[constraint(drive: x = cos(w*t))]
struct Led {
    w: f64,
}

#[test]
fn what_is_driven_does_not_rest() {
    let error = Led { w: 1.0 }.equilibrium(&State::at_rest([0.5]).at_time(1.0), &[]).unwrap_err();
    assert!(matches!(error, Error::NoEquilibrium { row: Row::Constraint("drive"), .. }), "{error}");
    // Nor where it turns round: there it is accelerated.
    assert!(Led { w: 1.0 }.equilibrium(&State::at_rest([1.0]), &[]).is_err());
}

/// A pendulum by an angle that is counted from anywhere.
#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 + g*cos(theta + phase))]
pub(crate) struct Swing {
    pub(crate) g: f64,
    pub(crate) phase: f64,
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
    let swing = Swing { g: 9.81, phase: 0.0 };
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

/// The constraint leaves nothing to move.
#[test]
fn what_cannot_move_comes_back() {
    let near = Led { w: 0.0 }.linearize(&State::at_rest([1.0]), &[]).unwrap();
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

/// Pushes along one line, one that hardly acts, and one whose effect begins with an infinite slope.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
#[force(x: sin(x)*(u[0] + u[1]) + sqrt(root))]
#[force(y: cos(x)*(u[0] + 1.000000000001*u[1]) + 1e-14*weak)]
struct Pushed {
    u: [f64; 2],
    weak: f64,
    root: f64,
}

#[test]
fn inputs_have_their_own_units_and_must_tell_apart() {
    let pushed = Pushed { u: [0.0; 2], weak: 0.0, root: 0.0 };
    let state = State::at_rest([0.7, 0.0]);
    let found = pushed.inputs_for(&state, &[0.0, 3.0].into(), &["weak"]).unwrap();
    assert!((found.inputs[0] - 3e14).abs() < 1.0, "{found:?}");
    // In the same direction but for digits that the equations have not.
    let both = pushed.inputs_for(&state, &[0.7_f64.sin(), 0.7_f64.cos()].into(), &["u"]).unwrap_err();
    assert!(
        matches!(&both, Error::InputsNotUnique { inputs, .. } if inputs.as_slice() == ["u[0]", "u[1]"]),
        "{both}"
    );
    let steep = pushed.inputs_for(&state, &[1.0, 0.0].into(), &["root"]).unwrap_err();
    let entry = Entry::Parameter("root");
    let expected = Error::DerivativeNotFinite { row: Row::Coordinate("x"), entry, time: 0.0 };
    assert_eq!(steep, expected);
    assert_eq!(pushed.jacobian_by(&state, &["weak", "root"]).unwrap_err(), expected);
}

/// A body whose mass does more than it should, and one that cannot be set.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[frame(cart: translate([x, 0, 0]))]
#[parameter(odd: {m, centre: [3], inertia: symmetric})]
#[lagrangian(kinetic(cart, odd.m, odd.centre, odd.inertia) - odd.m^2*x^2/2)]
struct Odd {
    odd: Body,
}

/// The inertia of a body may be any matrix, of which the symmetric part counts.
#[derive(Clone, Lagrangian)]
#[coordinates(x)]
#[frame(wheel: rotate_z(x))]
#[parameter(body: {m, centre: [3], inertia: [3, 3]})]
#[lagrangian(kinetic(wheel, body.m, body.centre, body.inertia))]
struct Loose {
    body: Body,
}

#[test]
fn what_is_no_body_is_refused() {
    let mut random = Random(1);
    let odd = Odd { odd: body(&mut random) };
    let state = State::new([0.3], [0.2]);
    let told = |bodies: &[&str]| odd.regressor(&state, &[1.0].into(), bodies).unwrap_err().to_string();
    assert!(told(&["odd"]).contains("not linear in the masses"), "{}", told(&["odd"]));
    // The name of a frame, one with a slip, and another.
    assert!(told(&["od"]).ends_with("`od`: did you mean `odd`?"), "{}", told(&["od"]));
    assert!(told(&["dod"]).ends_with("`dod`: did you mean `odd`?"), "{}", told(&["dod"]));
    assert!(told(&["wheels"]).ends_with("`wheels`: there are `odd`"), "{}", told(&["wheels"]));
    assert!(told(&["odd.inertia"]).ends_with("there are `odd`"), "{}", told(&["odd.inertia"]));
    // At m = 2 its derivative is that at m = 1 of another law.
    for m in [0.0, 1.0, 2.0] {
        let odd = Odd { odd: Body { m, ..odd.odd } };
        let error = odd.regressor(&state, &[1.0].into(), &["odd"]).unwrap_err().to_string();
        assert!(error.contains("not linear in the masses"), "{m}: {error}");
    }
    let loose = Loose { body: odd.odd };
    let error = loose.regressor(&state, &[1.0].into(), &["body"]).unwrap_err().to_string();
    assert!(error.contains("`inertia: symmetric`"), "{error}");
    assert!(told(&["odd", "odd"]).contains("`odd`"));
    let (bars, (state, accelerations)) = (bars(&mut random), somewhere(&mut random));
    let [one, all] = [1, 3].map(|count| bars.regressor(&state, &accelerations, &NAMES[..count]).unwrap());
    assert!(BaseParameters::of(&[one, all]).unwrap_err().to_string().contains("different bodies"));
    assert_eq!(BaseParameters::<f64>::of(&[]).unwrap().count(), 0);
}
