use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [3], x)]
#[function(U(r) = potential)]
#[function(A(s: [2], w): [3] = field)]
#[lagrangian(dot(r_dot, r_dot)/2 + x_dot^2/2 - U(x) - U([x, x]) - dot(A(r, x), r) - dot(A([x, x], r), r) - A([x, x], x))]
struct System<F: Function<3, 1>, G: Function<3, 3>> {
    potential: F,
    field: G,
}

fn main() {}
