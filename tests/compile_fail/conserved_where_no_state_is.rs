use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(circle: x^2 + y^2 = 1 - l^2)]
#[parameter(l: 2..3)]
#[conserved(rotation = x*y_dot - y*x_dot)]
struct System {
    m: f64,
    l: f64,
}

fn main() {}
