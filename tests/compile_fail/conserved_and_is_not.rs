use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[conserved(total = m/2 * x_dot^2 - k/2 * x^2)]
struct System {
    m: f64,
    k: f64,
}

fn main() {}
