use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[lagrangian(dot(r_dot, r_dot)/2 - sum(i in 0..3, r[i]))]
struct System;

fn main() {}
