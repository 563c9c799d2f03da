use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2 * r_dot)]
struct System {
    m: f64,
}

fn main() {}
