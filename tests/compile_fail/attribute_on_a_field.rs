use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
struct System {
    #[parameter(m: 0..1)]
    m: f64,
}

fn main() {}
