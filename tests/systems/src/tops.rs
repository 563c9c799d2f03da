//! Rigid bodies with a fixed point.

use lagrange_core::prelude::*;

/// Heavy symmetric top in Euler's angles: precession, nutation from the upward vertical, spin. `mgl` is the moment of its weight.
#[derive(Clone, Copy, Debug, Lagrangian)]
#[coordinates(phi, theta, psi)]
#[lagrangian(i1/2*(theta_dot^2 + phi_dot^2*sin(theta)^2) + i3/2*(psi_dot + phi_dot*cos(theta))^2 - mgl*cos(theta))]
pub struct HeavyTop<T> {
    pub i1: T,
    pub i3: T,
    pub mgl: T,
}
