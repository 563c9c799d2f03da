use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(dot(r_dot*inertia, r_dot)/2)]
struct System {
    inertia: [[f64; 2]; 2],
}

fn main() {}
