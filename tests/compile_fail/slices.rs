use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, r: [3])]
#[define(a = r[0..4])]
#[define(b = r[2..2])]
#[define(c = r[..2])]
#[lagrangian(x_dot^2 + dot(r_dot, r_dot))]
struct Written;

#[derive(Lagrangian)]
#[coordinates(x, r: [3])]
#[define(a = r[0..4])]
#[define(b = r[2..2])]
#[define(d = x[0..1])]
#[define(e = r[0..x])]
#[define(f = r[0..2] + r)]
#[lagrangian(x_dot^2 + dot(r_dot, r_dot))]
struct Lowered;

#[derive(Lagrangian)]
#[coordinates(x, r: [3])]
#[define(a = r[0..=2])]
#[define(b = r[1..])]
#[lagrangian(x_dot^2 + dot(r_dot, r_dot))]
struct Ranges;

fn main() {}
