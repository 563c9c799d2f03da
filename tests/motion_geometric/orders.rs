//! Orders of the methods: slopes of log error over log step, by least squares over at least four halvings.
//!
//! The error is the largest of all coordinates and velocities at the end. References are a closed form, and motions by
//! `Dop853`, which shares no code with the methods, with a tolerance of 10⁻¹⁴. Each method is tried on one or two systems, on
//! three or four at the level `full`.

use lagrange_core::motion::Composition::{
    self, KahanLi6, KahanLi8, Suzuki4, SuzukiUmeno8, Yoshida4, Yoshida6,
};
use lagrange_core::nalgebra::Const;
use lagrange_core::{Method, prelude::*};

use crate::IS_LONG;
use crate::systems::*;

/// Errors between 10⁻² and this are used: a thousand times what rounding leaves.
const FLOOR: f64 = 4e-12;
/// The same where the motion is known in closed form.
const EXACT_FLOOR: f64 = 3e-13;
/// Number of steps of the regression, each shorter by √2: four halvings.
const STEPS: usize = 8;

/// Asserts the order of a method on a system, and that errors fall to `least`. Steps are `coarsest`, halved each time.
fn check<L, P, const N: usize>(
    name: &str,
    (problem, exact): (&(L, State<f64, N>), State<f64, N>),
    (order, coarsest, least): (usize, f64, f64),
    method: impl Fn(f64) -> P,
) where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
    P: Method<L>,
{
    let (end, floor) = (exact.t, if name.starts_with("particle") { EXACT_FLOOR } else { FLOOR });
    let mut points: Vec<(f64, f64)> = Vec::new();
    for k in 0..40 {
        // All steps of one length.
        let h = end / (end / coarsest * 2.0_f64.powf(f64::from(k) / 2.0)).round();
        let (system, start) = problem;
        let Ok(path) = system.integrate(*start, end, method(h)) else { continue };
        let off = error(path.end().state(), &exact);
        if off < floor {
            break;
        } else if off < 1e-2 {
            points.push((h.log2(), off.log2()));
        }
        if points.len() > STEPS && off < least {
            break;
        }
    }
    // From an error of 10⁻² to the floor, a method of order 8 has less than four halvings, the first not asymptotic.
    let steps = if order < 8 { STEPS } else { STEPS / 2 };
    assert!(points.len() > steps, "{name}: {points:?}");
    let points = &points[points.len() - steps - 1..];
    let smallest = points.iter().fold(f64::INFINITY, |least, (_, error)| least.min(*error)).exp2();
    assert!(smallest < least, "{name}: {smallest:e} is the least error");
    let count = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (h, e) = (mean(|point| point.0), mean(|point| point.1));
    let slope = points.iter().map(|point| (point.0 - h) * (point.1 - e)).sum::<f64>()
        / points.iter().map(|point| (point.0 - h).powi(2)).sum::<f64>();
    println!("{name}: {slope:.3} over {} steps, least error {smallest:.1e}", points.len());
    let margin = if order > 4 { 0.3 } else { 0.1 };
    assert!(slope > order as f64 - margin, "{name}: order {slope}");
}

/// Coarsest step and least error of a method of this order.
fn range(order: usize) -> (usize, f64, f64) {
    match order {
        2 => (2, 0.02, 1e-5),
        4 => (4, 0.2, 1e-8),
        6 => (6, 2.0, 1e-8),
        _ => (8, 2.0, 1e-8),
    }
}

/// All compositions in the long checks, one of each order else.
fn compositions() -> Vec<Composition> {
    if IS_LONG {
        vec![Yoshida4, Suzuki4, Yoshida6, KahanLi6, SuzukiUmeno8, KahanLi8]
    } else {
        vec![Suzuki4, KahanLi6, KahanLi8]
    }
}

/// A method of order 2 and all of its compositions, against a reference or this motion.
macro_rules! composed {
    ($method:ident: $problem:ident) => {
        composed!($method: $problem, reference(&$problem(), 4.0))
    };
    ($method:ident: $problem:ident, $exact:expr) => {{
        let (problem, exact) = ($problem(), $exact);
        check(stringify!($problem), (&problem, exact), range(2), $method::with_step);
        for composition in compositions() {
            let name = format!("{} {composition:?}", stringify!($problem));
            let method = |h| $method::with_step(h).composed(composition);
            check(&name, (&problem, exact), range(composition.order()), method);
        }
    }};
}

#[test]
fn verlet_without_constraints() {
    composed!(Verlet: kepler);
    if IS_LONG {
        composed!(Verlet: henon_heiles);
    }
}

#[test]
fn rattle() {
    composed!(Verlet: shaken);
    if IS_LONG {
        composed!(Verlet: spherical);
        composed!(Verlet: two_bobs);
    }
}

macro_rules! stages {
    ($method:ident $([$stages:literal, $order:literal])*: $problem:ident) => {$(
        let name = format!("{} by {} {}", stringify!($problem), stringify!($method), $stages);
        check(&name, (&$problem(), reference(&$problem(), 4.0)), range($order), $method::<$stages>::with_step);
    )*};
}

#[test]
fn gauss() {
    stages!(Gauss [1, 2] [2, 4] [3, 6] [4, 8]: double_pendulum);
    if IS_LONG {
        stages!(Gauss [1, 2] [2, 4] [3, 6] [4, 8]: charge);
        stages!(Gauss [1, 2] [2, 4] [3, 6] [4, 8]: bead);
    }
}

#[test]
fn lobatto() {
    stages!(Lobatto [2, 2] [3, 4] [4, 6]: bowl);
    if IS_LONG {
        stages!(Lobatto [2, 2] [3, 4] [4, 6]: double_pendulum);
        stages!(Lobatto [2, 2] [3, 4] [4, 6]: spherical);
        stages!(Lobatto [2, 2] [3, 4] [4, 6]: shaken);
    }
}

#[test]
fn lobatto_where_masses_are_zero() {
    // Lobatto 4 has 3.5 halvings between the longest step whose iteration converges and the floor, of slope 5.97.
    stages!(Lobatto [2, 2] [3, 4]: top);
    stages!(Lobatto [2, 2] [3, 4]: weight);
}

#[test]
fn dalembert() {
    composed!(DAlembert: particle, particle_at(4.0));
    composed!(DAlembert: ball);
    if IS_LONG {
        composed!(DAlembert: sleigh);
        composed!(DAlembert: wheel);
    }
}
