use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(a = 2*b)]
#[define(b = x)]
#[lagrangian(m/2 * x_dot^2 - a)]
struct System {
    m: f64,
}

fn main() {}
