use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * x_dot^2 + y*x_dot)]
struct System {
    m: f64,
}

fn main() {}
