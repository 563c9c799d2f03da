use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(r: [2])]
#[define(a = wide*wide)]
#[define(b = [1, 2, 3]*wide)]
#[define(c = square*wide*square)]
#[define(d = square^2)]
#[define(e = square^T)]
#[define(f = [square, square]*r)]
#[define(g = square/square)]
#[define(h = square + wide)]
#[define(i = [[1, 2], [3, 4, 5]])]
#[lagrangian(dot(r_dot, r_dot)/2)]
#[observable(whole = [square, square])]
struct System {
    wide: [[f64; 3]; 2],
    square: [[f64; 2]; 2],
}

fn main() {}
