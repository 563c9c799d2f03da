use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2 * dot(r_dot, r_dot) - dot(r, m + r))]
struct System {
    m: f64,
}

fn main() {}
