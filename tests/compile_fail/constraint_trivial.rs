use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[frame(axle: translate([x, y, 0]))]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(rod: x - x = 0)]
#[constraint(rest: velocity(axle) = 0)]
struct System {
    m: f64,
    l: f64,
}

fn main() {}
