use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
#[conserved(total = m*x_ddot)]
struct System {
    m: f64,
}

fn main() {}
