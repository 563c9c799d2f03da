use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y, q: [4], r: [3])]
#[frame(a: rotate_z(x))]
#[frame(b: rotate_z(y))]
#[frame(chain[k in 0..3]: rotate_z(x))]
#[define(s10 = velocity(a) + velocity(b))]
#[define(s11 = dot(velocity(a), velocity(b)))]
#[define(s12 = cross(velocity(a), r))]
#[define(s15 = express([1, 0, 0], a))]
#[define(s17 = vector(a, velocity(b)))]
#[define(s19 = position(a, velocity(b)))]
#[define(s24 = [velocity(a), velocity(b)])]
#[define(s25 = sum(k in 0..3, velocity(chain[k])))]
#[define(s26 = velocity(a)*velocity(a))]
#[define(s27 = velocity(a) + 1)]
#[define(s28 = velocity(a) - r_dot)]
#[lagrangian(x_dot^2 + y_dot^2 + dot(q_dot, q_dot) + dot(r_dot, r_dot))]
#[force(r: velocity(a))]
#[force(x: velocity(a))]
#[constraint(mixed: velocity(a) = velocity(b))]
struct System;

fn main() {}
