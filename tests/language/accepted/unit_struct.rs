//! A system without parameters.
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
struct Oscillator;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x^2/2)]
struct Braced {}

#[test]
fn a_system_may_have_no_parameters() {
    let state = State::at_rest([1.0]);
    assert_eq!(Oscillator.accelerations_unchecked(&state).accelerations[0], -1.0);
    assert_eq!((Braced {}).accelerations_unchecked(&state).accelerations[0], -1.0);
}
