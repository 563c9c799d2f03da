use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k*x^2/2)]
struct Spring {
    k: f64,
}

fn main() {
    let _ = Spring { k: 1.0 }.integrate_sensitivities(State::at_rest([1.0]), 1.0, Taylor::default(), &["k"]);
}
