use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(m/2 * (r[0]_dot^2 + r_dot[1]^2))]
struct System {
    m: f64,
}

fn main() {}
