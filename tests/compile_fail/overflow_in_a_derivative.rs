use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - sin(10^20 * x)*sin(10^20 * x) * 10^25 * x)]
struct System {
    m: f64,
}

fn main() {}
