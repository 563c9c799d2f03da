use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(c[0] = x)]
#[define(c[2] = 2*x)]
#[lagrangian(m/2 * x_dot^2 - norm(c))]
struct System {
    m: f64,
}

fn main() {}
