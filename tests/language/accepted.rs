//! What the derive takes: the outermost of what is right.

use lagrange_core::prelude::*;

/// Every attribute with trailing commas.
#[derive(Lagrangian)]
#[coordinates(x, r: [2],)]
#[define(half(a,) = a/2,)]
#[lagrangian(half(m*x_dot^2,) + m/2 * dot(r_dot, r_dot,),)]
#[constraint(rod: x = l,)]
#[force(r: [0, 1,],)]
#[dissipation(x_dot^2,)]
#[observable(pull = lambda(rod,),)]
#[parameter(m: 0..1,)]
#[lagrange(crate = lagrange_core, scalar = f64,)]
struct Commas {
    m: f64,
    l: f64,
}

#[test]
fn trailing_commas_are_taken() {
    let (system, state) = (Commas { m: 1.0, l: 0.0 }, State::at_rest([0.0; 3]));
    assert_eq!(system.pull(&state, &system.accelerations_unchecked(&state)), 0.0);
}

/// Numbers, signs and powers.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
#[observable(read = [1_000, 5., 1.5e-3, -x^2, 2^-1, 2^3^2, 2*-x - -x, 2/5, 8/4/2, x^0.5 - sqrt(x)])]
#[observable(zero = 0 + [x, x])]
struct Numbers;

#[test]
fn numbers_are_read_as_they_are_written() {
    let state = State::at_rest([3.0]);
    let expected = [1000.0, 5.0, 0.0015, -9.0, 0.5, 512.0, -3.0, 0.4, 1.0, 0.0];
    assert_eq!(Numbers.read(&state).as_slice(), expected);
    assert_eq!(Numbers.zero(&state)[1], 3.0);
}
