use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2))]
#[constraint(rail: y = a*x^2)]
#[conserved(push = [m*x_dot, m*z_dot])]
struct System {
    m: f64,
    a: f64,
}

fn main() {}
