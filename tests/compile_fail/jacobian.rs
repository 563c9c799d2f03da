use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[frame(hand: translate([x, y, 0]))]
#[lagrangian(x_dot^2/2 + y_dot^2/2)]
#[force(x: jacobian(velocity(hand))[0][0])]
#[observable(of_place = jacobian(position(hand)))]
#[observable(of_energy = jacobian(x_dot^2))]
#[observable(of_rows = jacobian([[x_dot], [y_dot]]))]
#[observable(of_two = jacobian(hand, x_dot))]
#[observable(outside = jacobian(velocity(hand))[3])]
#[observable(beside = jacobian(velocity(hand))*[1, 2, 3])]
struct System;

fn main() {}
