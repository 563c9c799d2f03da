//! A04 of the IFToMM benchmark: Bricard's mechanism, six bars in a loop of six revolute joints, one bar fixed. One degree of freedom
//! is left, one more than the number of the constraints says: they depend on one another at every pose.
//!
//! The joints turn by (α, β, α, β, α) with (1 + sin α)(1 + sin β) = 1, and time follows from the energy by quadrature.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LN_2, PI};

use lagrange_core::nalgebra::{Rotation3, Unit, Vector3};
use lagrange_core::prelude::*;

use crate::reference::{IS_LONG, Known, Problem};

const G: f64 = 9.81;

/// Five bars of length and mass 1 from the origin to (0, 0, 1), along x, −y, z, −x and y where the angles are zero. The last keeps
/// its x-axis, which is that of the joint at its end.
#[derive(Lagrangian)]
#[coordinates(q: [5])]
#[frame(first: rotate_y(q[0]))]
#[frame(second in first: translate([1, 0, 0]), rotate_z(q[1]))]
#[frame(third in second: translate([0, -1, 0]), rotate_x(q[2]))]
#[frame(fourth in third: translate([0, 0, 1]), rotate_y(q[3]))]
#[frame(fifth in fourth: translate([-1, 0, 0]), rotate_z(q[4]))]
#[define(I = along)]
#[define(J = across)]
#[lagrangian(kinetic(first, 1, [1/2, 0, 0], [[I, 0, 0], [0, J, 0], [0, 0, J]])
    + kinetic(second, 1, [0, -1/2, 0], [[J, 0, 0], [0, I, 0], [0, 0, J]])
    + kinetic(third, 1, [0, 0, 1/2], [[J, 0, 0], [0, J, 0], [0, 0, I]])
    + kinetic(fourth, 1, [-1/2, 0, 0], [[I, 0, 0], [0, J, 0], [0, 0, J]])
    + kinetic(fifth, 1, [0, 1/2, 0], [[J, 0, 0], [0, I, 0], [0, 0, J]])
    - g*(position(first, [1/2, 0, 0])[1] + position(second, [0, -1/2, 0])[1] + position(third, [0, 0, 1/2])[1]
        + position(fourth, [-1/2, 0, 0])[1] + position(fifth, [0, 1/2, 0])[1]))]
#[constraint(end: position(fifth, [0, 1, 0]) = [0, 0, 1])]
#[define(axis = express(vector(fifth, [1, 0, 0]), fixed))]
#[constraint(joint: [axis[1], axis[2]] = 0)]
struct Bricard {
    /// Moments of inertia of a bar about its own axis, and about axes across it through its middle.
    along: f64,
    across: f64,
    g: f64,
}

const THIN: Bricard = Bricard { along: 0.0, across: 1.0 / 12.0, g: G };
/// With a square section of 0.1 m.
const SQUARE: Bricard = Bricard { along: 0.01 / 6.0, across: 1.01 / 12.0, g: G };

/// The angle α(τ) with sin α = 2^(sin τ) − 1, and its derivative: cos α changes its sign where sin τ = 1. β(τ) is α(−τ).
fn angle(tau: f64) -> [f64; 2] {
    let s = tau.sin();
    let power = s.exp2();
    // (2 − 2^s)/(1 − s), which is 2 ln 2 for s = 1.
    let ratio = if s == 1.0 { 2.0 * LN_2 } else { -2.0 * ((s - 1.0) * LN_2).exp_m1() / (1.0 - s) };
    let (root, (half_sine, half_cosine)) = ((2.0 * power * ratio).sqrt(), (tau / 2.0 + FRAC_PI_4).sin_cos());
    let angle = (power - 1.0).atan2(half_cosine * root);
    [if angle < -FRAC_PI_2 { angle + 2.0 * PI } else { angle }, 2.0 * LN_2 * power * half_sine / root]
}

/// A pose on the branch: the angles and their derivatives by τ, the inertia T = ½ m τ̇², and the potential.
struct Pose {
    q: [f64; 5],
    by_tau: [f64; 5],
    inertia: f64,
    potential: f64,
}

/// Follows the bars from joint to joint, and checks that they close.
fn pose(bricard: &Bricard, tau: f64) -> Pose {
    let ([a, a_tau], [b, b_tau]) = (angle(tau), angle(-tau));
    let (q, by_tau) = ([a, b, a, b, a], [a_tau, -b_tau, a_tau, -b_tau, a_tau]);
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    let (axes, bars) = ([y, z, x, y, z], [x, -y, z, -x, y]);
    // T of a thin bar between ends with these velocities, and what its thickness adds.
    let [thick_along, thick_across] = [bricard.along, bricard.across - 1.0 / 12.0];
    let (mut place, mut velocity, mut turn, mut spin) =
        (Vector3::zeros(), Vector3::zeros(), Rotation3::identity(), Vector3::zeros());
    let (mut kinetic, mut potential) = (0.0, 0.0);
    for i in 0..5 {
        spin += by_tau[i] * (turn * axes[i]);
        turn *= Rotation3::from_axis_angle(&Unit::new_unchecked(axes[i]), q[i]);
        let bar = turn * bars[i];
        let (next, next_velocity): (Vector3<f64>, Vector3<f64>) = (place + bar, velocity + spin.cross(&bar));
        kinetic +=
            (velocity.norm_squared() + velocity.dot(&next_velocity) + next_velocity.norm_squared()) / 6.0;
        kinetic +=
            (thick_along * spin.dot(&bar).powi(2) + thick_across * spin.cross(&bar).norm_squared()) / 2.0;
        potential += bricard.g * (place[1] + next[1]) / 2.0;
        (place, velocity) = (next, next_velocity);
    }
    assert!((place - z).norm() < 1e-14 && (turn * x - x).norm() < 1e-14, "open at {tau}: {place}");
    Pose { q, by_tau, inertia: 2.0 * kinetic, potential }
}

/// Nodes and weights of Gauss's quadrature with five points on −1 … 1.
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Moments of the motion from rest at τ = 0, `per_swing` in each swing to τ = π or back. With τ = π (1 − cos ξ)/2 the speed
/// τ̇ = √(2(V(0) − V)/m) and dτ/dξ vanish together at the ends.
fn moments(bricard: &Bricard, swings: usize, per_swing: usize) -> Vec<Known<5, 5>> {
    let energy = pose(bricard, 0.0).potential;
    let at = |xi: f64| PI * (1.0 - xi.cos()) / 2.0;
    let speed = |pose: &Pose| (2.0 * (energy - pose.potential).max(0.0) / pose.inertia).sqrt();
    const INTERVALS: usize = 40;
    let width = PI / (per_swing * INTERVALS) as f64;
    let rate = |xi: f64| PI * xi.sin().abs() / 2.0 / speed(&pose(bricard, at(xi)));
    let interval = |k: usize| -> f64 {
        let middle = (k as f64 + 0.5) * width;
        GAUSS.iter().map(|(node, weight)| weight * width / 2.0 * rate(middle + node * width / 2.0)).sum()
    };
    let mut t = 0.0;
    let after = |k: usize| {
        t += (k * INTERVALS..(k + 1) * INTERVALS).map(interval).sum::<f64>();
        let xi = (k + 1) as f64 * PI / per_swing as f64;
        let pose = pose(bricard, at(xi));
        // At the end of a swing it is at rest, which the energy says only to its root.
        let tau_dot = if (k + 1).is_multiple_of(per_swing) { 0.0 } else { xi.sin().signum() * speed(&pose) };
        Known { t, q: pose.q, v: pose.by_tau.map(|x| x * tau_dot), lambda: None }
    };
    (0..swings * per_swing).map(after).collect()
}

fn problem(name: &'static str, system: Bricard, swings: usize) -> Problem<Bricard, 5, 5> {
    let start = Known { t: 0.0, q: [0.0; 5], v: [0.0; 5], lambda: None };
    let known = [start].into_iter().chain(moments(&system, swings, 4)).collect();
    Problem { name, system, known }
}

#[test]
fn the_mechanism_reaches_the_branch() {
    for (name, system) in [("A04 Bricard, thin", THIN), ("A04 Bricard, square", SQUARE)] {
        let problem = problem(name, system, if IS_LONG { 6 } else { 2 });
        problem.row("Taylor 2⁻⁵²", Taylor::default()).reaches([1e-6; 3]);
        problem.row("Dop853 1e-12", Dop853::with_tolerance(1e-12)).reaches([1e-6; 3]);
        if IS_LONG {
            let _ = problem.row("Radau 1e-10", Radau::with_tolerance(1e-10));
            problem.row("Dopri5 1e-10", Dopri5::with_tolerance(1e-10)).reaches([1e-6; 3]);
            problem.row("RungeKutta4 1e-3 s", RungeKutta4::with_step(1e-3)).reaches([1e-6; 3]);
        }
    }
}

/// A fifth constraint that follows from the other four neither stops the motion nor moves it; the trajectory says so.
#[test]
fn the_constraints_are_dependent_at_every_pose() {
    let solution = THIN.solve(&State::at_rest([0.0; 5])).unwrap();
    assert_eq!(solution.rank, 4);
    let path = THIN.integrate(State::at_rest([0.0; 5]), 1.0, Dop853::default()).unwrap();
    assert!(!path.multipliers_are_unique());
    for sample in path.samples(11) {
        assert_eq!(sample.solution().unwrap().rank, 4, "{sample}");
    }
}
