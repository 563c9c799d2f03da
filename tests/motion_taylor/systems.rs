//! What a series has to go through: forces, dissipation, explicit time, every kind of constraint, frames, loops.

use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;

use super::{difference, end};

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian((1 + y^2)*x_dot^2/2 + (x_dot*y_dot)*sin(z) + 2*y_dot^2 + (1 + x^2)*z_dot^2 + a*x_dot*y - x^2/2 - cos(z + t))]
#[dissipation(c*(x_dot^2 + z_dot^2)/2 + c*(x_dot^2 + y_dot^2)^2/40)]
#[force(x: sin(2*t))]
#[constraint(moving: y_dot - x*z_dot = cos(t)/3)]
struct Rich {
    a: f64,
    c: f64,
}

/// Mass that moves, gyroscopic terms, cubic drag, a nonholonomic constraint that depends on time and is affine.
#[test]
fn everything_at_once() -> Result<(), Error> {
    let system = Rich { a: 0.7, c: 0.3 };
    let start = State::new([0.3, -0.2, 0.5], [0.4, 1.0 / 3.0 + 0.3 * 0.6, 0.6]);
    assert!(difference(&system, start, 3.0)? < 1e-12);
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m*(x_dot^2 + y_dot^2)/2 - m*g*y)]
#[constraint(hoop: (x - sin(3*t)/5)^2 + y^2 = r^2)]
struct Shaken {
    m: f64,
    g: f64,
    r: f64,
}

#[test]
fn a_hoop_that_is_shaken() -> Result<(), Error> {
    let start = State::new([1.0, 0.0], [0.6, 0.0]);
    assert!(difference(&Shaken { m: 2.0, g: 9.81, r: 1.0 }, start, 2.0)? < 1e-11);
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[frame(body: translate(r), rotate(q))]
#[frame(rotor in body: translate([0.2, 0, 0.1]), rotate_z(5*t))]
#[lagrangian(kinetic(body, m, centre, inertia) + kinetic(rotor, m/2, centre, inertia) - m*g*position(body, centre)[2])]
#[power(-c*velocity(body, centre), velocity(body, centre))]
struct Gyrostat {
    m: f64,
    g: f64,
    c: f64,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
}

/// Frames, a quaternion with the constraint that comes with it, a motion that is prescribed, a force at a point.
#[test]
fn a_gyrostat_in_frames() -> Result<(), Error> {
    let inertia = Matrix3::new(1.0, 0.1, 0.0, 0.1, 2.0, 0.2, 0.0, 0.2, 2.5);
    let system = Gyrostat { m: 1.5, g: 9.81, c: 0.2, centre: Vector3::new(0.1, 0.2, -0.3), inertia };
    let start = State::new([0.1, 0.2, 0.3, 1.0, 0.0, 0.0, 0.0], [0.5, -0.4, 1.0, 0.0, 0.3, 1.2, -0.5]);
    assert!(difference(&system, start, 2.0)? < 1e-11);
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(theta: [12])]
#[define(vx[0] = l*cos(theta[0])*theta_dot[0])]
#[define(vx[i in 1..12] = vx[i-1] + l*cos(theta[i])*theta_dot[i])]
#[define(y[0] = -l*cos(theta[0]))]
#[define(y[i in 1..12] = y[i-1] - l*cos(theta[i]))]
#[lagrangian(sum(i in 0..12, m/2*(vx[i]^2 + der(y[i])^2) - m*g*y[i]))]
struct Chain {
    l: f64,
    m: f64,
    g: f64,
}

#[test]
fn a_chain_keeps_its_energy() -> Result<(), Error> {
    let chain = Chain { l: 0.2, m: 0.5, g: 9.81 };
    let start = State::at_rest([1.2; 12]);
    let state = end(&chain, start, 3.0)?;
    let (before, after) = (chain.energy(&start), chain.energy(&state));
    assert!((after - before).abs() < 1e-13 * 12.0 * 9.81, "{:e}", after - before);
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(x, y, z)]
#[lagrangian(m*(x_dot^2 + y_dot^2 + z_dot^2)/2 - m*g*z)]
#[constraint(track: k[0]*(y - sin(x)) = 0)]
#[constraint(plane: k[1]*(z - y) = 0)]
#[constraint(both: k[2]*(z - sin(x)) = 0)]
struct Twice {
    m: f64,
    g: f64,
    /// Were one of them zero, the other constraints would be needed.
    k: [f64; 3],
}

/// Three constraints of which any two are enough.
#[test]
fn a_constraint_too_many() -> Result<(), Error> {
    let system = Twice { m: 1.0, g: 9.81, k: [1.0; 3] };
    let (x, v) = (0.6_f64, 0.4);
    let start = State::new([x, x.sin(), x.sin()], [v, v * x.cos(), v * x.cos()]);
    assert!(difference(&system, start, 3.0)? < 1e-11);
    let state = end(&system, start, 3.0)?;
    assert!((system.energy(&state) - system.energy(&start)).abs() < 1e-13);
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(x, y, s)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - 9.81*y)]
#[constraint(track: y = x^2/2 + s)]
#[constraint(lift: s = sin(t)/4)]
struct Massless;

/// A coordinate without mass, which the constraints determine.
#[test]
fn a_track_that_is_lifted() -> Result<(), Error> {
    let start = State::new([0.5, 0.125, 0.0], [0.3, 0.15 + 0.25, 0.25]);
    assert!(difference(&Massless, start, 2.0)? < 1e-11);
    Ok(())
}
