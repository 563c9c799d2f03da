use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(a)]
#[frame(body: rotate_x(a))]
#[lagrangian(kinetic(body, m, [0, 0, 0], [[1, 0.2, 0], [0.1, 1, 0], [0, 0, 1]]))]
struct Literal {
    m: f64,
}

/// Through definitions, and with parameters that have no influence on what differs.
#[derive(Lagrangian)]
#[coordinates(a)]
#[define(skewed = [[k, 0, 0], [0, k, 1/3], [0, 0, k]])]
#[frame(body: rotate_x(a))]
#[lagrangian(kinetic(body, m, [0, 0, 0], skewed + k*identity(3)))]
struct Defined {
    m: f64,
    k: f64,
}

/// It moves, so that what differs is zero at one position at most.
#[derive(Lagrangian)]
#[coordinates(a)]
#[frame(body: rotate_x(a))]
#[lagrangian(kinetic(body, m, [0, 0, 0], [[k, 0, a - k], [0, k, 0], [0, 0, k]]))]
struct Moving {
    m: f64,
    k: f64,
}

fn main() {}
