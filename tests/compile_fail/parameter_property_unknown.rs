use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[parameter(a: symetric)]
#[lagrangian(dot(r_dot, a*r_dot)/2)]
struct System {
    a: [[f64; 3]; 3],
}

fn main() {}
