use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
#[dissipation(c*x_dot)]
struct Linear {
    m: f64,
    c: f64,
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[define(speed = x_dot + 2*y_dot)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[dissipation(c*(1 + x^2)*speed^3 + sin(x_dot) + 3)]
struct Odd {
    m: f64,
    c: f64,
}

fn main() {}
