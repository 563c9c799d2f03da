//! Frames, prescribed motions, a long chain, and a coordinate without mass.

use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;
use lagrange_systems::ShakenPendulum;

use super::{difference, end};

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

#[test]
fn a_hoop_that_is_shaken() -> Result<(), Error> {
    let start = State::new([1.0, 0.0], [0.6, 0.0]);
    assert!(difference(&ShakenPendulum { m: 2.0, g: 9.81, l: 1.0, a: 0.2, w: 3.0 }, start, 2.0)? < 1e-11);
    Ok(())
}
