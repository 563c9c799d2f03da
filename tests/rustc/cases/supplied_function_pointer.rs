use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = potential)]
#[lagrangian(x_dot^2/2 - U(x))]
struct System {
    potential: fn(f64) -> f64,
}

fn main() {}
