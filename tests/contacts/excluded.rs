//! Steps that bounds on the multipliers exclude from the search: no transition is lost, by a method that has no such bounds.
//!
//! A failure says the number of its case.

use std::fmt;

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::motion::{Limits, MultiplierBounds, Step};
use lagrange_core::{Error, Method, StateOf, Statistics, prelude::*};

use lagrange_random::Random;

use crate::kinds;

/// A method without bounds on multipliers, so that all events of contacts are searched in every step.
#[derive(Clone, Copy)]
struct Searching<P>(P);

impl<L: Lagrangian<Scalar = f64>, P: Method<L>> Method<L> for Searching<P> {
    type Memory = P::Memory;
    type Interpolant = P::Interpolant;

    fn limits(&self) -> Limits {
        self.0.limits()
    }

    fn identify(&self, to: &mut dyn fmt::Write) -> fmt::Result {
        self.0.identify(to)
    }

    fn check(&self) -> Result<(), Error> {
        self.0.check()
    }

    fn begin(&self, system: &L, start: &StateOf<L>, statistics: &mut Statistics) -> Result<P::Memory, Error> {
        self.0.begin(system, start, statistics)
    }

    fn step(
        &self,
        system: &L,
        memory: &mut P::Memory,
        end: f64,
        from: &StateOf<L>,
        to: &mut StateOf<L>,
        statistics: &mut Statistics,
    ) -> Step {
        self.0.step(system, memory, end, from, to, statistics)
    }

    fn interpolant(
        &self,
        system: &L,
        memory: &mut P::Memory,
        ends: [&StateOf<L>; 2],
        statistics: &mut Statistics,
    ) -> Result<P::Interpolant, Error> {
        self.0.interpolant(system, memory, ends, statistics)
    }

    fn multiplier_bounds(
        &self,
        _: &L,
        _: &P::Memory,
        _: &mut Statistics,
    ) -> Option<MultiplierBounds<f64, L::M>> {
        None
    }

    fn undo(&self, memory: &mut P::Memory) -> bool {
        self.0.undo(memory)
    }
}

/// A block on a rough floor, on a spring, that is pulled to and fro, under a load that swings, has a pulse in time and a bump in
/// space: the force of the floor goes to zero though no acceleration tells of it. Of pulse and bump: size, place, width.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - k*x^2/2 + pull[0]*x*sin(pull[1]*t) - load*y)]
#[define(pulsed = pulse[0]*exp(-((t - pulse[1])/pulse[2])^2) + bump[0]*exp(-((x - bump[1])/bump[2])^2))]
#[define(load = 1 + swing[0]*sin(swing[1]*t + swing[2]) - pulsed)]
#[contact(floor: y >= 0, restitution: 0.3, friction(mu): x_dot)]
struct Block {
    k: f64,
    pull: [f64; 2],
    swing: [f64; 3],
    pulse: [f64; 3],
    bump: [f64; 3],
    mu: f64,
    floor: Contact,
}

impl Block {
    fn any(random: &mut Random) -> Self {
        let mut sometimes = |most: f64| if random.below(2) == 0 { 0.0 } else { random.between(0.0, most) };
        let [pull, swing, pulse, bump] = [3.0, 1.1, 1.5, 1.5].map(&mut sometimes);
        Self {
            k: random.between(0.0, 2.0),
            pull: [pull, random.size(0.1, 10.0)],
            swing: [swing, random.size(0.1, 30.0), random.between(0.0, 6.3)],
            pulse: [pulse, random.between(0.0, 5.0), random.size(0.1, 3.0)],
            bump: [bump, random.between(-1.0, 1.0), random.size(0.1, 3.0)],
            mu: random.size(0.1, 2.0),
            floor: Contact::Closed,
        }
    }
}

/// A motion; or why there is none.
fn moved(
    block: &Block,
    start: State<f64, 2>,
    method: impl Method<Block>,
) -> Result<Trajectory<Block>, String> {
    let motion = block.motion(start).by(method).with_contacts().max_transitions(40);
    motion.towards(6.0).map_err(|error| error.to_string())
}

/// Its transitions: time and kind, with what they are of.
fn transitions(path: &Trajectory<Block>) -> Vec<(f64, String)> {
    let times = path.transitions().iter().map(Transition::time);
    times.zip(kinds(path)).collect()
}

/// Part of the step at this time in which the force of the floor is nearer to its least than to its value at most times; 1.67
/// widths of a pulse exp(−(t/w)²).
fn width_of_dip(path: &Trajectory<Block>, time: f64) -> f64 {
    let steps = || path.legs().iter().flat_map(|leg| leg.steps().map(|step| step.state().t));
    let start = steps().filter(|&t| t <= time).fold(0.0, f64::max);
    let end = steps().filter(|&t| t > time).fold(6.0, f64::min);
    let at = |k: usize| path.at(start + (end - start) * (k as f64 + 0.5) / 1000.0);
    let mut forces: Vec<f64> = (0..1000).filter_map(|k| at(k).ok()?.multiplier("floor").ok()).collect();
    forces.sort_by(f64::total_cmp);
    let half = (forces[0] + forces[forces.len() / 2]) / 2.0;
    forces.iter().filter(|force| **force < half).count() as f64 / 1000.0
}

/// The first transition that one motion has and the other has not, with the time of the one that is lost.
fn lost(found: &[(f64, String)], all: &[(f64, String)]) -> Option<(f64, String)> {
    let is_other = |k: &usize| match (found.get(*k), all.get(*k)) {
        (Some(one), Some(other)) => one.1 != other.1 || (one.0 - other.0).abs() > 1e-6,
        _ => true,
    };
    let k = (0..found.len().max(all.len())).find(is_other)?;
    let time = all.get(k).or(found.get(k))?.0;
    Some((time, format!("transition {k}: {:?}, not {:?}", found.get(k), all.get(k))))
}

/// Width of the dip that is lost with a transition, with what is lost; and the number of transitions.
fn fault(k: u64) -> (Option<(f64, String)>, usize) {
    let mut random = Random(k.wrapping_mul(0x5851_f42d_4c95_7f2d));
    let block = Block::any(&mut random);
    let speed = if random.below(2) == 0 { 0.0 } else { random.between(-2.0, 2.0) };
    let start = State::new([random.between(-1.0, 1.0), 0.0], [speed, 0.0]);
    let tolerance = [1e-3, 1e-6, 1e-9, 1e-12][random.below(4)];
    match k % 2 {
        0 => fault_of(&block, start, Dop853::with_tolerance(tolerance)),
        _ => fault_of(&block, start, Dopri5::with_tolerance(tolerance)),
    }
}

/// The same by this method.
fn fault_of(
    block: &Block,
    start: State<f64, 2>,
    pair: impl Method<Block> + Copy,
) -> (Option<(f64, String)>, usize) {
    let all = moved(block, start, Searching(pair)).map(|path| transitions(&path));
    match (moved(block, start, pair), all) {
        (Ok(path), Ok(all)) => {
            let found = lost(&transitions(&path), &all).map(|(time, fault)| {
                let dip = width_of_dip(&path, time);
                (dip, format!("{fault}, in a dip {dip} steps wide"))
            });
            (found, all.len())
        }
        (found, all) => {
            let found = found.map(|path| transitions(&path));
            ((found != all).then(|| (1.0, format!("{found:?}, not {all:?}"))), 0)
        }
    }
}

/// Width of a dip from which on no step is excluded: 1.67 times that of a pulse.
const WIDTH: f64 = 1.67 * 0.15;

#[test]
fn no_transition_is_lost() {
    let (cases, mut transitions) = (lagrange_random::cases([20, 60, 30_000]) as u64, 0);
    // Of pulses narrower than that the search sees some.
    let [mut lost, mut narrow] = [0; 2];
    for k in 0..cases {
        let (fault, count) = fault(k);
        transitions += count;
        if let Some((width, fault)) = fault {
            lost += u64::from(width >= WIDTH);
            narrow += u64::from(width < WIDTH);
            println!("{k}: {fault}");
        }
    }
    assert!(transitions as u64 > cases / 2, "{transitions} transitions");
    assert_eq!(lost, 0, "{lost} of {cases} motions, with {transitions} transitions");
    assert!(narrow <= 1 + cases / 5_000, "{narrow} of {cases} motions, with {transitions} transitions");
}
