use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [2], x)]
#[lagrangian(dot(r_dot, r_dot)/2 + x_dot^2/2 - x^r)]
struct System;

fn main() {}
