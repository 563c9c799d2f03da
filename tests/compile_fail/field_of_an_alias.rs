use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;

type Point = Vector3<f64>;

#[derive(Lagrangian)]
#[coordinates(x: [3])]
#[lagrangian(dot(x_dot, x_dot)/2 - k*dot(x, centre))]
struct System {
    k: f64,
    centre: Point,
}

fn main() {}
