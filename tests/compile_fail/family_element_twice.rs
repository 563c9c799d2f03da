use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(c[0] = x)]
#[define(c[0] = 2*x)]
#[lagrangian(m/2 * x_dot^2)]
struct System {
    m: f64,
}

fn main() {}
