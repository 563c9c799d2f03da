use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[parameter(a: symmetric)]
#[parameter(a: rotation)]
#[parameter(b: symmetric)]
#[parameter(c: rotation)]
#[parameter(k: symmetric)]
#[parameter(e: symmetric)]
#[parameter(f: symmetric)]
#[parameter(g: rotation)]
#[lagrangian(dot(r_dot, a*r_dot)/2 + dot(b, c*r) + dot(r, d*r) + k)]
struct System {
    a: [[f64; 3]; 3],
    b: [f64; 3],
    c: [[f64; 3]; 2],
    d: [[f64; 3]; 3],
    k: f64,
    f: lagrange_core::nalgebra::Rotation3<f64>,
    g: [lagrange_core::nalgebra::UnitQuaternion<f64>; 4],
}

fn main() {}
