use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m[0]/2 * x_dot^2 - dot(eps, eps)*x)]
struct System {
    m: [f64; 2],
    eps: [f64; 99_999],
}

fn main() {}
