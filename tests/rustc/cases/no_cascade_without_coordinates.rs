use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[lagrangian(m/2 * x_dot^2)]
struct System {
    m: f64,
}

fn main() {
    let system = System { m: 1.0 };
    system.accelerations_unchecked(&State::at_rest([0.0]));
}
