use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - 2^2000 * x)]
struct System {
    m: f64,
}

fn main() {}
