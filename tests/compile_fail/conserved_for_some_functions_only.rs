use lagrange_core::prelude::*;

/// For a function of x² + y² it would be.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[function(U(x, y) = field)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - U(x, y))]
#[conserved(rotation = m*(x*y_dot - y*x_dot))]
struct System<F> {
    m: f64,
    field: F,
}

fn main() {}
