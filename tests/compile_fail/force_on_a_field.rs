use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[frame(body: translate([x, 0, 0]))]
#[lagrangian(m/2 * x_dot^2)]
#[force(m: 1)]
#[force(body: 1)]
struct System {
    m: f64,
}

fn main() {}
