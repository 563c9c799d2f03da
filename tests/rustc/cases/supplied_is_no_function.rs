use lagrange_core::prelude::*;

struct Newton {
    k: f64,
}

#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = potential)]
#[function(V(r) = k)]
#[lagrangian(dot(r_dot, r_dot)/2 - U(r) - V(r))]
struct System {
    potential: Newton,
    k: f64,
}

fn main() {}
