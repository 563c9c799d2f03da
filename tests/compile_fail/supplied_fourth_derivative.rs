use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(height(t) = lift)]
#[lagrangian(x_dot^2/2 + x_dot*der(der(der(height(t)))))]
struct System<F: Function<1, 1>> {
    lift: F,
}

fn main() {}
