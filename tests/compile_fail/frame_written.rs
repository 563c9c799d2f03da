use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[frame(a in: rotate_z(x))]
#[lagrangian(x_dot^2)]
struct Unparented;

#[derive(Lagrangian)]
#[coordinates(x)]
#[frame(a)]
#[lagrangian(x_dot^2)]
struct Alone;

#[derive(Lagrangian)]
#[coordinates(x)]
#[frame(a:)]
#[lagrangian(x_dot^2)]
struct Empty;

#[derive(Lagrangian)]
#[coordinates(x)]
#[frame(a = rotate_z(x))]
#[lagrangian(x_dot^2)]
struct Equal;

#[derive(Lagrangian)]
#[coordinates(x)]
#[frame(a: rotate_z(x) translate([1,0,0]))]
#[lagrangian(x_dot^2)]
struct Unseparated;

#[derive(Lagrangian)]
#[coordinates(x)]
#[frame(x: rotate_z(x))]
#[lagrangian(x_dot^2)]
struct Taken;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(kinetic(body, m))]
struct Undeclared { m: f64 }

#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[frame(body: rotate(q))]
#[lagrangian(kinetic(body, m, c, inertia))]
#[constraint(q: q[0] = 1)]
struct Unit { m: f64, c: Vector3<f64>, inertia: Matrix3<f64> }
fn main() {}
