use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(a = 1, b = 2)]
#[lagrangian(m/2 * x_dot^2)]
struct System {
    m: f64,
}

fn main() {}
