use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2)]
#[dissipation(c/2 * x_dot^2)]
#[parameter(c: 0..1/1_000_000)]
#[conserved(total = m/2 * x_dot^2 + k/2 * x^2)]
struct System {
    m: f64,
    k: f64,
    c: f64,
}

fn main() {}
