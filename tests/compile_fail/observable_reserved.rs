use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
#[observable(energy = m/2 * x_dot^2)]
#[observable(mass_matrix = m)]
struct System {
    m: f64,
}

fn main() {}
