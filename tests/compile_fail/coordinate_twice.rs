use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y, x)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
struct System {
    m: f64,
}

fn main() {}
