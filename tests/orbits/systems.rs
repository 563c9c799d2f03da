//! Systems of the tests, and the motions that are known of them.

use lagrange_core::prelude::*;

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + 1/sqrt(x^2 + y^2))]
pub(crate) struct Planet;

/// Three equal masses in a plane.
#[derive(Clone, Lagrangian)]
#[coordinates(a: [2], b: [2], c: [2])]
#[lagrangian((dot(a_dot, a_dot) + dot(b_dot, b_dot) + dot(c_dot, c_dot))/2 + 1/norm(a - b) + 1/norm(b - c) + 1/norm(c - a))]
pub(crate) struct ThreeMasses;

/// The figure of eight (Chenciner and Montgomery, *Annals of Mathematics* 152, 2000): start and period by `recompute.py`, of which the
/// first eight digits are those published.
pub(crate) const EIGHT: [f64; 5] = [
    0.970_004_36,
    -0.243_087_538_924_877_45,
    0.466_203_687_306_882_35,
    0.432_365_726_412_457_87,
    6.325_914_030_368_495,
];

pub(crate) fn eight() -> (State<f64, 6>, f64) {
    let [x, y, vx, vy, period] = EIGHT;
    (State::new([x, y, -x, -y, 0.0, 0.0], [vx, vy, vx, vy, -2.0 * vx, -2.0 * vy]), period)
}

/// A small body near Earth and Moon, in the frame that turns with them. Jacobi's constant is −2 times the energy.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, z)]
#[define(r1 = sqrt((x + mu)^2 + y^2 + z^2))]
#[define(r2 = sqrt((x - 1 + mu)^2 + y^2 + z^2))]
#[lagrangian(((x_dot - y)^2 + (y_dot + x)^2 + z_dot^2)/2 + (1 - mu)/r1 + mu/r2)]
pub(crate) struct Moon {
    pub(crate) mu: f64,
}

impl Moon {
    pub(crate) const EARTHS: Self = Self { mu: 0.012_150_585_609_624_04 };
}

/// A pendulum of length 1 with g = 1.
#[derive(Clone, Lagrangian)]
#[coordinates(theta)]
#[lagrangian(theta_dot^2/2 + cos(theta))]
pub(crate) struct Pendulum;

/// Motion of a star in the plane of a galaxy (Hénon and Heiles, *Astronomical Journal* 69, 1964).
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
pub(crate) struct HenonHeiles;
