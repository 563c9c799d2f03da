use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
#[constraint(stop: x = 0)]
#[observable(push = lambda(stopp))]
struct System {
    m: f64,
}

fn main() {}
