use lagrange_core::prelude::*;

/// The type of most fields is taken for the one that is meant, wherever the other stands.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k/2 * x^2 - c*x)]
struct System {
    m: f32,
    k: f64,
    c: f64,
}

fn main() {}
