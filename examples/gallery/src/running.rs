//! A system that runs, with what has been of its motion.

use std::collections::VecDeque;

use lagrange_core::facts::{Conserved, EnergyForm};
use lagrange_core::generic::Array;
use lagrange_core::{Method, StateOf, prelude::*};

use crate::exhibit::{Exhibit, Moment, Moves, Units};
use crate::scene::{Point, Scene, View};

/// How many frames are kept: two minutes of watching.
const KEPT: usize = 7200;
/// Frames in a second of watching.
const RATE: f64 = 60.0;
/// How many frames a trail is long.
const TRAIL: usize = 900;
/// Of so many constraints the multipliers are plotted.
const PLOTTED: usize = 6;

/// A quantity that is plotted.
#[derive(Clone, Debug)]
pub(crate) struct Quantity {
    pub(crate) name: &'static str,
    pub(crate) kind: &'static str,
    /// Its unit, or nothing.
    pub(crate) unit: &'static str,
}

impl Quantity {
    /// Finds the unit of a quantity; one of a family is named by the family.
    fn new(kind: &'static str, name: &'static str, units: Option<Units>) -> Self {
        let family = name.split('[').next();
        let listed = units.unwrap_or_default().iter().find(|(known, _)| Some(*known) == family);
        let is_energy = kind == "energy" || name == "energy";
        let unit = if is_energy && units.is_some() { "J" } else { listed.map_or("", |(_, unit)| unit) };
        Self { name, kind, unit }
    }
}

/// Any exhibit that runs.
pub(crate) trait Running {
    fn advance(&mut self, end: f64) -> Result<(), String>;
    fn span(&self) -> [f64; 2];
    fn view(&self, t: f64) -> View;
    fn scene(&self, t: f64, with_forces: bool) -> Vec<f32>;
    fn state(&self, t: f64) -> Vec<f64>;
    fn quantities(&self) -> Vec<Quantity>;
    fn times(&self, from: f64, to: f64) -> Vec<f64>;
    fn series(&self, quantity: usize, from: f64, to: f64) -> Vec<f64>;
}

/// A system at its start, or why it cannot start.
pub(crate) type Opened = Result<Box<dyn Running>, String>;

/// What is kept of a frame.
struct Frame<E: Lagrangian> {
    /// The system, with its contacts as they are then.
    system: E,
    state: StateOf<E>,
    values: Vec<f64>,
    trails: Vec<Point>,
}

struct Live<E, const K: usize>
where
    E: Exhibit<K>,
    Dop853: Method<E>,
{
    motion: Box<dyn Moves<E>>,
    frames: VecDeque<Frame<E>>,
    /// How many frames came before those that are kept.
    forgotten: usize,
}

/// The exhibit with its sliders at these values, at its start.
pub(crate) fn open<E, const K: usize>(knobs: &[f64]) -> Opened
where
    E: Exhibit<K>,
    Dop853: Method<E>,
{
    let knobs = knobs.try_into().map_err(|_| format!("{} has {K} sliders", E::NAME))?;
    let (system, start) = E::set(knobs);
    let (start, _) = system.make_consistent(&start).map_err(|error| error.to_string())?;
    let motion = system.begin(start).map_err(|error| error.to_string())?;
    let mut live = Live { motion, frames: VecDeque::new(), forgotten: 0 };
    live.record();
    Ok(Box::new(live))
}

impl<E, const K: usize> Live<E, K>
where
    E: Exhibit<K>,
    Dop853: Method<E>,
{
    /// How far frames are apart.
    const STEP: f64 = E::PACE / RATE;

    fn record(&mut self) {
        let (system, state) = (self.motion.system(), *self.motion.state());
        let (system, trails) = (system.clone(), system.trails(&state));
        let frame = Frame { state, values: self.values(&state), trails, system };
        self.frames.push_back(frame);
        if self.frames.len() > KEPT {
            self.frames.pop_front();
            self.forgotten += 1;
        }
    }

    /// What [`quantities`](Running::quantities) names.
    fn values(&self, state: &StateOf<E>) -> Vec<f64> {
        let system = self.motion.system();
        let (energy, lagrangian) = (system.energy(state), system.lagrangian(state));
        let mut values = vec![energy];
        if matches!(E::FACTS.energy_form, EnergyForm::Sum(_) | EnergyForm::Even(_)) {
            values.extend([f64::midpoint(energy, lagrangian), f64::midpoint(energy, -lagrangian)]);
        }
        let conserved = (0..Self::conserved().len()).filter_map(|index| system.conserved(index, state));
        values.extend(conserved);
        values.extend(Self::moment(system, state).multipliers.iter().take(PLOTTED));
        values
    }

    /// What is conserved; impacts and friction keep nothing that is known beforehand.
    fn conserved() -> &'static [Conserved] {
        if E::HAS_CONTACTS { &[] } else { E::FACTS.conserved }
    }

    /// Forces are not a number where they cannot be solved for.
    fn moment(system: &E, state: &StateOf<E>) -> Moment<E> {
        let unknown = Array::filled(f64::NAN).into();
        let multipliers = system.solve(state).map_or(unknown, |solution| solution.multipliers);
        Moment { state: *state, multipliers, force: system.constraint_force(state, &multipliers) }
    }

    /// The last frame that is not later.
    fn index(&self, t: f64) -> usize {
        let index = (t / Self::STEP + 1e-6).floor().max(0.0) as usize;
        index.saturating_sub(self.forgotten).min(self.frames.len() - 1)
    }

    /// Between two frames by the cubic through both, whose error is that of a picture. Across contacts, where velocities
    /// jump, by the line.
    fn at(&self, t: f64) -> StateOf<E> {
        let index = self.index(t);
        let before = self.frames[index].state;
        let Some(after) = self.frames.get(index + 1) else {
            return before;
        };
        let (after, h) = (after.state, after.state.t - before.t);
        let s = ((t - before.t) / h).clamp(0.0, 1.0);
        let rise = s * s * (3.0 - 2.0 * s);
        let [leaving, coming] = [s * (1.0 - s) * (1.0 - s) * h, s * s * (s - 1.0) * h];
        let [rise, leaving, coming] = if E::HAS_CONTACTS { [s, 0.0, 0.0] } else { [rise, leaving, coming] };
        let q =
            |i| before.q[i] * (1.0 - rise) + after.q[i] * rise + before.v[i] * leaving + after.v[i] * coming;
        let v = |i| before.v[i] * (1.0 - s) + after.v[i] * s;
        StateOf::<E>::new(Array::from_fn(q), Array::from_fn(v)).at_time(before.t + s * h)
    }
}

impl<E, const K: usize> Running for Live<E, K>
where
    E: Exhibit<K>,
    Dop853: Method<E>,
{
    fn advance(&mut self, end: f64) -> Result<(), String> {
        loop {
            let next = Self::STEP * (self.forgotten + self.frames.len()) as f64;
            if next > end {
                return Ok(());
            }
            self.motion.advance(next)?;
            self.record();
        }
    }

    fn span(&self) -> [f64; 2] {
        [self.frames[0].state.t, self.motion.state().t]
    }

    fn view(&self, t: f64) -> View {
        self.frames[self.index(t)].system.view(&self.at(t))
    }

    fn scene(&self, t: f64, with_forces: bool) -> Vec<f32> {
        let last = self.index(t);
        let system = &self.frames[last].system;
        let moment = Self::moment(system, &self.at(t));
        let mut scene = Scene::new(&system.view(&moment.state), with_forces);
        let trails = &self.frames[last].trails;
        for k in 0..trails.len() {
            let frames = self.frames.range(last.saturating_sub(TRAIL)..=last);
            let mut trail: Vec<Point> = frames.map(|frame| frame.trails[k]).collect();
            trail.extend(system.trails(&moment.state).get(k));
            scene.trail(&trail);
        }
        system.draw(&moment, &mut scene);
        scene.into_numbers()
    }

    fn state(&self, t: f64) -> Vec<f64> {
        let state = self.at(t);
        state.q.iter().chain(&state.v).copied().collect()
    }

    fn quantities(&self) -> Vec<Quantity> {
        let named = |kind| move |name| Quantity::new(kind, name, E::UNITS);
        let mut quantities = vec![named("energy")("E")];
        if matches!(E::FACTS.energy_form, EnergyForm::Sum(_) | EnergyForm::Even(_)) {
            quantities.extend(["T", "U"].map(named("energy")));
        }
        quantities.extend(Self::conserved().iter().map(|conserved| named("conserved")(conserved.name)));
        quantities.extend(E::CONSTRAINTS.iter().copied().take(PLOTTED).map(named("multiplier")));
        quantities
    }

    fn times(&self, from: f64, to: f64) -> Vec<f64> {
        self.frames.range(self.index(from)..=self.index(to)).map(|frame| frame.state.t).collect()
    }

    fn series(&self, quantity: usize, from: f64, to: f64) -> Vec<f64> {
        let value = |frame: &Frame<E>| frame.values.get(quantity).copied().unwrap_or(f64::NAN);
        self.frames.range(self.index(from)..=self.index(to)).map(value).collect()
    }
}
