use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - 1.8e308*x - 1e-310*y - 0.5e99999999999*x*y)]
struct Read {
    m: f64,
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - 1e-200^2 * x)]
struct Computed {
    m: f64,
}

fn main() {}
