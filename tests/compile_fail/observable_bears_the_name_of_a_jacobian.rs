use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
#[observable(jacobian = m)]
#[observable(parameters = m * x)]
#[observable(linearize = m * x^2)]
#[observable(equilibrium = x)]
struct System {
    m: f64,
}

fn main() {}
