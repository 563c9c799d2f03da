//! Numbers, signs and powers.
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
#[observable(thousand = 1_000)]
#[observable(five = 5.)]
#[observable(tiny = 1.5e-3)]
#[observable(minus_square = -x^2)]
#[observable(half = 2^-1)]
#[observable(tower = 2^3^2)]
#[observable(signs = 2*-x - -x)]
#[observable(fraction = 2/5)]
#[observable(left_to_right = 8/4/2)]
#[observable(root = x^0.5 - sqrt(x))]
#[observable(zero = 0 + [x, x])]
struct System;

#[test]
fn numbers_are_read_as_they_are_written() {
    let state = State::at_rest([3.0]);
    assert_eq!(System.thousand(&state), 1000.0);
    assert_eq!(System.five(&state), 5.0);
    assert_eq!(System.tiny(&state), 0.0015);
    assert_eq!(System.minus_square(&state), -9.0);
    assert_eq!(System.half(&state), 0.5);
    assert_eq!(System.tower(&state), 512.0);
    assert_eq!(System.signs(&state), -3.0);
    assert_eq!(System.fraction(&state), 0.4);
    assert_eq!(System.left_to_right(&state), 1.0);
    assert_eq!(System.root(&state), 0.0);
    assert_eq!(System.zero(&state)[1], 3.0);
}
