//! The emitted `accelerations_unchecked` behind the signature that every implementation in the comparison has:
//!
//! ```c
//! void f(const double *q, const double *v, const double *p, double *accelerations, double *multipliers);
//! ```
//!
//! The parameters p are in the order of the structs' fields: m[0..n], l[0..n], g, but for bodies in space.
//!
//! Each system is evaluated in one place, where the compiler takes the emitted function apart and leaves out what is
//! not used. With the feature `call` it stays a function that gives the whole [`Solution`], as in a larger program.

mod lanes;
#[cfg(feature = "robots")]
mod robots;
mod systems;

use lagrange_core::{Solution, nalgebra::Const, prelude::*};
#[cfg(feature = "robots")]
use robots::*;
use systems::*;

#[cfg_attr(feature = "call", inline(never))]
#[cfg_attr(not(feature = "call"), inline(always))]
fn solution<L, const N: usize, const M: usize>(system: &L, state: &State<f64, N>) -> Solution<f64, N, M>
where
    L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    system.accelerations_unchecked(state)
}

/// Accelerations and multipliers of the system that `p` points to.
///
/// # Safety
/// `q`, `v` and `a` point to N numbers, `lambda` to M, and `p` to an `L`, which is `repr(C)` and made of `f64`.
#[inline(always)]
unsafe fn evaluate<L, const N: usize, const M: usize>(
    q: *const f64,
    v: *const f64,
    p: *const f64,
    a: *mut f64,
    lambda: *mut f64,
) where
    L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    unsafe {
        let state = State::new(*q.cast::<[f64; N]>(), *v.cast::<[f64; N]>());
        let solution = solution(&*p.cast::<L>(), &state);
        *a.cast::<[f64; N]>() = solution.accelerations.into();
        *lambda.cast::<[f64; M]>() = solution.multipliers.into();
    }
}

macro_rules! export {
    ($($name:ident: $system:ident, $n:literal, $m:literal;)*) => {
        $(
            /// # Safety
            /// See `evaluate`.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                q: *const f64,
                v: *const f64,
                p: *const f64,
                a: *mut f64,
                lambda: *mut f64,
            ) {
                unsafe { evaluate::<$system, $n, $m>(q, v, p, a, lambda) }
            }
        )*
    };
}

export! {
    planar_2: Planar2, 2, 0;
    planar_3: Planar3, 3, 0;
    planar_5: Planar5, 5, 0;
    planar_8: Planar8, 8, 0;
    planar_10: Planar10, 10, 0;
    planar_20: Planar20, 20, 0;
    chain_5: Chain5, 10, 5;
    chain_10: Chain10, 20, 10;
    chain_20: Chain20, 40, 20;
    chain_50: Chain50, 100, 50;
    spherical_1: Spherical, 3, 1;
}

#[cfg(feature = "robots")]
export! {
    arm_6: Arm6, 6, 0;
    arm_20: Arm20, 20, 0;
    denavit_6: Denavit6, 6, 0;
    quadruped_0: Quadruped, 19, 1;
    quadruped_angles_0: QuadrupedAngles, 18, 0;
    humanoid_0: Humanoid, 37, 1;
    four_bar_0: FourBar, 5, 3;
    stewart_0: Stewart, 25, 19;
}

/// The forces ∂L/∂q of three bodies, and their energy.
///
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
    unsafe {
        let (state, system) = (State::new(*q, *v), &*p.cast::<Bodies>());
        *forces = system.momentum_rate(&state).into();
        *energy = system.energy(&state);
    }
}
