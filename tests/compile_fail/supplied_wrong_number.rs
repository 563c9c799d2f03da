use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3], x)]
#[function(U(r) = potential)]
#[function(f(r, x) = potential)]
#[lagrangian(dot(r_dot, r_dot)/2 + x_dot^2/2 - U(r, x) - f(r) - U())]
struct System<F: Function<3, 1>> {
    potential: F,
}

fn main() {}
