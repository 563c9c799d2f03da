use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian((x_dot^2 + y_dot^2)/2)]
struct Free;

fn main() {}
