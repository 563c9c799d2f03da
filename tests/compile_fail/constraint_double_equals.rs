use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(rod: x^2 + y^2 == l^2)]
struct System {
    m: f64,
    l: f64,
}

fn main() {}
