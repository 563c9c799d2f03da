use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
struct System {
    m: f64,
    k: f64,
}

fn main() {
    let system = System { m: 1.0, k: 1.0 };
    let _ = system.equilibrium(&State::at_rest([1.0]), &[]);
}
