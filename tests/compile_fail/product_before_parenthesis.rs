use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(1/2 (m * x_dot^2))]
struct System {
    m: f64,
}

fn main() {}
