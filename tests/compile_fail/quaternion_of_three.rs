use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(q: [3])]
#[lagrangian(dot(quat_rate(q, q_dot), quat_rate(q, q_dot))/2)]
struct System;

fn main() {}
