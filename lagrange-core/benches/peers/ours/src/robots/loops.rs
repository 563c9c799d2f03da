//! Bodies that joints of balls close to loops.

use lagrange_core::{
    nalgebra::{Matrix3, Rotation3, Vector3},
    prelude::*,
};

/// Crank, coupler and rocker, whose axes stand anyhow.
#[derive(Lagrangian)]
#[coordinates(a, b: [3], c)]
#[parameter(i1: symmetric)]
#[parameter(i2: symmetric)]
#[parameter(i3: symmetric)]
#[frame(crank: rotate(p1), rotate_z(a))]
#[frame(coupler in crank: translate(l1), rotate_z(b[0]), rotate_y(b[1]), rotate_x(b[2]))]
#[frame(rocker: translate(l3), rotate(p3), rotate_z(c))]
#[lagrangian(kinetic(crank, m1, c1, i1) + kinetic(coupler, m2, c2, i2) + kinetic(rocker, m3, c3, i3)
    - g*(m1*position(crank, c1)[2] + m2*position(coupler, c2)[2] + m3*position(rocker, c3)[2]))]
#[constraint(ball: position(coupler, l2) = position(rocker, l4))]
#[force(a: torque)]
#[repr(C)]
pub struct FourBar {
    p1: Rotation3<f64>,
    p3: Rotation3<f64>,
    l1: Vector3<f64>,
    l2: Vector3<f64>,
    l3: Vector3<f64>,
    l4: Vector3<f64>,
    m1: f64,
    c1: Vector3<f64>,
    i1: Matrix3<f64>,
    m2: f64,
    c2: Vector3<f64>,
    i2: Matrix3<f64>,
    m3: f64,
    c3: Vector3<f64>,
    i3: Matrix3<f64>,
    g: f64,
    torque: f64,
}

/// A plate on six legs, each a cylinder on a universal joint with a piston in it.
#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4], yaw: [6], pitch: [6], s: [6])]
#[parameter(inertia: symmetric)]
#[parameter(i1: symmetric)]
#[parameter(i2: symmetric)]
#[frame(plate: translate(r), rotate(q))]
#[frame(cylinder[k in 0..6]: translate(base[k]), rotate_x(yaw[k]), rotate_y(pitch[k]))]
#[frame(piston[k in 0..6] in cylinder[k]: translate([0, 0, s[k]]))]
#[lagrangian(kinetic(plate, m, centre, inertia) - m*g*position(plate, centre)[2]
    + sum(k in 0..6, kinetic(cylinder[k], m1, c1, i1) + kinetic(piston[k], m2, c2, i2)
    - g*(m1*position(cylinder[k], c1)[2] + m2*position(piston[k], c2)[2])))]
#[constraint(ball[k in 0..6]: position(piston[k]) = position(plate, anchor[k]))]
#[force(s: push)]
#[repr(C)]
pub struct Stewart {
    m: f64,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
    base: [Vector3<f64>; 6],
    anchor: [Vector3<f64>; 6],
    m1: f64,
    c1: Vector3<f64>,
    i1: Matrix3<f64>,
    m2: f64,
    c2: Vector3<f64>,
    i2: Matrix3<f64>,
    g: f64,
    push: [f64; 6],
}
