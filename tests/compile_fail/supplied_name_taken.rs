use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(x(t) = motion)]
#[function(x_dot(t) = motion)]
#[function(m(t) = motion)]
#[function(sin(s) = motion)]
#[function(t(s) = motion)]
#[function(k(s) = motion)]
#[define(k = 2*m)]
#[lagrangian(x_dot^2/2)]
struct System<F: Function<1, 1>> {
    m: f64,
    motion: F,
}

fn main() {}
