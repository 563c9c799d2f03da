use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - sqrt(-1)*x - ln(0) - asin(2) - (-8)^(1/3))]
struct System {
    m: f64,
}

fn main() {}
