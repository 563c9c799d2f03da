use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2 * r_dot^2)]
struct System {
    m: f64,
}

fn main() {}
