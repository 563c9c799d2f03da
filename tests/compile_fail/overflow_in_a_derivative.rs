use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - sin(1e200 * x) * 1e200)]
struct System {
    m: f64,
}

fn main() {}
