//! Stiff and constrained problems of the test suite, as first-order equations ẏ = f(t, y) of y = (q, q̇) with the constraints
//! eliminated:
//!
//! ```c
//! void NAME_rates(double t, const double *y, double *rates);
//! void NAME_jacobian(double t, const double *y, double *by_row);
//! ```

#[allow(dead_code, unused_imports, reason = "its tests are not compiled here")]
#[path = "../../../../../tests/reference_problems/andrews.rs"]
mod andrews;
#[allow(dead_code, unused_imports, reason = "its tests are not compiled here")]
#[path = "../../../../../tests/reference_problems/noninertial.rs"]
mod noninertial;
#[allow(dead_code, reason = "only the problems are used here")]
#[path = "../../../../../tests/reference_problems/reference.rs"]
mod reference;
#[allow(dead_code, unused_imports, reason = "its tests are not compiled here")]
#[path = "../../../../../tests/reference_problems/test_set.rs"]
mod test_set;

use lagrange_core::nalgebra::Const;
use lagrange_core::{StateDerivatives, prelude::*};
use reference::{Known, Problem};

/// A pendulum in honey: a bob on a rod, let go at the horizontal.
#[derive(Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - g*y)]
#[constraint(rod: x^2 + y^2 = 1)]
#[dissipation(c/2*(x_dot^2 + y_dot^2))]
struct Honey {
    g: f64,
    c: f64,
}

/// The end of its motion. The angle a below the horizontal has ä + cȧ = g cos a. From the start it jumps by −g/c², then follows
/// ȧ = (g/c) cos a (1 + (g/c²) sin a) but for (g/c²)² ≈ 10⁻²², and the last factor is that of g/c in time.
fn honey() -> Problem<Honey, 2, 1> {
    let (g, c, t): (f64, f64, f64) = (9.81, 1e6, 1e5);
    let slow = |t: f64| 2.0 * (g * t / c / 2.0).tanh().atan();
    // The corrections of first order in g/c²: of the start, and ∫ sin a da/cos a = −ln cos a, times cos a.
    let first = slow(t).cos() * (-1.0 - slow(t).cos().ln());
    let a = slow(t) + g / (c * c) * first;
    let rate = g / c * a.cos() * (1.0 + g / (c * c) * a.sin());
    let (q, v) = ([a.cos(), -a.sin()], [-rate * a.sin(), -rate * a.cos()]);
    let start = Known { t: 0.0, q: [1.0, 0.0], v: [0.0; 2], lambda: None };
    let end = Known { t, q, v, lambda: None };
    Problem { name: "pendulum in honey", system: Honey { g, c }, known: vec![start, end] }
}

/// Work on a problem: its system, its start, and the end with the state that is known there.
pub trait Work {
    type Outcome;
    fn on<L, const N: usize>(self, system: &L, start: State<f64, N>, end: State<f64, N>) -> Self::Outcome
    where
        L: StateDerivatives<N = Const<N>, Scalar = f64>;
}

fn given<W: Work, L, const N: usize, const M: usize>(work: W, problem: Problem<L, N, M>) -> W::Outcome
where
    L: StateDerivatives<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    let state = |&Known { t, q, v, .. }: &Known<N, M>| State::new(q, v).at_time(t);
    let [start, .., end] = &problem.known[..] else { panic!("{} has no end", problem.name) };
    work.on(&problem.system, state(start), state(end))
}

/// Does work on the problem of this name; `None` if there is none.
pub fn work_on<W: Work>(name: &str, work: W) -> Option<W::Outcome> {
    Some(match name {
        "squeezer" => given(work, andrews::squeezer()),
        "car_axis" => given(work, test_set::car_axis()),
        "honey" => given(work, honey()),
        _ => return None,
    })
}

/// State at a time, from a slice of coordinates and velocities.
fn state<const N: usize>(t: f64, y: &[f64]) -> State<f64, N> {
    let half = |first: usize| std::array::from_fn(|i| y[first + i]);
    State::new(half(0), half(N)).at_time(t)
}

/// Writes ẏ at a time and y; NaN where the equations have no solution.
pub fn rates<L, const N: usize>(system: &L, t: f64, y: &[f64], rates: &mut [f64])
where
    L: Lagrangian<N = Const<N>, Scalar = f64>,
{
    let solution = system.accelerations_unchecked(&state(t, y));
    rates[..N].copy_from_slice(&y[N..2 * N]);
    rates[N..2 * N].copy_from_slice(solution.accelerations.as_slice());
}

/// Writes ∂ẏ/∂y at a time and y, row by row; NaN where there is none.
pub fn jacobian<L, const N: usize>(system: &L, t: f64, y: &[f64], by_row: &mut [f64])
where
    L: StateDerivatives<N = Const<N>, Scalar = f64>,
{
    let Ok(found) = system.state_jacobian(&state(t, y)) else { return by_row.fill(f64::NAN) };
    for (i, row) in by_row.chunks_exact_mut(2 * N).enumerate() {
        for (k, entry) in row.iter_mut().enumerate() {
            *entry = match (i.checked_sub(N), k.checked_sub(N)) {
                (None, _) => f64::from(u8::from(k == N + i)),
                (Some(i), None) => found.accelerations.q[(i, k)],
                (Some(i), Some(k)) => found.accelerations.v[(i, k)],
            };
        }
    }
}

macro_rules! export {
    ($($rates:ident, $jacobian:ident: $problem:expr, $n:literal;)*) => {$(
        /// # Safety
        /// `y` and `out` point to 2N numbers.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $rates(t: f64, y: *const f64, out: *mut f64) {
            thread_local!(static SYSTEM: Box<dyn Fn(f64, &[f64], &mut [f64])> = {
                let system = $problem.system;
                Box::new(move |t, y, out| rates(&system, t, y, out))
            });
            let (y, out) = unsafe { slices(y, out, 2 * $n, 2 * $n) };
            SYSTEM.with(|work| work(t, y, out));
        }

        /// # Safety
        /// `y` points to 2N numbers, `out` to (2N)².
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $jacobian(t: f64, y: *const f64, out: *mut f64) {
            thread_local!(static SYSTEM: Box<dyn Fn(f64, &[f64], &mut [f64])> = {
                let system = $problem.system;
                Box::new(move |t, y, out| jacobian(&system, t, y, out))
            });
            let (y, out) = unsafe { slices(y, out, 2 * $n, 4 * $n * $n) };
            SYSTEM.with(|work| work(t, y, out));
        }
    )*};
}

unsafe fn slices<'a>(
    y: *const f64,
    out: *mut f64,
    given: usize,
    wanted: usize,
) -> (&'a [f64], &'a mut [f64]) {
    unsafe { (std::slice::from_raw_parts(y, given), std::slice::from_raw_parts_mut(out, wanted)) }
}

export! {
    squeezer_rates, squeezer_jacobian: andrews::squeezer(), 7;
    car_axis_rates, car_axis_jacobian: test_set::car_axis(), 4;
    honey_rates, honey_jacobian: honey(), 2;
}
