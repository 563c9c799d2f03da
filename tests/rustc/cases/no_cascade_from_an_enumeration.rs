use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
enum System {
    A,
}

fn main() {
    System::A.accelerations_unchecked(&State::at_rest([0.0]));
}
