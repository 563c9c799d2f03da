//! Energy over many turns on constraints: rounding errors add up as a random walk does, nearly to no side that they prefer.

use lagrange_core::{StateOf, TaylorSeries, prelude::*};
use lagrange_random::cases;
use lagrange_systems::TwoBobs;

use super::constrained::Bead;
use super::{end, spherical};

const ROTOR: Bead<f64> = Bead { u: 0.0 };

/// Turns of a motion: `few` at the levels `test` and `run`, 100,000 at the level `full`.
fn turns(few: usize) -> f64 {
    cases([few, few, 100_000]) as f64
}

/// How energy may change, step by step, as a part of the most kinetic energy: to one side, and as a random walk.
struct Bound {
    drift: f64,
    walk: f64,
}

/// In steps of 2½ rad, of which the coefficients are rounded to units of round-off times e^2.5.
const LONG_STEPS: Bound = Bound { drift: 8e-18, walk: 1.5e-15 };

impl Bound {
    /// Checks the changes of energy of motions, each with its number of steps.
    fn check(&self, name: &str, motions: &[[f64; 2]]) {
        let steps: f64 = motions.iter().map(|[_, steps]| steps).sum();
        let drift = motions.iter().map(|[change, _]| change).sum::<f64>() / steps;
        let deviation = |[change, steps]: &[f64; 2]| (change - drift * steps).powi(2) / steps;
        let walk = (motions.iter().map(deviation).sum::<f64>() / motions.len() as f64).sqrt();
        let most = motions.iter().fold(0.0_f64, |most, [change, _]| most.max(change.abs()));
        println!("{name}: {drift:+.1e} and {walk:.1e} a step, {most:.1e} at most, {steps} steps");
        assert!(drift.abs() < self.drift + 4.0 * self.walk / steps.sqrt(), "{name}: {drift:e}");
        assert!(walk < self.walk, "{name}: {walk:e}");
    }
}

/// By how much energy changes until `end`, as a part of this kinetic energy, and the number of steps.
fn motion<L>(system: &L, start: StateOf<L>, end: f64, kinetic: f64) -> [f64; 2]
where
    L: TaylorSeries<Scalar = f64>,
{
    let (start, _) = system.make_consistent(&start).expect("near the constraints");
    let mut motion =
        Motion::new(system, start, Taylor::default().max_steps(usize::MAX)).expect("a consistent start");
    motion.advance_to(end).expect("a regular motion");
    let change = system.energy(motion.state()) - system.energy(&start);
    [change / kinetic, motion.statistics().accepted as f64]
}

const TURN: f64 = 2.0 * core::f64::consts::PI;

fn turning(angle: f64, rate: f64) -> State<f64, 2> {
    let (sin, cos) = angle.sin_cos();
    State::new([cos, sin], [-rate * sin, rate * cos])
}

#[test]
fn rotors_on_lanes_keep_their_energy() {
    let start = |k: usize| turning(0.7 * k as f64, 1.0);
    let rotors = Ensemble::from_fn(8, |k| (ROTOR, start(k)));
    let method = Taylor::default().max_steps(usize::MAX);
    let outcome = rotors.integrate_on_lanes(turns(1000) * TURN, method).expect("an outcome");
    assert_eq!(outcome.completed().count(), 8);
    let steps = 2.52 * turns(1000);
    let change = |(k, state): (usize, &State<f64, 2>)| 2.0 * (ROTOR.energy(state) - ROTOR.energy(&start(k)));
    let motions: Vec<_> = outcome.completed().map(|member| [change(member), steps]).collect();
    LONG_STEPS.check("rotors on lanes", &motions);
}

/// Along great circles.
#[test]
fn a_particle_on_a_sphere_keeps_its_energy() {
    let motions: Vec<_> = (0..30)
        .map(|k| (1.3 * f64::from(k), 0.1 * f64::from(k), 0.5 + 0.037 * f64::from(k)))
        .map(|(angle, tilt, rate)| {
            let (State { q, v, .. }, (up, along)) = (turning(angle, rate), tilt.sin_cos());
            let start = State::new([q[0], q[1] * along, q[1] * up], [v[0], v[1] * along, v[1] * up]);
            motion(&spherical(0.0), start, turns(200) * TURN / rate, rate * rate / 2.0)
        })
        .collect();
    LONG_STEPS.check("particle on a sphere", &motions);
}

/// By g, the angle from below, the horizontal speed there, the most kinetic energy, and the drift: from nearly in a plane to nearly on
/// a cone, and from above the suspension. There and with g = 9.81 alone it is more: 9.81 is an odd multiple of its last digit, and
/// near the lowest point, where λ z has four times that digit, each sum of the two lies half-way between two numbers and is
/// rounded to the same side.
#[test]
fn spherical_pendulums_keep_their_energy() {
    let starts = [
        (9.81, 0.3_f64, 0.095, 0.43, 1.0, 1),
        (9.81, 0.9, 1.55, 3.6, 0.6, 8),
        (9.81, 1.3, 5.28, 17.0, 2.0, 1),
        (9.81, 0.643_501_108_793_284, 1.68, 1.9, 0.6, 8),
        (9.81, 2.2, 1.33, 16.0, 3.0, 1),
        (9.8, 2.2, 1.33, 16.0, 0.5, 1),
        (9.81, 0.25 * TURN, 4.43, 13.0, 1.0, 1),
    ];
    for (g, angle, speed, kinetic, drift, count) in starts {
        let pendulum = spherical(g);
        let end = turns(100) * TURN / g.sqrt();
        let (across, height) = (angle.sin(), -angle.cos());
        let start = |State { q, v, .. }: State<f64, 2>| {
            State::new([across * q[0], across * q[1], height], [speed * v[0], speed * v[1], 0.0])
        };
        let motions: Vec<_> = (0..count)
            .map(|k| motion(&pendulum, start(turning(1.1 * f64::from(k), 1.0)), end, kinetic))
            .collect();
        Bound { drift: drift * 1e-18, walk: 2e-16 }
            .check(&format!("pendulum from {angle:.1} with g = {g}"), &motions);
    }
}

/// The constraint, and the energy over a thousand seconds: with a constraint kept to a few ulp only it grows by 4e-13.
#[test]
fn a_spherical_pendulum_keeps_what_it_keeps() -> Result<(), Error> {
    let system = spherical(9.81);
    let start = State::new([0.6, 0.0, -0.8], [0.0, 1.0, 0.0]);
    let mut motion = Motion::new(&system, start, Taylor::default())?;
    let (mut position, mut rate, mut energy) = (0.0_f64, 0.0_f64, 0.0_f64);
    for second in 1..=2000 {
        assert_eq!(motion.advance_to(f64::from(second) * 0.5), Ok(()));
        let state = motion.state();
        position = position.max(system.constraint_residual(state)[0].abs());
        rate = rate.max(system.constraint_rate(state)[0].abs());
        energy = energy.max((system.energy(state) - system.energy(&start)).abs());
    }
    assert!(
        position <= 2.0 * f64::EPSILON && rate <= 4.0 * f64::EPSILON && energy < 2e-13,
        "{position:e} {rate:e} {energy:e}"
    );
    Ok(())
}

/// On the average over motions: without the refinement of the accelerations by what is left of the constraints' equations it
/// grows by 4·10⁻¹⁴ in all of them.
#[test]
fn energy_on_rods_does_not_grow() -> Result<(), Error> {
    let system = TwoBobs { m: 1.0, g: 9.81 };
    let mut mean = 0.0;
    for k in 0..8 {
        let (sin, cos) = (0.5 + 0.1 * f64::from(k)).sin_cos();
        let start = State::at_rest([sin, -cos, 2.0 * sin, -2.0 * cos]);
        let reached = end(&system, start, 150.0)?;
        mean += 0.125 * (system.energy(&reached) - system.energy(&start));
    }
    assert!(mean.abs() < 2e-14, "{mean:e}");
    Ok(())
}
