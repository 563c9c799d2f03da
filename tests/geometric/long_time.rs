//! What methods keep over many steps.

use std::f64::consts::TAU;

use lagrange_core::motion::Composition::{KahanLi6, KahanLi8, Suzuki4};
use lagrange_core::{Method, prelude::*};

use crate::count;
use crate::systems::*;

/// 2⁻⁵², the unit in which residuals of constraints are measured.
const UNIT: f64 = f64::EPSILON;

/// Takes `steps` of 0.01 along a spherical pendulum, back after a tenth of them. Asserts that both residuals stay within
/// four units of round-off of their terms, that the means of the energy over tenths of the time move by less than
/// `drift` of its swing, and that the way back leads to the start.
fn stays_on_the_sphere<P: Method<Spherical<f64>> + Copy>(name: &str, method: P, steps: usize, drift: f64) {
    let (system, start) = spherical();
    let mut motion = Motion::new(system.clone(), start, method).unwrap();
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
    let steps = count("LAGRANGE_STEPS", 20_000);
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

/// Rounding errors of the energy are a random walk (Brouwer's law): over `turns` of an ellipse they grow as the square
/// root of the time, from several starts.
#[test]
fn energy_errors_grow_as_the_square_root() {
    let turns = count("LAGRANGE_TURNS", 100);
    let (system, first) = kepler();
    let ends: Vec<[f64; 2]> = (0..8)
        .map(|k| {
            let turned = 0.1 * f64::from(k);
            let start = State::new(first.q, first.v * (1.0 + 1e-3 * turned));
            // Two hundred steps a turn: the error of the method, 3·10⁻¹³, shows at other phases after many turns.
            let period = TAU * (-2.0 * system.energy(&start)).powf(-1.5);
            let method = Verlet::with_step(period / 200.0).composed(KahanLi8).max_steps(usize::MAX);
            let mut motion = Motion::new(system.clone(), start, method).unwrap();
            let mut at = |turns: f64| {
                motion.advance_to(turns * period).unwrap();
                system.energy(motion.state()) / system.energy(&start) - 1.0
            };
            let early = at(1.0);
            [at(turns as f64 / 100.0) - early, at(turns as f64) - early]
        })
        .collect();
    let spread = |k: usize| (ends.iter().map(|end| end[k].powi(2)).sum::<f64>() / 8.0).sqrt();
    let steps = turns as f64 * 200.0 * 17.0;
    println!("energy: {:.1e} after {} turns, {:.1e} after {turns}", spread(0), turns / 100, spread(1));
    // A random walk; compensated sums make its steps a seventh of a unit of round-off and shorter.
    assert!(spread(1) < 0.15 * f64::EPSILON * steps.sqrt(), "{:e}", spread(1));
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
