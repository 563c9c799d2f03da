use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = potential)]
#[function(U(x, t) = potential)]
#[lagrangian(x_dot^2/2 - U(x))]
struct System<F: Function<1, 1>> {
    potential: F,
}

fn main() {}
