use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[function]
#[function()]
#[function(U)]
#[function(U = potential)]
#[function(U())]
#[function(U(x) = )]
#[function(U(x): 3)]
#[function(U(x): [0])]
#[function(U(x) = self.potential)]
#[function(U(x) = potential(x))]
#[function(U(x, x))]
#[function(U(x: 3))]
#[function(U(2*x))]
#[function(U(x)[3])]
#[function(U[3](x))]
#[function(U(x) = potential, V(x) = potential)]
#[function(U(x) -> [3])]
#[lagrangian(x_dot^2/2)]
struct System<F> {
    potential: F,
}

fn main() {}
