//! The planar pendulum of n links: M = ∂²L/∂q̇², h = ∂L/∂q − ∂²L/∂q̇∂q q̇.

use nalgebra::{SMatrix, SVector};
use num_dual::{HyperDual64, hessian};

use crate::Number;

/// m[0..N], l[0..N], g.
#[repr(C)]
struct Parameters<const N: usize> {
    m: [f64; N],
    l: [f64; N],
    g: f64,
}

impl<const N: usize> Parameters<N> {
    fn lagrangian<D: Number>(&self, q: impl Fn(usize) -> D, v: impl Fn(usize) -> D) -> D {
        let (mut y, mut vx, mut vy, mut lagrangian) = (D::zero(), D::zero(), D::zero(), D::zero());
        for i in 0..N {
            let (sin, cos) = q(i).sin_cos();
            let rate = v(i) * self.l[i];
            y -= cos * self.l[i];
            vx += cos * rate;
            vy += sin * rate;
            lagrangian += (vx * vx + vy * vy) * (self.m[i] / 2.0) - y * (self.m[i] * self.g);
        }
        lagrangian
    }
}

/// One entry of M a time, each by hyper-dual numbers in two directions; Σ_b ∂²L/∂q̇_a∂q_b q̇_b is one direction too.
fn by_entries<const N: usize>(p: &Parameters<N>, q: &[f64; N], v: &[f64; N]) -> Option<SVector<f64, N>> {
    let unit = |i: usize, a: usize| f64::from(u8::from(i == a));
    let mut mass = SMatrix::<f64, N, N>::zeros();
    let mut forcing = SVector::<f64, N>::zeros();
    for a in 0..N {
        for b in 0..=a {
            let velocity = |i| HyperDual64::new(v[i], unit(i, a), unit(i, b), 0.0);
            mass[(a, b)] = p.lagrangian(|i| HyperDual64::from(q[i]), velocity).eps1eps2;
        }
        let along = |i| HyperDual64::new(q[i], 0.0, v[i], 0.0);
        forcing[a] -= p.lagrangian(along, |i| HyperDual64::new(v[i], unit(i, a), 0.0, 0.0)).eps1eps2;
        let coordinate = |i| num_dual::Dual64::new(q[i], unit(i, a));
        forcing[a] += p.lagrangian(coordinate, |i| num_dual::Dual64::from(v[i])).eps;
    }
    Some(mass.cholesky()?.solve(&forcing))
}

macro_rules! planar {
    ($($n:literal $variables:literal $by_entries:ident $at_once:ident),*) => {
        $(
            /// # Safety
            /// `q`, `v` and `a` point to N numbers, `p` to 2N + 1.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $by_entries(
                q: *const [f64; $n],
                v: *const [f64; $n],
                p: *const f64,
                a: *mut [f64; $n],
                _: *mut f64,
            ) {
                let (p, q, v) = unsafe { (&*p.cast::<Parameters<$n>>(), &*q, &*v) };
                let result = by_entries(p, q, v).map_or([f64::NAN; $n], Into::into);
                unsafe { *a = result };
            }

            /// All second derivatives by q and q̇ at once.
            ///
            /// # Safety
            /// `q`, `v` and `a` point to N numbers, `p` to 2N + 1.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $at_once(
                q: *const [f64; $n],
                v: *const [f64; $n],
                p: *const f64,
                a: *mut [f64; $n],
                _: *mut f64,
            ) {
                let (p, q, v) = unsafe { (&*p.cast::<Parameters<$n>>(), &*q, &*v) };
                let point = SVector::<f64, $variables>::from_fn(|i, _| if i < $n { q[i] } else { v[i - $n] });
                let (_, gradient, second) = hessian(|x| p.lagrangian(|i| x[i], |i| x[$n + i]), &point);
                let mass: SMatrix<f64, $n, $n> = second.fixed_view::<$n, $n>($n, $n).into_owned();
                let mixed = second.fixed_view::<$n, $n>($n, 0);
                let forcing = gradient.fixed_rows::<$n>(0) - mixed * SVector::from(*v);
                let result = mass.cholesky().map_or([f64::NAN; $n], |cholesky| cholesky.solve(&forcing).into());
                unsafe { *a = result };
            }
        )*
    };
}

planar!(2 4 planar_entries_2 planar_hessian_2, 5 10 planar_entries_5 planar_hessian_5, 10 20 planar_entries_10 planar_hessian_10);
