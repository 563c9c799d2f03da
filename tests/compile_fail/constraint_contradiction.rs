use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(floor: y = 0)]
#[constraint(shelf: y = h)]
struct Two {
    m: f64,
    h: f64,
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(line: x + y = 1)]
#[constraint(diagonal: x - y = 0)]
#[constraint(wall: x = 3)]
struct Three {
    m: f64,
}

fn main() {}
