use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(dot(r_dot, r_dot)/2 - dot(k, r))]
struct System {
    k: f64,
}

fn main() {}
