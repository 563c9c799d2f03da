//! Three bodies under gravity: the forces ∂L/∂q and the energy q̇·∂L/∂q̇ − L.

use nalgebra::SVector;
use num_dual::{Dual64, gradient};

use crate::Number;

/// m[0..3], the constant of gravitation.
#[repr(C)]
struct Parameters {
    m: [f64; 3],
    gamma: f64,
}

impl Parameters {
    fn lagrangian<D: Number>(&self, q: impl Fn(usize) -> D, v: impl Fn(usize) -> D) -> D {
        let square = |i| (0..3).map(|k| v(3 * i + k) * v(3 * i + k)).sum::<D>();
        let kinetic = (0..3).map(|i| square(i) * (self.m[i] / 2.0)).sum::<D>();
        let pairs = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| {
            let distance = (0..3).map(|k| (q(3 * i + k) - q(3 * j + k)).powi(2)).sum::<D>().sqrt();
            distance.recip() * (self.gamma * self.m[i] * self.m[j])
        });
        kinetic + pairs.into_iter().sum::<D>()
    }
}

/// # Safety
/// `q`, `v` and `forces` point to 9 numbers, `p` to 4, `energy` to one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn bodies(
    q: *const [f64; 9],
    v: *const [f64; 9],
    p: *const f64,
    forces: *mut [f64; 9],
    energy: *mut f64,
) {
    let (p, q, v) = unsafe { (&*p.cast::<Parameters>(), &*q, &*v) };
    let velocity = SVector::from(*v);
    let (_, by_coordinates) =
        gradient(|q| p.lagrangian(|i| q[i], |i| velocity[i].into()), &SVector::from(*q));
    let along = p.lagrangian(|i| Dual64::from(q[i]), |i| Dual64::new(v[i], v[i]));
    unsafe {
        *forces = by_coordinates.into();
        *energy = along.eps - along.re;
    }
}
