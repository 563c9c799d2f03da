use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[define(w = quat_rate_body(q, [1, 2, 3]))]
#[define(v = quat_rotate(q, q_dot))]
#[lagrangian(dot(q_dot, q_dot)/2)]
struct System;

fn main() {}
