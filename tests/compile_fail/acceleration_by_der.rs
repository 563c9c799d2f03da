use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x * der(x_dot))]
struct System {
    m: f64,
}

fn main() {}
