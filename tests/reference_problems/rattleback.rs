//! A rattleback: an ellipsoid whose axes of inertia are turned against those of its shape, rolling on a plane.
//!
//! Parameters and start after T. R. Kane and D. A. Levinson, *Realistic mathematical modeling of the rattleback*,
//! International Journal of Non-Linear Mechanics 17 (1982), 175–186, without friction. The values are recomputed from the
//! equations of Newton and Euler, as the paper shows curves only.

use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;

use crate::reference::{BAR, IS_LONG, Problem, table};

/// Coordinates of the centre of mass, and angles of successive rotations about axes of the body. The centre of the
/// ellipsoid is `h` above the centre of mass along the third axis.
#[derive(Lagrangian)]
#[coordinates(r: [3], alpha, beta, gamma)]
#[frame(body: translate(r), rotate_x(alpha), rotate_y(beta), rotate_z(gamma))]
#[define(up = express(vector(fixed, [0, 0, 1]), body))]
#[define(stretched = [axes[0]^2*up[0], axes[1]^2*up[1], axes[2]^2*up[2]])]
#[define(height = sqrt(up[0]*stretched[0] + up[1]*stretched[1] + up[2]*stretched[2]))]
#[define(contact = vector(body, [-stretched[0]/height, -stretched[1]/height, h - stretched[2]/height]))]
#[lagrangian(kinetic(body, m, [0, 0, 0], inertia) - m*g*r[2])]
#[constraint(rolling: velocity(body) + cross(angular_velocity(body), contact) = 0)]
#[observable(elevation = r[2] + h*up[2] - height)]
struct Rattleback {
    axes: Vector3<f64>,
    h: f64,
    m: f64,
    inertia: Matrix3<f64>,
    g: f64,
}

fn rattleback() -> Rattleback {
    let inertia = Matrix3::new(2.0, -0.2, 0.0, -0.2, 16.0, 0.0, 0.0, 0.0, 17.0) * 1e-4;
    Rattleback { axes: Vector3::new(0.2, 0.03, 0.02), h: 0.01, m: 1.0, inertia, g: 9.81 }
}

/// It slows down, and its spin has reversed by t = 3. λ is the force of the ground along the body's axes.
#[test]
fn rattleback_reverses() {
    let problem = |name| Problem { name, system: rattleback(), known: table!("rattleback") };
    let begins = problem("rattleback, t = 0.5").until(0.5);
    begins.check(&[[1e-12, 1e-12, 1e-12], [1e-10, 1e-10, 1e-10]]);
    if IS_LONG {
        let reverses = problem("rattleback, t = 3");
        let known = &reverses.known;
        assert!(known[0].v[5] == -5.0 && known[known.len() - 1].v[5] > 0.0);
        reverses.check(&[[1e-11, 1e-11, 1e-11], BAR]);
    }
}
