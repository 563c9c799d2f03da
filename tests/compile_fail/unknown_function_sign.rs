use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2)]
#[force(x: -c*sign(x_dot))]
struct Block {
    m: f64,
    c: f64,
}

#[derive(Lagrangian)]
#[coordinates(q: [4])]
#[frame(body: rotate(q))]
#[lagrangian(kinetic(body, m, [0, 0, 0], j*identity(3)))]
#[power([0, 0, torque], omega(body))]
struct Wheel {
    m: f64,
    j: f64,
    torque: f64,
}

fn main() {}
