//! What methods keep over many steps.

use std::f64::consts::TAU;

use lagrange_core::motion::Composition::{KahanLi6, KahanLi8, Suzuki4};
use lagrange_core::nalgebra::Const;
use lagrange_core::{Lagrangian, Method, prelude::*};
use lagrange_random::cases;
use lagrange_systems::OuterSolarSystem;

use crate::systems::*;

/// 2⁻⁵², the unit in which residuals of constraints are measured.
const UNIT: f64 = f64::EPSILON;

/// Takes `steps` of 0.01 along a spherical pendulum, back after a tenth of them. Asserts that both residuals stay within
/// four units of round-off of their terms, that the means of the energy over tenths of the time move by less than
/// `drift` of its swing, and that the way back leads to the start.
fn stays_on_the_sphere<P: Method<SphericalPendulum<f64>> + Copy>(
    name: &str,
    method: P,
    steps: usize,
    drift: f64,
) {
    let (system, start) = spherical();
    let mut motion = Motion::new(system, start, method).unwrap();
    let (mut worst, mut means) = ([0.0_f64; 2], Vec::new());
    let (mut sum, mut range) = (0.0, [f64::INFINITY, f64::NEG_INFINITY]);
    for k in 1..=steps {
        motion.advance_to(0.01 * k as f64).unwrap();
        let state = motion.state();
        let residuals = [
            system.constraint_residual(state)[0].abs() / system.residual_magnitude(state)[0],
            system.constraint_rate(state)[0].abs() / system.rate_magnitude(state)[0],
        ];
        worst = [0, 1].map(|level| worst[level].max(residuals[level] / UNIT));
        let energy = system.energy(state);
        (sum, range) = (sum + energy, [range[0].min(energy), range[1].max(energy)]);
        if k % (steps / 10) == 0 {
            means.push(sum / (steps / 10) as f64);
            sum = 0.0;
        }
    }
    assert!(worst.iter().all(|worst| *worst <= 4.0), "{name}: {worst:?} units of round-off");
    let moved = means.iter().map(|mean| (mean - means[0]).abs()).fold(0.0, f64::max) / (range[1] - range[0]);
    println!(
        "{name}: residuals {worst:.2?} units of round-off, means of the energy move by {moved:.1e} of its swing"
    );
    assert!(moved < drift, "{name}: the energy moves by {moved}");

    let mut motion = Motion::new(system, start, method).unwrap();
    (1..=steps / 10).chain((0..steps / 10).rev()).for_each(|k| motion.advance_to(0.01 * k as f64).unwrap());
    let off = error(motion.state(), &start);
    println!("{name}: back to {off:.1e}");
    assert!(off < 1e-10, "{name}: it comes back to {off}");
}

#[test]
fn constraints_and_energy_are_kept() {
    let steps = cases([5_000, 5_000, 1_000_000]);
    // The means of few steps differ by the part of a swing that is not over.
    let drift = if steps < 1_000_000 { 0.1 } else { 1e-3 };
    let most = 10 * steps;
    stays_on_the_sphere("RATTLE", Verlet::with_step(0.01).max_steps(most), steps, drift);
    let composed = Verlet::with_step(0.01).composed(Suzuki4).max_steps(most);
    stays_on_the_sphere("RATTLE of order 4", composed, steps, drift);
    stays_on_the_sphere("Lobatto 2", Lobatto::<2>::with_step(0.01).max_steps(most), steps, drift);
    stays_on_the_sphere("Lobatto 3", Lobatto::<3>::with_step(0.01).max_steps(most), steps, drift);
    stays_on_the_sphere("DAlembert", DAlembert::with_step(0.01).max_steps(most), steps, drift);
}

/// Where both apply, they are the same map.
#[test]
fn lobatto_of_two_stages_is_rattle() {
    let (system, start) = spherical();
    let by_rattle = system.integrate(start, 20.0, Verlet::with_step(0.01)).unwrap();
    let by_lobatto = system.integrate(start, 20.0, Lobatto::<2>::with_step(0.01)).unwrap();
    let off = error(by_rattle.end().state(), by_lobatto.end().state());
    assert!(off < 1e-12, "{off}");
    let (system, start) = henon_heiles();
    let by_verlet = system.integrate(start, 100.0, Verlet::with_step(0.05)).unwrap();
    let by_lobatto = system.integrate(start, 100.0, Lobatto::<2>::with_step(0.05)).unwrap();
    let off = error(by_verlet.end().state(), by_lobatto.end().state());
    assert!(off < 1e-12, "{off}");
}

/// Asserts that rounding errors of the energy are a random walk (Brouwer's law) along eight motions by order 8, with `steps`
/// in a turn. The motions start with velocities that differ by a ten-thousandth; `period` is the time of a turn.
///
/// Errors are relative, and less that after one turn, which is the error of the method.
fn is_a_random_walk<L, const N: usize>(
    name: &str,
    (system, first): (L, State<f64, N>),
    steps: f64,
    period: impl Fn(&L, &State<f64, N>) -> f64,
) where
    L: Lagrangian<N = Const<N>, Scalar = f64> + Clone,
    Verlet: Method<L>,
{
    let turns = cases([100, 100, 100_000]) as f64;
    let times = [turns / 100.0, turns / 10.0, turns];
    let errors: Vec<[f64; 3]> = (0..8)
        .map(|k| {
            let start = State::new(first.q, first.v * (1.0 + 1e-4 * f64::from(k)));
            let period = period(&system, &start);
            let method = Verlet::with_step(period / steps).composed(KahanLi8).max_steps(usize::MAX);
            let mut motion = Motion::new(system.clone(), start, method).unwrap();
            let mut at = |turns: f64| {
                motion.advance_to(turns * period).unwrap();
                system.energy(motion.state()) / system.energy(&start) - 1.0
            };
            let early = at(1.0);
            times.map(|turns| at(turns) - early)
        })
        .collect();
    let spreads = [0, 1, 2].map(|k| (errors.iter().map(|all| all[k].powi(2)).sum::<f64>() / 8.0).sqrt());
    let texts = spreads.map(|spread| format!("{spread:.1e}"));
    println!("{name}: energy off by {} after {times:?} turns", texts.join(", "));
    // Compensated sums make the steps of the walk a seventh of a unit of round-off and shorter.
    let walk = f64::EPSILON * (turns * steps * 17.0).sqrt();
    assert!(spreads[2] < 0.15 * walk, "{name}: {:e} after a walk of {walk:e}", spreads[2]);
    if turns >= 1e4 {
        // Eight motions give a spread to a quarter of itself, and this power to 0.08: three times this.
        let power = (spreads[2] / spreads[0]).log10() / 2.0;
        println!("{name}: the energy error grows as the power {power:.2} of the time");
        assert!((power - 0.5).abs() < 0.23, "{name}: {power}");
    }
}

#[test]
fn energy_errors_on_an_ellipse_grow_as_the_square_root() {
    // With two hundred steps a turn the error of the method is 3·10⁻¹³, and less at the end of a turn.
    let period = |system: &Planet<f64>, start: &State<f64, 2>| TAU * (-2.0 * system.energy(start)).powf(-1.5);
    is_a_random_walk("ellipse", kepler(), 200.0, period);
}

#[test]
fn energy_errors_in_the_solar_system_grow_as_the_square_root() {
    // With steps of 40 days the error of the method is 2·10⁻¹⁵.
    is_a_random_walk("outer solar system", outer_solar_system(), 108.0, |_, _| 4332.6);
}

/// The angular momentum of a central force is kept to round-off, as every linear symmetry.
#[test]
fn angular_momentum_is_kept() {
    let (system, start) = kepler();
    let momentum = |state: &State<f64, 2>| state.q[0] * state.v[1] - state.q[1] * state.v[0];
    let check = |name: &str, end: &State<f64, 2>| {
        let off = momentum(end) / momentum(&start) - 1.0;
        assert!(off.abs() < 1e-14, "{name}: {off:e}");
    };
    check("Verlet", system.integrate(start, 60.0, Verlet::with_step(0.03)).unwrap().end().state());
    let composed = Verlet::with_step(0.1).composed(KahanLi6);
    check("order 6", system.integrate(start, 60.0, composed).unwrap().end().state());
    check("Gauss 1", system.integrate(start, 60.0, Gauss::<1>::with_step(0.03)).unwrap().end().state());
    check("Gauss 3", system.integrate(start, 60.0, Gauss::<3>::with_step(0.06)).unwrap().end().state());
    check("Lobatto 3", system.integrate(start, 60.0, Lobatto::<3>::with_step(0.03)).unwrap().end().state());
}

/// The sun with the inner planets, Jupiter, Saturn, Uranus, Neptune and Pluto, in astronomical units and days: Hairer, Lubich
/// and Wanner, *Geometric Numerical Integration*, I.2.4, about the centre of mass: the published frame moves
/// against it by 20,000 units in a million turns of Jupiter, and coordinates of this size would lose their last digits.
fn outer_solar_system() -> (OuterSolarSystem, State<f64, 18>) {
    let m = [
        1.000_005_976_82,
        0.000_954_786_104_043,
        0.000_285_583_733_151,
        0.000_043_727_316_454_6,
        0.000_051_775_913_844_9,
        1.0 / 1.3e8,
    ];
    let table = include_str!("../reference_problems/values/outer_solar_system.txt");
    let first = |name: &str| -> [f64; 18] {
        let line = table.lines().find_map(|line| line.strip_prefix(name)).unwrap();
        let numbers: Vec<f64> = line.split_whitespace().map(|number| number.parse().unwrap()).collect();
        let mean = |k: usize| (0..6).map(|i| m[i] * numbers[3 * i + k]).sum::<f64>() / m.iter().sum::<f64>();
        std::array::from_fn(|i| numbers[i] - mean(i % 3))
    };
    (OuterSolarSystem { m, G: 2.959_122_082_86e-4 }, State::new(first("q "), first("v ")))
}
