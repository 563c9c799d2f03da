use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [4, 3], x)]
#[lagrangian(x_dot^2/2 + dot(r_dot[0], r_dot[1]) + dot(r, r) + r[4][0] + r[0][3] + r[1] + x[0] + r[2][1][0] + r_dot[1.5][0])]
#[force(r[4]: [0, 0, 1])]
#[force(r[1]: 1)]
#[force(r[1][2]: [0, 0, 1])]
#[force(r[0][0][0]: 1)]
#[force(x[0]: 1)]
#[force(r: [1, 2, 3])]
#[force(r[i in 0..5]: r[i])]
#[constraint(rod[i in 0..4]: norm(r[i+1] - r[i]) = 1)]
struct Indices;

#[derive(Lagrangian)]
#[coordinates(r: [4, 0])]
#[lagrangian(0)]
struct Empty;

#[derive(Lagrangian)]
#[coordinates(r: [4, N])]
#[lagrangian(0)]
struct Generic<const N: usize>;

#[derive(Lagrangian)]
#[coordinates(r: [40, 40])]
#[lagrangian(0)]
struct Many;

#[derive(Lagrangian)]
#[coordinates(r: [2, 3])]
#[function(U(r))]
#[lagrangian(sum(i in 0..2, dot(r_dot[i], r_dot[i])) - U(r[0]))]
struct Argument<F> {
    U: F,
}

fn main() {}
