use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, r: [3])]
#[frame(a: rotate_z(x))]
#[frame(b: rotate_x(x))]
#[lagrangian(x_dot^2 + dot(r_dot, r_dot))]
#[power(f, r_dot)]
#[power([f, 0], r_dot)]
#[power(f, x)]
#[power(f, x_dot^2)]
#[power(vector(a, [f, 0, 0]), velocity(b))]
#[power(f*x_ddot, x_dot)]
#[power([r, r], [r_dot, r_dot])]
struct System {
    f: f64,
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2)]
#[power(f)]
struct Alone {
    f: f64,
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2)]
#[power(f, x_dot, x)]
struct Third {
    f: f64,
}

fn main() {}
