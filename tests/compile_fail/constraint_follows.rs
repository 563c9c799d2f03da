use lagrange_core::prelude::*;

/// The velocity of what the first one says.
#[derive(Lagrangian)]
#[coordinates(x, phi)]
#[lagrangian(m/2*x_dot^2 + m*a^2/4*phi_dot^2 - m*g*x)]
#[constraint(c1: x - a*phi = 0)]
#[constraint(c2: x_dot - a*phi_dot = 0)]
struct Rolling {
    m: f64,
    a: f64,
    g: f64,
}

/// The sum of two others.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2 + z_dot^2))]
#[constraint(first: x = sin(y))]
#[constraint(second: z = y^2)]
#[constraint(both: x + z = sin(y) + y^2)]
struct Sum {
    m: f64,
}

/// One component of a vector equation, beside what says the same of the position.
#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[define(w = quat_rate(q, q_dot))]
#[lagrangian(m/2*dot(r_dot, r_dot) + m*a^2/5*dot(w, w))]
#[constraint(unit: dot(q, q) = 1)]
#[constraint(table: r[2] = a)]
#[constraint(rolling: r_dot = a*cross(w, [0, 0, 1]))]
struct Ball {
    m: f64,
    a: f64,
}

/// With coefficients that depend on the position.
#[derive(Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*a^2/2*theta_dot^2)]
#[constraint(along: x_dot*cos(theta) + y_dot*sin(theta) = v)]
#[constraint(across: y_dot*cos(theta) - x_dot*sin(theta) = 0)]
#[constraint(east: x_dot = v*cos(theta))]
struct Knife {
    m: f64,
    a: f64,
    v: f64,
}

fn main() {}
