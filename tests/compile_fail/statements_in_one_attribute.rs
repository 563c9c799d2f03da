use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[define(a = 1; b = 2 c; d = sqr(x))]
#[force(x: -k*x;; y: 0)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2); k/2*x^2)]
struct System {
    m: f64,
    k: f64,
}

fn main() {}
