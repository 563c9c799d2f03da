//! A02 of the IFToMM benchmark: N windows of four bars side by side, in the coordinates of their corners. Each time all bars are level
//! the constraints depend on one another, and each coupler could go another way.
//!
//! From the upright pose all bars stay parallel: θ̈ = k sin θ with k = (g/l) 3(3N + 1)/2(4N + 1), which Jacobi's functions solve.

use std::f64::consts::{FRAC_PI_2, PI};

use lagrange_core::nalgebra::Const;
use lagrange_core::{StateDerivatives, TaylorSeries, prelude::*};

use crate::reference::{IS_LONG, Known, Problem, assert_relative, table};

const G: f64 = 9.81;

/// Bars of length and mass 1. Verticals stand on (i, 0), couplers lie between their upper ends B_i. A uniform bar between P and Q
/// has T = (Ṗ² + ṖQ̇ + Q̇²)/6.
macro_rules! windows {
    ($name:ident, $n:literal, $corners:literal) => {
        #[derive(Lagrangian)]
        #[coordinates(b: [$corners, 2])]
        #[lagrangian(sum(i in 0..$corners, dot(b_dot[i], b_dot[i])/6 - g*b[i][1]/2)
                            + sum(i in 0..$n, (dot(b_dot[i], b_dot[i]) + dot(b_dot[i], b_dot[i+1]) + dot(b_dot[i+1], b_dot[i+1]))/6
                                - g*(b[i][1] + b[i+1][1])/2))]
        #[constraint(vertical[i in 0..$corners]: (b[i][0] - i)^2 + b[i][1]^2 - 1 = 0)]
        #[constraint(coupler[i in 0..$n]: dot(b[i+1] - b[i], b[i+1] - b[i]) - 1 = 0)]
        struct $name {
            g: f64,
        }
    };
}
windows!(OneWindow, 1, 2);
windows!(TwoWindows, 2, 3);
windows!(FortyWindows, 40, 41);

/// The angle of the bars from the upright, its rate and its acceleration.
#[derive(Clone, Copy, Debug)]
struct Turn {
    angle: f64,
    rate: f64,
    acceleration: f64,
}

fn stiffness(n: usize) -> f64 {
    let n = n as f64;
    G * 3.0 * (3.0 * n + 1.0) / (2.0 * (4.0 * n + 1.0))
}

/// Jacobi's amplitude am(u | m) and the quarter period K(m), by the arithmetic-geometric mean (Abramowitz and Stegun 16.4, 17.6).
fn amplitude(u: f64, m: f64) -> (f64, f64) {
    let mut means = vec![(1.0, m.sqrt())];
    let mut b = (1.0 - m).sqrt();
    while let Some(&(a, c)) = means.last()
        && c > 1e-16 * a
    {
        means.push(((a + b) / 2.0, (a - b) / 2.0));
        b = (a * b).sqrt();
    }
    let (last, count) = (means[means.len() - 1].0, means.len() as i32 - 1);
    let begin = 2.0_f64.powi(count) * last * u;
    let phase = means[1..]
        .iter()
        .rev()
        .fold(begin, |phase, (a, c)| f64::midpoint(phase, (c / a * phase.sin()).asin()));
    (phase, FRAC_PI_2 / last)
}

/// The motion of n windows from the upright with θ̇ = 1. With χ = (θ − π)/2, χ̇² = ¼(1 + 4k)(1 − m sin² χ) for m = 4k/(1 + 4k).
fn turn(n: usize, t: f64) -> Turn {
    let k = stiffness(n);
    let rate = (1.0 + 4.0 * k).sqrt() / 2.0;
    let m = 4.0 * k / (1.0 + 4.0 * k);
    let (_, quarter) = amplitude(0.0, m);
    let (chi, _) = amplitude(rate * t - quarter, m);
    let angle = PI + 2.0 * chi;
    Turn { angle, rate: 2.0 * rate * (1.0 - m * chi.sin().powi(2)).sqrt(), acceleration: k * angle.sin() }
}

fn period(n: usize) -> f64 {
    let k = stiffness(n);
    let (_, quarter) = amplitude(0.0, 4.0 * k / (1.0 + 4.0 * k));
    4.0 * quarter / (1.0 + 4.0 * k).sqrt()
}

/// Coordinates, velocities and multipliers at a time. The multipliers follow from the balance of each corner, first along y, then
/// along x from one corner to the next; where the bars are level, those of more than one window are infinite.
fn moment<const N: usize, const M: usize>(n: usize, t: f64) -> Known<N, M> {
    let Turn { angle, rate, acceleration } = turn(n, t);
    let (s, c) = angle.sin_cos();
    let (mut q, mut v, mut lambda) = ([0.0; N], [0.0; N], [0.0; M]);
    let [ax, ay] = [acceleration * c - rate * rate * s, -acceleration * s - rate * rate * c];
    let mut push = 0.0;
    for i in 0..=n {
        (q[2 * i], q[2 * i + 1]) = (i as f64 + s, c);
        (v[2 * i], v[2 * i + 1]) = (rate * c, -rate * s);
        let couplers = if i == 0 || i == n { 1.0 } else { 2.0 };
        let mass = 1.0 / 3.0 + couplers / 2.0;
        lambda[i] = (mass * ay + G / 2.0 * (1.0 + couplers)) / (2.0 * c);
        push += lambda[i] * s - mass * ax / 2.0;
        if i < n {
            lambda[n + 1 + i] = push;
        }
    }
    // Nothing pushes the last corner from beyond.
    assert!(push.abs() < 1e-9 * (1.0 + lambda[0].abs() * n as f64), "{n} windows at {t}: {push}");
    Known { t, q, v, lambda: Some(lambda) }
}

fn upright<const N: usize>() -> ([f64; N], [f64; N]) {
    let q = std::array::from_fn(|k| if k % 2 == 0 { (k / 2) as f64 } else { 1.0 });
    (q, std::array::from_fn(|k| if k % 2 == 0 { 1.0 } else { 0.0 }))
}

#[test]
fn the_closed_form_is_the_table() {
    for (n, table, time) in [
        (1, table!("one_window"), 1.923_711_817_338_965_8),
        (2, table!("two_windows"), 1.942_514_922_607_083_7),
    ] {
        assert_relative("time of one turn", period(n), time, 1e-14);
        for Known { t, q, v, .. } in table as Vec<Known<2, 0>> {
            let Turn { angle, rate, .. } = turn(n, t);
            let (s, c) = angle.sin_cos();
            let found = [s, c, rate * c, -rate * s];
            for (found, expected) in found.into_iter().zip(q.into_iter().chain(v)) {
                assert!((found - expected).abs() < 2e-13, "{n} at {t}: {found} in place of {expected}");
            }
        }
    }
}

/// To the time `end`, across a level pose about once a second.
fn windows<L, const N: usize, const M: usize>(
    name: &'static str,
    system: L,
    n: usize,
    end: f64,
) -> Problem<L, N, M>
where
    L: Lagrangian<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    let times = [0.0, 0.5, 1.0, 2.0, 4.0, 5.0, 10.0, 20.0].into_iter();
    let mut known: Vec<_> = times.filter(|t| *t <= end).map(|t| moment(n, t)).collect();
    (known[0].q, known[0].v) = upright();
    Problem { name, system, known }
}

/// `Taylor` steps across level poses if its tolerance leaves room between truncation and round-off. Other settings may end before
/// such a pose, and a pair may leave it along another branch: what they do is in the table alone.
fn other_methods<L, const N: usize, const M: usize>(problem: &Problem<L, N, M>)
where
    L: TaylorSeries<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    problem.row_by_known("Taylor 1e-9", Taylor::with_tolerance(1e-9)).reaches([1e-6; 3]);
    let _ = problem.row_by_known("Taylor 2⁻⁵²", Taylor::default());
    let _ = problem.row_by_known("Dop853 1e-10", Dop853::with_tolerance(1e-10));
    let _ = problem.row_by_known("Dopri5 1e-8", Dopri5::with_tolerance(1e-8));
}

/// `Radau` crosses level poses at every tolerance.
fn radau<L, const N: usize, const M: usize>(problem: &Problem<L, N, M>, tolerance: f64)
where
    L: StateDerivatives<N = Const<N>, M = Const<M>, Scalar = f64>,
{
    let (method, label) =
        (Radau::with_tolerance(tolerance), |s| format!("Radau, {s} stages {tolerance:.0e}"));
    problem.row_by_known(&label(3), method).reaches([1e-6; 3]);
    problem.row_by_known(&label(5), method.stages::<5>()).reaches([1e-6; 3]);
    problem.row_by_known(&label(7), method.stages::<7>()).reaches([1e-6; 3]);
}

#[test]
fn one_and_two_windows_cross_level_poses() {
    let end = if IS_LONG { 20.0 } else { 10.0 };
    let one = windows("A02, 1 window", OneWindow { g: G }, 1, end);
    let two = windows("A02, 2 windows", TwoWindows { g: G }, 2, end);
    one.row_by_known("Taylor 1e-10", Taylor::with_tolerance(1e-10)).reaches([1e-6; 3]);
    two.row_by_known("Taylor 1e-10", Taylor::with_tolerance(1e-10)).reaches([1e-6; 3]);
    radau(&one, 1e-10);
    radau(&two, 1e-10);
    if IS_LONG {
        other_methods(&one);
        other_methods(&two);
        for tolerance in [1e-11, 1e-12, 1e-13] {
            radau(&one, tolerance);
            radau(&two, tolerance);
        }
        let _ = one.row_by_known("RungeKutta4 2e-3 s", RungeKutta4::with_step(2e-3));
        let _ = two.row_by_known("RungeKutta4 2e-3 s", RungeKutta4::with_step(2e-3));
    }
}

/// Forty windows, of 82 coordinates and 81 constraints; unoptimised across one level pose.
fn forty_windows() {
    let end = if IS_LONG { 20.0 } else { 1.0 };
    let forty = windows("A02, 40 windows", FortyWindows { g: G }, 40, end);
    forty.row_by_known("Taylor 1e-10", Taylor::with_tolerance(1e-10)).reaches([1e-6; 3]);
    if IS_LONG {
        other_methods(&forty);
    }
}

#[test]
fn forty_windows_cross_level_poses() {
    // At the poses the general solver takes over, whose matrices need more stack than a test has.
    std::thread::Builder::new().stack_size(64 << 20).spawn(forty_windows).unwrap().join().unwrap();
}

/// With any tolerance `Taylor` either ends before a level pose, and says so, or goes on along the right branch. Below 10⁻¹⁰ it is up to
/// rounding which of the two; from there on all motions get to the end.
#[test]
fn no_tolerance_leads_along_another_branch() {
    let one = windows("A02, 1 window", OneWindow { g: G }, 1, 10.0);
    let two = windows("A02, 2 windows", TwoWindows { g: G }, 2, 10.0);
    let tolerances = [f64::EPSILON, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8];
    for tolerance in tolerances {
        let (method, label) = (Taylor::with_tolerance(tolerance), format!("Taylor {tolerance:.0e}"));
        for row in [one.row_by_known(&label, method), two.row_by_known(&label, method)] {
            let may_end = tolerance < 1e-10;
            assert!(may_end && row.errors[0].is_infinite() || row.is_within([1e-6; 3]), "{row}");
        }
    }
}
