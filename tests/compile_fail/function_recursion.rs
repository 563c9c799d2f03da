use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(f(a) = g(a))]
#[define(g(a) = f(a))]
#[lagrangian(m/2 * x_dot^2 - f(x))]
struct System {
    m: f64,
}

fn main() {}
