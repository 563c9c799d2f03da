use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
#[dissipation(-c/2 * x_dot^2)]
struct Negative {
    m: f64,
    c: f64,
}

#[derive(Lagrangian)]
#[coordinates(r: [3], x)]
#[lagrangian(m/2 * dot(r_dot, r_dot) + x_dot^2)]
#[dissipation(-dot(r_dot, r_dot) - exp(-x)*(x_dot - r_dot[0])^4/c^3 - abs(x_dot)^3)]
struct Sum {
    m: f64,
    c: f64,
}

fn main() {}
