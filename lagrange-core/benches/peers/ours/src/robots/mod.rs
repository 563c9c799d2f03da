//! Bodies in space, each stated as a user would.

mod humanoid;
mod loops;
mod quantities;

pub use humanoid::Humanoid;
use lagrange_core::{
    nalgebra::{Matrix3, Rotation3, Vector3},
    prelude::*,
};
pub use loops::{FourBar, Stewart};

/// n revolute joints about axes placed arbitrarily, one after another.
macro_rules! arm {
    ($name:ident, $n:literal) => {
        #[derive(Lagrangian)]
        #[coordinates(q: [$n])]
        #[parameter(inertia: symmetric)]
        #[frame(link[0]: translate(at[0]), rotate(place[0]), rotate_z(q[0]))]
        #[frame(link[i in 1..$n] in link[i-1]: translate(at[i]), rotate(place[i]), rotate_z(q[i]))]
        #[lagrangian(sum(i in 0..$n,
                    kinetic(link[i], m[i], centre[i], inertia[i]) - m[i]*g*position(link[i], centre[i])[2]))]
        #[force(q: tau)]
        #[repr(C)]
        pub struct $name {
            place: [Rotation3<f64>; $n],
            at: [Vector3<f64>; $n],
            centre: [Vector3<f64>; $n],
            inertia: [Matrix3<f64>; $n],
            m: [f64; $n],
            g: f64,
            tau: [f64; $n],
        }
    };
}

arm!(Arm6, 6);
arm!(Arm20, 20);

/// An arm whose joints are placed by Denavit and Hartenberg's rules.
#[derive(Lagrangian)]
#[coordinates(q: [6])]
#[parameter(inertia: symmetric)]
#[frame(link[0]: rotate_x(alpha[0]), translate([a[0], 0, d[0]]), rotate_z(q[0]))]
#[frame(link[i in 1..6] in link[i-1]: rotate_x(alpha[i]), translate([a[i], 0, d[i]]), rotate_z(q[i]))]
#[lagrangian(sum(i in 0..6,
    kinetic(link[i], m[i], centre[i], inertia[i]) - m[i]*g*position(link[i], centre[i])[2]))]
#[force(q: tau)]
#[repr(C)]
pub struct Denavit6 {
    alpha: [f64; 6],
    a: [f64; 6],
    d: [f64; 6],
    centre: [Vector3<f64>; 6],
    inertia: [Matrix3<f64>; 6],
    m: [f64; 6],
    g: f64,
    tau: [f64; 6],
}

/// A body on four legs of three joints, turned in space by so many coordinates in these steps.
macro_rules! quadruped {
    ($name:ident, $turns:literal, $($step:tt)*) => {
        #[derive(Lagrangian)]
        #[coordinates(r: [3], turn: [$turns], q: [12])]
        #[parameter(inertia: symmetric)]
        #[frame(body: translate(r), $($step)*)]
        #[frame(hip[k in 0..4] in body: translate(at[3*k]), rotate_x(q[3*k]))]
        #[frame(thigh[k in 0..4] in hip[k]: translate(at[3*k+1]), rotate_y(q[3*k+1]))]
        #[frame(shank[k in 0..4] in thigh[k]: translate(at[3*k+2]), rotate_y(q[3*k+2]))]
        #[define(T = kinetic(body, m[0], centre[0], inertia[0]) + sum(k in 0..4,
            kinetic(hip[k], m[3*k+1], centre[3*k+1], inertia[3*k+1])
            + kinetic(thigh[k], m[3*k+2], centre[3*k+2], inertia[3*k+2])
            + kinetic(shank[k], m[3*k+3], centre[3*k+3], inertia[3*k+3])))]
        #[define(U = m[0]*g*position(body, centre[0])[2] + sum(k in 0..4,
            m[3*k+1]*g*position(hip[k], centre[3*k+1])[2]
            + m[3*k+2]*g*position(thigh[k], centre[3*k+2])[2]
            + m[3*k+3]*g*position(shank[k], centre[3*k+3])[2]))]
        #[lagrangian(T - U)]
        #[force(q: tau)]
        #[repr(C)]
        pub struct $name {
            at: [Vector3<f64>; 12],
            centre: [Vector3<f64>; 13],
            inertia: [Matrix3<f64>; 13],
            m: [f64; 13],
            g: f64,
            tau: [f64; 12],
        }
    };
}

quadruped!(Quadruped, 4, rotate(turn));
quadruped!(QuadrupedAngles, 3, rotate_z(turn[0]), rotate_y(turn[1]), rotate_x(turn[2]));
