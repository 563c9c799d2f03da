//! One evaluation of the emitted accelerations and multipliers.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p lagrange-benches --bench accelerations`
//!
//! Chains of n links: planar in angles (dense mass matrix), and in Cartesian coordinates with a rod as a constraint
//! each (sparse); the spherical pendulum with its multiplier. Each evaluation is of another of 64 random states.

#[macro_use]
mod rods;

use std::hint::black_box;

use criterion::Criterion;
use lagrange_core::{nalgebra::Const, prelude::*};
use lagrange_systems::SphericalPendulum;

macro_rules! planar {
    ($name:ident, $n:literal) => {
        #[derive(Lagrangian)]
        #[coordinates(theta: [$n])]
        #[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
        #[define(vx[i in 1..$n] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
        #[define(vy[0] = l[0]*sin(theta[0])*theta_dot[0])]
        #[define(vy[i in 1..$n] = vy[i-1] + l[i]*sin(theta[i])*theta_dot[i])]
        #[define(y[0] = -l[0]*cos(theta[0]))]
        #[define(y[i in 1..$n] = y[i-1] - l[i]*cos(theta[i]))]
        #[lagrangian(sum(i in 0..$n, m[i]/2*(vx[i]^2 + vy[i]^2) - m[i]*g*y[i]))]
        struct $name {
            m: [f64; $n],
            l: [f64; $n],
            g: f64,
        }
    };
}

planar!(Planar2, 2);
planar!(Planar3, 3);
planar!(Planar5, 5);
planar!(Planar10, 10);
planar!(Planar20, 20);
rods!(Rods5 5, Rods10 10, Rods20 20, Rods50 50);

fn states<const N: usize>() -> Vec<State<f64, N>> {
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut entries = || std::array::from_fn::<f64, N, _>(|_| random());
    (0..64).map(|_| State::new(entries(), entries())).collect()
}

fn evaluate<L, const N: usize>(criterion: &mut Criterion, name: &str, system: &L)
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    let states = states::<N>();
    let mut next = 0;
    criterion.bench_function(name, |bencher| {
        bencher.iter(|| {
            next = (next + 1) % states.len();
            black_box(system.accelerations_unchecked(black_box(&states[next])))
        });
    });
}

fn accelerations(criterion: &mut Criterion) {
    macro_rules! chains {
        ($($kind:literal $name:ident $n:literal),*) => {
            $(evaluate(criterion, concat!($kind, " ", $n), &$name { m: [1.0; $n], l: [0.7; $n], g: 9.81 });)*
        };
    }
    chains!("planar" Planar2 2, "planar" Planar3 3, "planar" Planar5 5, "planar" Planar10 10, "planar" Planar20 20);
    chains!("rods" Rods5 5, "rods" Rods10 10, "rods" Rods20 20, "rods" Rods50 50);
    evaluate(criterion, "spherical pendulum", &SphericalPendulum { m: 1.0, g: 9.81, l: 1.0 });
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    accelerations(&mut criterion);
    criterion.final_summary();
}
