use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - 9.81_f64*x)]
#[force(x: 2_x)]
struct Falling;

fn main() {}
