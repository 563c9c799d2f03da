use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [100_000])]
#[lagrangian(m/2 * dot(r_dot, r_dot))]
struct System {
    m: f64,
}

fn main() {}
