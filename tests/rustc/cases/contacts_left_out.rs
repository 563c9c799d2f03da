use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(y)]
#[lagrangian(y_dot^2/2 - g*y)]
struct Stone {
    g: f64,
}

fn main() {
    // It has nothing to fall on.
    let _ = Stone { g: 9.81 }.motion(State::at_rest([1.0])).with_contacts().to(1.0);
}
