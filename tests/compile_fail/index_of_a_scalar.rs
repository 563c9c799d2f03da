use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, theta)]
#[define(height = l[1]*cos(theta[1]))]
#[define(twice = 2*m)]
#[lagrangian(sum(i in 0..2, m/2 * x_dot[i]^2) - x[0] - twice[1])]
struct System {
    m: f64,
    l: f64,
}

fn main() {}
