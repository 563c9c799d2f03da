use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k/2*max(x, 0)^2)]
struct OneSided {
    m: f64,
    k: f64,
}

fn main() {}
