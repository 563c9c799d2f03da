use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(a = b)]
#[define(b = a)]
#[lagrangian(m/2 * x_dot^2 - a)]
struct System {
    m: f64,
}

fn main() {}
