use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(m/2 * dot(r_dot, r_dot) - norm(cross(r, r_dot)))]
struct System {
    m: f64,
}

fn main() {}
