use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian]
struct System {
    m: f64,
}

fn main() {}
