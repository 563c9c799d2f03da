use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - sum(i in 0..200, sum(j in 0..200, sqrt((x - p[i])^2 + p[j]^2))))]
struct System {
    p: [f64; 200],
}

fn main() {}
