use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(z = x^2)]
#[lagrangian(m/2 * z_dot^2)]
struct System {
    m: f64,
}

fn main() {}
