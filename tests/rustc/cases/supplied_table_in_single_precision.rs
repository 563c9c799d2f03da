use lagrange_core::function::Table;
use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[function(U(x) = potential)]
#[lagrangian(m/2*x_dot^2 - U(x))]
struct System {
    m: f32,
    potential: Table,
}

fn main() {}
