use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m[0]/2 * x_dot^2)]
struct System<const N: usize> {
    m: [f64; N],
}

fn main() {}
