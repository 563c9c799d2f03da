use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m[0]/2 * x_dot^2)]
struct System {
    m: [f64; 4000000000],
}

fn main() {}
