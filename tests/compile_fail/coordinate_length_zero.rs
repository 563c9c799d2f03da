use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [0])]
#[lagrangian(m/2 * x_dot^2)]
struct System {
    m: f64,
}

fn main() {}
