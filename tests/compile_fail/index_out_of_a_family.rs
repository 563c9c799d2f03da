use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(p[i in 0..3] = [x, i])]
#[lagrangian(x_dot^2/2 - p[3][0] - p[1][2])]
struct System;

fn main() {}
