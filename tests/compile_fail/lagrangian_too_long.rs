use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - x*dot(v, a * v))]
struct System {
    a: SMatrix<f64, 300, 300>,
    v: SVector<f64, 300>,
}

fn main() {}
