use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = potential)]
#[lagrangian(x_dot^2/2 - U(x))]
struct System<F> {
    potential: F,
}

fn main() {
    let system = System { potential: |x: f64| x * x };
    let _ = system.integrate(State::at_rest([0.0]), 1.0, Dop853::default());
}
