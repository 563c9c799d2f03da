use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(y: [3])]
#[lagrangian(dot(y_dot, y_dot)/2)]
#[observable(late[i in 1..3] = y[i])]
#[observable(beyond[i in 0..4] = y[i])]
#[observable(height[0] = y[0])]
#[observable(height[1] = y[1])]
#[observable(deep[i in 0..2, j in 0..2] = y)]
#[observable(whole = [[[y[0], 1]], [[1, 2]]])]
#[conserved(speed[i in 0..3] = y[i])]
#[power(i in 0..4, y[i], y_dot[i])]
struct Families;

#[derive(Lagrangian)]
#[coordinates(y: [3])]
#[lagrangian(dot(y_dot, y_dot)/2)]
#[power(j in 0..2 y[j], y_dot[j])]
#[power(k in 0..2, y[0])]
struct Powers;

fn main() {}
