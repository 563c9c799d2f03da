use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x, r: [3])]
#[define(stiff = max(x, 0))]
#[lagrangian(x_dot^2 + dot(r_dot, r_dot) - stiff^2)]
#[constraint(stop: clamp(x, 0, 1) = r[0])]
struct Kinks;

#[derive(Lagrangian)]
#[coordinates(x, r: [3])]
#[frame(a: rotate_z(min(x, 1)))]
#[lagrangian(x_dot^2 + dot(r_dot, r_dot))]
#[force(x: max(x))]
#[force(x: max(r, 0))]
#[force(x: clamp(x, 1))]
#[force(x: Max(x, 1))]
#[force(x: min)]
struct Wrong;

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2)]
#[dissipation(max(x_dot, 0)^2)]
struct OneSided;

fn main() {}
