use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(norm(x_dot)^2/2)]
struct System;

fn main() {}
