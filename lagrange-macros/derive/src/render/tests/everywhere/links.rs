//! Angular velocities, positions and their partial derivatives, by differences of the orientations and positions of frames.

use super::turns::spread;
use super::{Page, Value, outer, potential, value};
use crate::mechanics::Turning;
use crate::render::formula::Formula;
use crate::render::letters::PageQuantity;
use crate::render::links::{BodyNames, LinkNames};
use crate::render::tests::systems::System;
use crate::symbolic::{Approximate, Id, Rational, Sample};
use crate::variables::Variable;

/// Coefficients of f(h k) − f(−h k) in h f′(0), for k = 1 … 4, with an error in h⁸.
pub(super) const FIRST: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
/// Coefficients of f(h k) − 2 f(0) + f(−h k) in h² f″(0).
const SECOND: [f64; 4] = [8.0 / 5.0, -1.0 / 5.0, 8.0 / 315.0, -1.0 / 560.0];
pub(super) const STEP: f64 = 0.01;

/// Time, coordinates, and their first and second derivatives along a curve.
pub(super) struct Curve {
    start: Vec<f64>,
    rates: [Vec<f64>; 2],
}

impl Curve {
    /// What time moves while the coordinates rest.
    fn of_time(system: &System, sample: &Sample) -> Self {
        let at_rest = vec![0.0; system.problem.coordinates.len()];
        let mut curve = Self::of(system, sample, Some(&at_rest));
        curve.rates[0][at_rest.len()] = 1.0;
        curve
    }

    /// The motion of a sample, or the displacement of its coordinates at these rates.
    pub(super) fn of(system: &System, sample: &Sample, rates: Option<&[f64]>) -> Self {
        let n = system.problem.coordinates.len();
        let all = |kind: fn(usize) -> Variable| (0..n).map(move |i| value(sample, kind(i)));
        let start = all(Variable::Coordinate).chain([value(sample, Variable::Time)]).collect();
        let rates = match rates {
            Some(rates) => [[rates, &[0.0]].concat(), vec![0.0; n + 1]],
            None => [
                all(Variable::Velocity).chain([1.0]).collect(),
                all(Variable::Acceleration).chain([0.0]).collect(),
            ],
        };
        Self { start, rates }
    }

    /// Values of nodes at a time after the start.
    fn at(&self, system: &System, sample: &Sample, nodes: &[Id], time: f64) -> Vec<f64> {
        self.moved(sample, time).values(&system.graph, nodes).iter().map(|entry| entry.value).collect()
    }

    /// The state at a time after the start, with the accelerations of the start.
    pub(super) fn moved(&self, sample: &Sample, time: f64) -> Sample {
        let mut sample = sample.clone();
        let place = |i: usize| {
            let last = self.start.len() - 1;
            if i == last { Variable::Time } else { Variable::Coordinate(i) }
        };
        let moved = self.start.iter().enumerate().map(|(i, &x)| {
            let x = x + time * self.rates[0][i] + 0.5 * time * time * self.rates[1][i];
            (place(i).symbol(), Approximate::exact(x))
        });
        let velocities = self.rates[1].iter().enumerate().take(self.start.len() - 1).map(|(i, a)| {
            let velocity = Variable::Velocity(i);
            (velocity.symbol(), Approximate::exact(value(&sample, velocity) + time * a))
        });
        let all: Vec<_> = moved.chain(velocities).collect();
        sample.set(all);
        sample
    }

    /// Values of nodes with their first and second derivatives along the curve.
    fn derivatives(&self, system: &System, sample: &Sample, nodes: &[Id]) -> [Vec<f64>; 3] {
        let at = |k: f64| self.at(system, sample, nodes, k * STEP);
        let start = at(0.0);
        let mut found = [start.clone(), vec![0.0; nodes.len()], vec![0.0; nodes.len()]];
        for k in 0..4 {
            let [after, before] = [1.0, -1.0].map(|sign| at(sign * (k + 1) as f64));
            for i in 0..nodes.len() {
                found[1][i] += FIRST[k] * (after[i] - before[i]) / STEP;
                found[2][i] += SECOND[k] * (after[i] - 2.0 * start[i] + before[i]) / (STEP * STEP);
            }
        }
        found
    }

    /// Angular velocity and its rate, along the axes with this matrix: the antisymmetric parts of AᵀȦ and AᵀÄ.
    fn turning(&self, system: &System, sample: &Sample, axes: &[[Id; 3]; 3]) -> [Value; 2] {
        let [a, first, second] = self.derivatives(system, sample, &axes.concat());
        [first, second].map(|rate| {
            let entry = |i: usize, j: usize| (0..3).map(|k| a[3 * k + i] * rate[3 * k + j]).sum::<f64>();
            [(2, 1), (0, 2), (1, 0)].map(|(i, j)| 0.5 * (entry(i, j) - entry(j, i))).to_vec()
        })
    }
}

/// Values of A, ω, ω̇, Ω, r, ṙ and r̈ of the bodies of a page, by name, and those of Aᵀ.
pub(super) fn values(system: &Page, sample: &Sample) -> Vec<(Formula, Value)> {
    let mut all = Vec::new();
    let Some((names, resultants)) = named(system) else { return all };
    let curve = Curve::of(system, sample, None);
    let name = Formula::labelled;
    for (own, link) in names.links.iter().zip(&resultants.links) {
        let axes = &system.problem.frames[link.frame].axes;
        let [rate, change] = curve.turning(system, sample, axes);
        all.extend([(name(&own.rate, 0), rate), (name(&own.rate, 1), change)]);
        if let Some(imposed) = own.imposed.as_ref().filter(|imposed| **imposed != own.rate) {
            let [imposed_rate, _] = Curve::of_time(system, sample).turning(system, sample, axes);
            all.push((name(imposed, 0), imposed_rate));
        }
        if let Some(matrix) = &own.axes {
            let entries = curve.at(system, sample, &axes.concat(), 0.0);
            let transpose = (0..9).map(|k| entries[3 * (k % 3) + k / 3]).collect();
            all.push((name(matrix, 0), entries));
            all.push((Formula::Transpose(Box::new(name(matrix, 0))), transpose));
        }
    }
    for (own, body) in names.bodies.iter().zip(&resultants.bodies) {
        let derivatives = curve.derivatives(system, sample, &body.position);
        all.extend(
            derivatives.into_iter().enumerate().map(|(dots, value)| (name(&own.position, dots), value)),
        );
    }
    all
}

pub(super) fn named<'s>(system: &'s Page) -> Option<(BodyNames, &'s crate::mechanics::Resultants)> {
    let names = is_by_bodies(system)
        .then(|| BodyNames::of(&system.problem, &system.derived, &system.letters))
        .flatten();
    names.zip(system.derived.resultants.as_ref())
}

/// Value of ∂ω/∂u, of ∂ṙ/∂u, or of a derivative of a definition or a constraint; `None` of another function.
pub(super) fn partial(system: &Page, sample: &Sample, function: &str, by: &str) -> Option<Value> {
    let (names, resultants) = named(system)?;
    let written = |text: &str, dots| system.written(&Formula::labelled(text, dots));
    if by == "t" {
        return by_time(system, sample, function);
    }
    let n = system.problem.coordinates.len();
    let unit = |i: usize| (0..n).map(|j| f64::from(u8::from(i == j))).collect::<Vec<f64>>();
    let coordinate = |dots| (0..n).find(|&i| written(&system.problem.coordinates[i].text, dots) == by);
    let along = |i: usize| Curve::of(system, sample, Some(&unit(i)));
    if potential::is_it(system, function) {
        let along = coordinate(0).map(Variable::Coordinate).or_else(|| coordinate(1).map(Variable::Velocity));
        return Some(vec![potential::slope(system, sample, along?)]);
    }
    let of_turning = |turning: &Turning| {
        let text = system.problem.coordinates[turning.first].text.strip_suffix("[0]")?;
        let axis = (0..3).find(|axis| {
            written(&system.letters.text_of(PageQuantity::AngularVelocity, &format!("{text}[{axis}]")), 0)
                == by
        })?;
        let q = [0, 1, 2, 3].map(|k| value(sample, Variable::Coordinate(turning.first + k)));
        let mut rates = vec![0.0; n];
        (0..4).for_each(|k| rates[turning.first + k] = 0.5 * spread(q)[axis][k]);
        Some(rates)
    };
    let turnings = &system.derived.turnings.all;
    let rates = || coordinate(1).map(unit).or_else(|| turnings.iter().find_map(of_turning));
    let nodes = nodes_of(system, function, 0);
    if !nodes.is_empty() {
        let by_coordinate = coordinate(0).map(|i| along(i).derivatives(system, sample, &nodes)[1].clone());
        return by_coordinate.or_else(|| Some(by_velocity(system, sample, &nodes, &rates()?)));
    }
    let curve = Curve::of(system, sample, Some(&rates()?));
    let nodes = nodes_of(system, function, 1);
    if !nodes.is_empty() {
        return Some(curve.derivatives(system, sample, &nodes)[1].clone());
    }
    let link = names.links.iter().position(|own| written(&own.rate, 0) == function);
    let body = names.bodies.iter().position(|own| written(&own.position, 1) == function);
    let axes = |link: usize| &system.problem.frames[resultants.links[link].frame].axes;
    let rate = link.map(|link| curve.turning(system, sample, axes(link))[0].clone());
    let position = |body: usize| &resultants.bodies[body].position;
    rate.or_else(|| Some(curve.derivatives(system, sample, position(body?))[1].clone()))
}

/// First and second derivatives of all definitions along the motion, if the page is by bodies.
pub(super) fn rates_of_definitions(system: &Page, sample: &Sample) -> Vec<(Formula, f64)> {
    if named(system).is_none() {
        return Vec::new();
    }
    let mut definitions: Vec<(&Id, &String)> = system.problem.names.iter().collect();
    definitions.sort();
    let nodes: Vec<Id> = definitions.iter().map(|(id, _)| **id).collect();
    let derivatives = Curve::of(system, sample, None).derivatives(system, sample, &nodes);
    let all = (1..3).flat_map(|dots| {
        definitions
            .iter()
            .zip(&derivatives[dots])
            .map(move |((_, name), &x)| (Formula::labelled(name, dots), x))
    });
    all.collect()
}

/// Value of ∂r/∂t with the coordinates held, of a definition likewise, or of ∂ṙ/∂t or ∂ω/∂t with the velocities held, too, or of a component.
fn by_time(system: &Page, sample: &Sample, function: &str) -> Option<Value> {
    let (names, resultants) = named(system)?;
    if potential::is_it(system, function) {
        return Some(vec![potential::slope(system, sample, Variable::Time)]);
    }
    let nodes = nodes_of(system, function, 0);
    if !nodes.is_empty() {
        return Some(Curve::of_time(system, sample).derivatives(system, sample, &nodes)[1].clone());
    }
    let entries = |text: &str, dots: usize, value: Value| {
        let all = with_entries(&Formula::labelled(text, dots), value);
        all.into_iter().find(|(name, _)| system.written(name) == function).map(|(_, value)| value)
    };
    // All of it later, and at the same coordinates and velocities.
    let rate = |at: &dyn Fn(&Sample) -> Value| -> Value {
        let later = |time: f64| {
            let mut sample = sample.clone();
            let start = value(&sample, Variable::Time);
            sample.set([(Variable::Time.symbol(), Approximate::exact(start + time))]);
            at(&sample)
        };
        let change = |k: usize| {
            let [after, before] = [1.0, -1.0].map(|sign| later(sign * (k + 1) as f64 * STEP));
            after
                .iter()
                .zip(before)
                .map(|(after, before)| FIRST[k] * (after - before) / STEP)
                .collect::<Value>()
        };
        (0..4)
            .map(change)
            .reduce(|sum, part| sum.iter().zip(part).map(|(x, y)| x + y).collect())
            .expect("steps")
    };
    let motion = |sample: &Sample| Curve::of(system, sample, None);
    let of_bodies = names.bodies.iter().zip(&resultants.bodies).find_map(|(own, body)| {
        let moved =
            |time: &Sample| Curve::of_time(system, time).derivatives(system, time, &body.position)[1].clone();
        let velocity = |time: &Sample| motion(time).derivatives(system, time, &body.position)[1].clone();
        entries(&own.position, 0, moved(sample)).or_else(|| entries(&own.position, 1, rate(&velocity)))
    });
    let of_links = || {
        names.links.iter().zip(&resultants.links).find_map(|(own, link)| {
            let axes = &system.problem.frames[link.frame].axes;
            let turning = |time: &Sample| motion(time).turning(system, time, axes)[0].clone();
            entries(&own.rate, 0, rate(&turning))
        })
    };
    let of_definitions = || {
        let nodes = nodes_of(system, function, 1);
        let velocity = |time: &Sample| motion(time).derivatives(system, time, &nodes)[1].clone();
        (!nodes.is_empty()).then(|| rate(&velocity))
    };
    of_bodies.or_else(of_links).or_else(of_definitions)
}

/// Nodes of the definitions or the constraints of which a name has this many dots.
fn nodes_of(system: &Page, function: &str, dots: usize) -> Vec<Id> {
    let constraints = system.problem.constraints.iter().map(|(label, node)| (&label.text, *node));
    let mut definitions: Vec<_> = system.problem.names.iter().map(|(node, name)| (name, *node)).collect();
    definitions.sort();
    let all = constraints.chain(definitions).filter(|(name, _)| is_in(system, function, name, dots));
    all.map(|(_, node)| node).collect()
}

fn is_in(system: &Page, function: &str, name: &str, dots: usize) -> bool {
    let entry = Formula::labelled(name, dots);
    outer(&entry).into_iter().chain([entry]).any(|formula| system.written(&formula) == function)
}

/// Derivatives along rates of the coordinates of nodes that are linear in the velocities.
fn by_velocity(system: &Page, sample: &Sample, nodes: &[Id], rates: &[f64]) -> Vec<f64> {
    let at = |more: f64| {
        let mut sample = sample.clone();
        let moved = rates.iter().enumerate().map(|(i, rate)| {
            let velocity = Variable::Velocity(i);
            (velocity.symbol(), Approximate::exact(value(&sample, velocity) + more * rate))
        });
        let moved: Vec<_> = moved.collect();
        sample.set(moved);
        sample.values(&system.graph, nodes)
    };
    at(1.0).iter().zip(at(0.0)).map(|(after, before)| after.value - before.value).collect()
}

/// Checks the lines of A, ω, Ω and r.
pub(super) fn check(system: &Page) {
    let Some((names, _)) = named(system) else { return };
    let lines = system.lines("Lagrangian\n");
    let of_link = |own: &'_ LinkNames| [own.axes.clone(), Some(own.rate.clone()), own.imposed.clone()];
    let of_links = names.links.iter().flat_map(of_link).flatten();
    for text in of_links.chain(names.bodies.iter().map(|own| own.position.clone())) {
        let formula = Formula::labelled(&text, 0);
        let start = system.written(&formula) + " = ";
        for line in lines.iter().filter(|line| line.starts_with(&start)) {
            super::checks::check_line(system, line, |sample| {
                values(system, sample).into_iter().find(|(name, _)| *name == formula).expect("a value").1
            });
        }
    }
}

/// A vector or a matrix of three by three, and its entries.
pub(super) fn with_entries(name: &Formula, value: Value) -> Vec<(Formula, Value)> {
    let index = |name: Formula, k: usize| name.indexed(Formula::Number(Rational::from_integer(k as i128)));
    let entry = |k: usize| match value.len() {
        3 => index(name.clone(), k),
        _ => index(index(name.clone(), k / 3), k % 3),
    };
    let mut all: Vec<_> = value.iter().enumerate().map(|(k, &x)| (entry(k), vec![x])).collect();
    all.push((name.clone(), value));
    all
}

/// True for a line of F, N or I of a body.
pub(super) fn is_resultant(system: &Page, line: &str) -> bool {
    resultants(system).iter().any(|name| line.starts_with(&format!("{} = ", system.written(name))))
}

/// F, N and I, each after those in its definition.
pub(super) fn resultants(system: &Page) -> Vec<Formula> {
    let Some((names, _)) = named(system) else { return Vec::new() };
    let inertias = names.bodies.iter().map(|own| &own.inertia);
    let others = names.bodies.iter().flat_map(|own| [&own.force, &own.torque]);
    inertias.chain(others).map(|text| Formula::labelled(text, 0)).collect()
}

/// True if a page defines the names of bodies.
pub(super) fn is_by_bodies(system: &System) -> bool {
    let Some(names) = BodyNames::of(&system.problem, &system.derived, &system.letters) else { return false };
    let links = names.links.iter().filter(|own| !own.is_known);
    let links = links.flat_map(|own| own.axes.iter().chain([&own.rate]));
    let bodies = names.bodies.iter().flat_map(|own| [&own.position, &own.force, &own.torque]);
    let written =
        |text: &String| crate::render::notation::Notation::UNICODE.write(&Formula::labelled(text, 0));
    let mut written = links.chain(bodies).map(written);
    written.any(|name| system.forms.iter().any(|form| form[0].contains(&format!("\n  {name} = "))))
}
