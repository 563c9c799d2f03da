use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = potential)]
#[lagrangian(x_dot^2/2 - potential*x - potential(x))]
struct System<F: Function<1, 1>> {
    potential: F,
}

fn main() {}
