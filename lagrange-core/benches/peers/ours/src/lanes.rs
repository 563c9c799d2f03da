//! Eight double pendulums, each number an array of eight: one after another, and on SIMD lanes.

use lagrange_core::Lanes;
use lagrange_core::prelude::*;

/// The double pendulum, for any number type.
#[derive(Lagrangian)]
#[coordinates(theta: [2])]
#[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
#[define(vx[1] = vx[0] + l[1]*cos(theta[1])*theta_dot[1])]
#[define(vy[0] = l[0]*sin(theta[0])*theta_dot[0])]
#[define(vy[1] = vy[0] + l[1]*sin(theta[1])*theta_dot[1])]
#[define(y[0] = -l[0]*cos(theta[0]))]
#[define(y[1] = y[0] - l[1]*cos(theta[1]))]
#[lagrangian(sum(i in 0..2, m[i]/2*(vx[i]^2 + vy[i]^2) - m[i]*g*y[i]))]
struct DoublePendulum<T> {
    m: [T; 2],
    l: [T; 2],
    g: T,
}

/// The number of systems side by side.
const SYSTEMS: usize = 8;

/// Numbers of one or of several systems, taken from arrays of eight.
trait Numbers: Scalar {
    const WIDTH: usize;

    /// # Safety
    /// `source` points to `WIDTH` numbers.
    unsafe fn load(source: *const f64) -> Self;

    /// # Safety
    /// `target` points to `WIDTH` numbers.
    unsafe fn store(self, target: *mut f64);
}

impl Numbers for f64 {
    const WIDTH: usize = 1;

    #[inline(always)]
    unsafe fn load(source: *const Self) -> Self {
        unsafe { *source }
    }

    #[inline(always)]
    unsafe fn store(self, target: *mut Self) {
        unsafe { *target = self }
    }
}

impl Numbers for Lanes {
    const WIDTH: usize = Self::COUNT;

    #[inline(always)]
    unsafe fn load(source: *const f64) -> Self {
        Self::from(unsafe { *source.cast::<[f64; Self::COUNT]>() })
    }

    #[inline(always)]
    unsafe fn store(self, target: *mut f64) {
        unsafe { *target.cast::<[f64; Self::COUNT]>() = self.to_array() }
    }
}

#[inline(always)]
unsafe fn evaluate<T: Numbers>(q: *const f64, v: *const f64, p: *const f64, a: *mut f64) {
    for first in (0..SYSTEMS).step_by(T::WIDTH) {
        let read = |from: *const f64, entry: usize| unsafe { T::load(from.add(SYSTEMS * entry + first)) };
        let (m, l, g) = ([read(p, 0), read(p, 1)], [read(p, 2), read(p, 3)], read(p, 4));
        let state = State::new([read(q, 0), read(q, 1)], [read(v, 0), read(v, 1)]);
        let solution = DoublePendulum { m, l, g }.accelerations_unchecked(&state);
        for entry in 0..2 {
            unsafe { solution.accelerations[entry].store(a.add(SYSTEMS * entry + first)) };
        }
    }
}

/// # Safety
/// `q`, `v` and `a` point to 2 · 8 numbers, `p` to 5 · 8.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lanes_scalar(q: *const f64, v: *const f64, p: *const f64, a: *mut f64, _: *mut f64) {
    unsafe { evaluate::<f64>(q, v, p, a) }
}

/// # Safety
/// `q`, `v` and `a` point to 2 · 8 numbers, `p` to 5 · 8.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lanes_wide(q: *const f64, v: *const f64, p: *const f64, a: *mut f64, _: *mut f64) {
    unsafe { evaluate::<Lanes>(q, v, p, a) }
}
