//! Numbers of a state have a point.

use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
struct Free;

fn main() {
    let _ = Free.integrate(State::at_rest([1, 0]), 1.0, Dop853::default());
    let _ = Free.solve(&State::new([1, 0], [0.0, 1.0]));
}
