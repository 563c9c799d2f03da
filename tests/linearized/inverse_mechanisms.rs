//! Inverse dynamics of further mechanisms.

use lagrange_core::prelude::*;

/// A plane linkage of two bars and a coupler, with the coupler's constraint given twice.
#[derive(Clone, Lagrangian)]
#[coordinates(a: [2], b: [2], free)]
#[lagrangian((a_dot[0]^2 + a_dot[1]^2 + 2*b_dot[0]^2 + b_dot[1]^2 + free_dot^2)/2 - g*(a[1] + b[1]) - free^2/2)]
#[constraint(left: dot(a, a) = 1)]
#[constraint(right: (b[0] - 3)^2 + b[1]^2 = 1)]
#[constraint(coupler: dot(b - a, b - a) = 9)]
#[constraint(again: scale*(b[0] - a[0])^2 + other*(b[1] - a[1])^2 = 9*scale)]
#[force(a: push)]
struct Linkage {
    g: f64,
    scale: f64,
    other: f64,
    push: [f64; 2],
}

#[test]
fn accelerations_are_completed_to_those_of_the_motion() {
    for scale in [1.0, 1e-6, 1e6] {
        let linkage = Linkage { g: 9.81, scale, other: scale, push: [0.3, -0.2] };
        let guess = linkage
            .state_from(&[("a[0]", 0.3), ("a[1]", 0.9), ("b[0]", 3.2), ("b[1]", 1.0), ("a_dot[0]", 1.3)])
            .unwrap();
        let (state, _) = linkage.make_consistent(&guess).unwrap();
        let moved = linkage.solve(&state).unwrap().accelerations;
        for held in ["a[0]", "a[1]", "b[0]", "b[1]"] {
            // What is not held does not matter.
            let mut given = [7.0; 5];
            let i = Linkage::COORDINATES.iter().position(|name| *name == held).unwrap();
            (given[i], given[4]) = (moved[i], moved[4]);
            let found = linkage.complete_accelerations(&state, &given.into(), &[held, "free"]).unwrap();
            assert!((found - moved).amax() < 1e-12 * moved.amax(), "by {held}: {found} for {moved}");
        }
        // Both of a vector, as they are.
        let found = linkage.complete_accelerations(&state, &moved, &["a", "free"]).unwrap();
        assert!((found - moved).amax() < 1e-12 * moved.amax());
        let told = |given: [f64; 5], held: &[&str]| {
            linkage.complete_accelerations(&state, &given.into(), held).unwrap_err().to_string()
        };
        let error = told([0.0; 5], &["a[0]"]);
        assert!(error.contains("do not determine those of `free` at t = 0"), "{error}");
        let error = told([0.0; 5], &["free"]);
        assert!(error.contains("those of `a[0]`, `a[1]`, `b[0]`, `b[1]` at"), "{error}");
        let error = told([5.0; 5], &["a", "free"]);
        assert!(error.contains("violate constraint `left`"), "{error}");
        assert!(told([f64::NAN; 5], &["a[0]", "free"]).contains("constraint"));
        assert!(told([0.0; 5], &["c"]).contains("no coordinate `c`"));
        assert!(told([0.0; 5], &["a", "a[1]"]).contains("`a[1]`"));
    }
}

/// An arm of two links, with as many motors as coordinates.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [2])]
#[define(elbow = l*[cos(q[0]), sin(q[0])])]
#[define(tip = elbow + l*[cos(q[0] + q[1]), sin(q[0] + q[1])])]
#[lagrangian(m/2*(dot(der(elbow), der(elbow)) + dot(der(tip), der(tip))) - m*g*(elbow[1] + tip[1]))]
#[force(q: torque)]
struct Holding {
    m: f64,
    l: f64,
    g: f64,
    torque: [f64; 2],
}

/// The torques give the accelerations back that are asked for. At rest they are all there is: they hold the weight, and nothing
/// else gives the scale of what is left.
#[test]
fn motors_move_an_arm_as_asked_and_hold_it_in_every_pose() {
    let arm = Holding { m: 1.0, l: 0.5, g: 9.81, torque: [0.3, -2.0] };
    for k in 0..1000 {
        let k = f64::from(k);
        let q = [(1.3 * k).sin() * 3.0, (0.7 * k).cos() * 3.0];
        let found = arm.inputs_for(&State::at_rest(q), &[0.0; 2].into(), &["torque"]).unwrap();
        assert_eq!(found.names(), ["torque[0]", "torque[1]"]);
        let still = Holding { torque: [0.0; 2], ..arm };
        let exact = still.inverse_dynamics(&State::at_rest(q), &[0.0; 2].into(), &[].into());
        assert!((found.inputs[0] - exact[0]).abs() < 1e-13 && (found.inputs[1] - exact[1]).abs() < 1e-13);
        let (state, asked) = (State::new(q, [1.0, 2.0]), [3.0, -5.0].into());
        let found = arm.inputs_for(&state, &asked, &["torque"]).unwrap();
        let moved = Holding { torque: [found.inputs[0], found.inputs[1]], ..arm }.solve(&state).unwrap();
        assert!((moved.accelerations - asked).amax() < 1e-11, "{}", moved.accelerations);
    }
}
