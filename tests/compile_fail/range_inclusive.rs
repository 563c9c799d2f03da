use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(c[i in 0..=2] = i*x)]
#[lagrangian(m/2 * x_dot^2)]
struct System {
    m: f64,
}

fn main() {}
