use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[define(p[0] = [1, 2])]
#[define(p[1] = 3)]
#[lagrangian(dot(r_dot, r_dot)/2 - sum(i in 0..2, dot(p[i], r)))]
struct System;

fn main() {}
