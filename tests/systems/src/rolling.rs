//! Bodies that roll and slide under constraints on velocities.

use lagrange_core::prelude::*;

/// Chaplygin's sleigh: a blade at (x, y), with the centre of mass at the distance `a` before it.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(velocity = der([x + a*cos(theta), y + a*sin(theta)]))]
#[lagrangian(m/2*dot(velocity, velocity) + inertia/2*theta_dot^2)]
#[constraint(blade: y_dot*cos(theta) - x_dot*sin(theta) = 0)]
pub struct ChaplyginSleigh<T> {
    pub m: T,
    pub a: T,
    pub inertia: T,
}

/// Knife edge on an incline, where `g` is the part of gravity along x.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y, theta)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + inertia/2*theta_dot^2 + m*g*x)]
#[constraint(edge: x_dot*sin(theta) - y_dot*cos(theta) = 0)]
pub struct KnifeEdge<T> {
    pub m: T,
    pub inertia: T,
    pub g: T,
}

/// Nonholonomic free particle.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((x_dot^2 + y_dot^2 + z_dot^2)/2)]
#[constraint(tied: z_dot - y*x_dot = 0)]
pub struct TiedParticle;

/// Solid ball that rolls on a turntable, in Euler angles about z, x and z.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(x, y, ph, th, ps)]
#[define(inertia = 2/5 * m * a^2)]
#[define(spin = inertia/2 * (ph_dot^2 + th_dot^2 + ps_dot^2 + 2*ph_dot*ps_dot*cos(th)))]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + spin)]
#[define(wx = th_dot*cos(ph) + ps_dot*sin(th)*sin(ph))]
#[define(wy = th_dot*sin(ph) - ps_dot*sin(th)*cos(ph))]
#[constraint(along: x_dot - a*wy + turn*y = 0)]
#[constraint(across: y_dot + a*wx - turn*x = 0)]
#[observable(angular_velocity = [wx, wy, ph_dot + ps_dot*cos(th)])]
pub struct BallInAngles<T> {
    pub m: T,
    pub a: T,
    pub turn: T,
}
