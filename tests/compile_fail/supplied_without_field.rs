use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x))]
#[function(V(x) = potental)]
#[lagrangian(x_dot^2/2 - U(x) - V(x))]
struct System<F: Function<1, 1>> {
    potential: F,
}

fn main() {}
