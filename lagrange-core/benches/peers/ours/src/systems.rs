//! The systems, each stated as a user would.

use lagrange_core::prelude::*;

/// n links in a plane, their angles from the vertical; each velocity from the one before.
macro_rules! planar {
    ($name:ident, $n:literal) => {
        #[derive(Lagrangian)]
        #[coordinates(theta: [$n])]
        #[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
        #[define(vx[i in 1..$n] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
        #[define(vy[0] = l[0]*sin(theta[0])*theta_dot[0])]
        #[define(vy[i in 1..$n] = vy[i-1] + l[i]*sin(theta[i])*theta_dot[i])]
        #[define(y[0] = -l[0]*cos(theta[0]))]
        #[define(y[i in 1..$n] = y[i-1] - l[i]*cos(theta[i]))]
        #[lagrangian(sum(i in 0..$n, m[i]/2*(vx[i]^2 + vy[i]^2) - m[i]*g*y[i]))]
        #[repr(C)]
        pub struct $name {
            pub m: [f64; $n],
            pub l: [f64; $n],
            pub g: f64,
        }
    };
}

/// n masses in a plane, in Cartesian coordinates, each on a rod to the one before.
macro_rules! chain {
    ($name:ident, $n:literal) => {
        #[derive(Lagrangian)]
        #[coordinates(x: [$n], y: [$n])]
        #[lagrangian(sum(i in 0..$n, m[i]/2*(x_dot[i]^2 + y_dot[i]^2) - m[i]*g*y[i]))]
        #[constraint(rod[0]: (x[0]^2 + y[0]^2 - l[0]^2)/2 = 0)]
        #[constraint(rod[i in 1..$n]: ((x[i]-x[i-1])^2 + (y[i]-y[i-1])^2 - l[i]^2)/2 = 0)]
        #[repr(C)]
        pub struct $name {
            pub m: [f64; $n],
            pub l: [f64; $n],
            pub g: f64,
        }
    };
}

planar!(Planar2, 2);
planar!(Planar3, 3);
planar!(Planar5, 5);
planar!(Planar8, 8);
planar!(Planar10, 10);
planar!(Planar20, 20);
chain!(Chain5, 5);
chain!(Chain10, 10);
chain!(Chain20, 20);
chain!(Chain50, 50);

/// Two links, as Landau and Lifshitz state them (*Mechanics*, § 5, problem 1).
#[derive(Lagrangian)]
#[coordinates(a, b)]
#[lagrangian((m[0] + m[1])/2*l[0]^2*a_dot^2 + m[1]/2*l[1]^2*b_dot^2 + m[1]*l[0]*l[1]*a_dot*b_dot*cos(a - b)
    + (m[0] + m[1])*g*l[0]*cos(a) + m[1]*g*l[1]*cos(b))]
pub struct Double {
    pub m: [f64; 2],
    pub l: [f64; 2],
    pub g: f64,
}

/// A bob on a string.
#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2 + z_dot^2) - m*g*z)]
#[constraint(string: (x^2 + y^2 + z^2 - l^2)/2 = 0)]
#[repr(C)]
pub struct Spherical {
    pub m: f64,
    pub l: f64,
    pub g: f64,
}

/// Three bodies under gravity.
#[derive(Lagrangian)]
#[coordinates(a: [3], b: [3], c: [3])]
#[define(kinetic = m[0]/2*dot(a_dot, a_dot) + m[1]/2*dot(b_dot, b_dot) + m[2]/2*dot(c_dot, c_dot))]
#[lagrangian(kinetic + gamma*m[0]*m[1]/norm(a - b) + gamma*m[0]*m[2]/norm(a - c) + gamma*m[1]*m[2]/norm(b - c))]
#[repr(C)]
pub struct Bodies {
    m: [f64; 3],
    gamma: f64,
}
