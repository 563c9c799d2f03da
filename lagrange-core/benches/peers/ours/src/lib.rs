//! The emitted `accelerations` behind the signature that every implementation in the comparison has:
//!
//! ```c
//! void f(const double *q, const double *v, const double *p, double *accelerations, double *multipliers);
//! ```
//!
//! The parameters p are m[0..n], l[0..n], g, in the order of the structs' fields.

mod lanes;
mod systems;

use lagrange_core::prelude::*;
use systems::*;

/// Accelerations and multipliers of the system that `p` points to; its result is how well it could be solved.
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
) -> f64
where
    L: Lagrangian<N, M, Scalar = f64>,
{
    unsafe {
        let state = State::new(*q.cast::<[f64; N]>(), *v.cast::<[f64; N]>());
        let solution = (*p.cast::<L>()).accelerations(&state);
        *a.cast::<[f64; N]>() = solution.accelerations.into();
        *lambda.cast::<[f64; M]>() = solution.multipliers.into();
        solution.pivot
    }
}

/// Two functions for a system: with the results that the other tools have too, and with the pivot after the
/// multipliers, which an integrator looks at.
macro_rules! export {
    ($($name:ident $with_pivot:ident: $system:ident, $n:literal, $m:literal;)*) => {
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
                unsafe { evaluate::<$system, $n, $m>(q, v, p, a, lambda) };
            }

            /// # Safety
            /// See `evaluate`; `lambda` points to M + 1 numbers.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $with_pivot(
                q: *const f64,
                v: *const f64,
                p: *const f64,
                a: *mut f64,
                lambda: *mut f64,
            ) {
                unsafe { *lambda.add($m) = evaluate::<$system, $n, $m>(q, v, p, a, lambda) }
            }
        )*
    };
}

export! {
    planar_2 planar_2_pivot: Planar2, 2, 0;
    planar_3 planar_3_pivot: Planar3, 3, 0;
    planar_5 planar_5_pivot: Planar5, 5, 0;
    planar_8 planar_8_pivot: Planar8, 8, 0;
    planar_10 planar_10_pivot: Planar10, 10, 0;
    planar_20 planar_20_pivot: Planar20, 20, 0;
    chain_5 chain_5_pivot: Chain5, 10, 5;
    chain_10 chain_10_pivot: Chain10, 20, 10;
    chain_20 chain_20_pivot: Chain20, 40, 20;
    chain_50 chain_50_pivot: Chain50, 100, 50;
    spherical_1 spherical_1_pivot: Spherical, 3, 1;
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
