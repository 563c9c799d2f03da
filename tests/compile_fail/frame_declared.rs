use lagrange_core::nalgebra::Matrix3;
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y, q: [4], r: [3])]
#[frame(own in own: rotate_z(x))]
#[frame(early in late: rotate_z(x))]
#[frame(late: rotate_z(y))]
#[frame(a: rotate_z(x))]
#[frame(a: rotate_z(y))]
#[frame(link[i in 0..3] in link[i+1]: rotate_z(x))]
#[frame(loose[i in 0..2] in bound[i]: rotate_z(x))]
#[frame(bound[i in 0..2] in loose[i]: rotate_z(y))]
#[frame(b in x: rotate_z(x))]
#[frame(c: rotate_z(r))]
#[frame(d: translate(x))]
#[frame(e: rotate(r))]
#[frame(f: rotate_w(x))]
#[frame(g2: x + y)]
#[frame(h: rotate_z(x, y))]
#[frame(i2: rotate_z(x_dot))]
#[frame(j: rotate([0, 0, 0], x))]
#[frame(chain[k in 0..3]: rotate_z(x))]
#[frame(inside: translate(velocity(a)))]
#[frame(q: rotate_x(y))]
#[lagrangian(x_dot^2 + y_dot^2 + dot(q_dot, q_dot) + dot(r_dot, r_dot))]
struct System;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[define(stretched = rot_z(x)*[[1, 0, 0], [0, 1, 0], [0, 0, 2]])]
#[frame(a: rotate(field))]
#[frame(b: rotate(stretched))]
#[frame(mirrored: rotate([[1, 0, 0], [0, 1, 0], [0, 0, -1]]))]
#[frame(good: rotate(turn*rot_x(y)))]
#[parameter(turn: rotation)]
#[lagrangian(kinetic(a, m, [1, 0, 0]) + kinetic(b, m) + kinetic(mirrored, m) + kinetic(good, m))]
struct NoRotations { m: f64, field: Matrix3<f64>, turn: Matrix3<f64> }

fn main() {}
