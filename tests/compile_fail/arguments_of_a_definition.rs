use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(f(a, b) = a*b)]
#[lagrangian(m/2 * x_dot^2 - f(x))]
struct System {
    m: f64,
}

fn main() {}
