//! Rotating frames: the Hamiltonian, Milton (8.54)–(8.57).

use lagrange_core::nalgebra::Vector3;
use lagrange_core::prelude::*;

use lagrange_random::cases;

use crate::{Potential, Random, agree};

/// An angular velocity that turns and changes its size.
pub(crate) struct Turning;

impl Function<1, 3> for Turning {
    fn eval<S: Scalar>(&self, [t]: [S; 1]) -> [S; 3] {
        let c = S::constant;
        [c(0.3) * t.sin(), c(0.2) * (c(0.7) * t).cos(), c(0.5) + c(0.1) * t.sin()]
    }
}

/// The Lagrangian (8.44) in a frame that does not accelerate.
#[derive(Lagrangian)]
#[coordinates(r: [3])]
#[function(U(r) = potential)]
#[function(Omega(t): [3] = omega)]
#[define(v = r_dot)]
#[define(W = Omega(t))]
#[lagrangian(m/2*dot(v, v) + m/2*dot(cross(W, r), cross(W, r)) + m*dot(v, cross(W, r)) - U(r))]
pub(crate) struct Rotating {
    m: f64,
    potential: Potential,
    omega: Turning,
}

pub(crate) fn rotating() -> Rotating {
    Rotating { m: 1.3, potential: Potential, omega: Turning }
}

fn potential(r: Vector3<f64>) -> f64 {
    Function::eval(&Potential, r.into())[0]
}

/// H = p²/2m − Ω·(r×p) + U, (8.54)–(8.55), ṙ = p/m − Ω×r and ṗ = −Ω×p − ∂U/∂r, (8.56)–(8.57), at any phase point and time.
#[test]
fn hamiltonian_and_equations_8_55_to_8_57() {
    let (system, mut random) = (rotating(), Random(11));
    for _ in 0..cases([100, 1_000, 100_000]) {
        let (t, r, p) = (3.0 * random.number(), random.vector(), random.vector());
        let (phase, force) = (PhaseState::new(r, p).at_time(t), -gradient(r));
        let (r, p, omega) = (Vector3::from(r), Vector3::from(p), Vector3::from(Turning.eval([t])));
        let h = p.dot(&p) / (2.0 * system.m) - omega.dot(&r.cross(&p)) + potential(r);
        agree(&[system.hamiltonian(&phase).unwrap()], &[h], 1e-12);
        let rate = system.hamilton_equations(&phase).unwrap();
        agree(rate.q.as_slice(), (p / system.m - omega.cross(&r)).as_slice(), 1e-12);
        agree(rate.p.as_slice(), (force - omega.cross(&p)).as_slice(), 1e-12);
    }
}

/// ∂U/∂r by hand.
fn gradient([x, y, z]: [f64; 3]) -> Vector3<f64> {
    let (slope, twist) = (0.2 * (x + 0.5 * z).cos(), -0.1 * (y * z).sin());
    Vector3::new(1.4 * x + 0.3 * y + slope, 1.8 * y + 0.3 * x + twist * z, 2.4 * z + 0.5 * slope + twist * y)
}
