//! Equations in angular velocities against those of the quaternions.

use std::iter::Peekable;

use super::checks::{check_line, check_sides, left_over};
use super::{Page, links, value};
use crate::mechanics::Turning;
use crate::render::formula::Formula;
use crate::render::letters::PageQuantity;
use crate::render::notation::Notation;
use crate::render::tests::systems::System;
use crate::symbolic::{Approximate, Sample, Symbol};
use crate::variables::Variable;

/// Gives quaternions that turn bodies the length 1, makes their rates keep it, and moments of inertia symmetric.
pub(super) fn make_consistent(system: &System, sample: &mut Sample) {
    for turning in &system.derived.turnings.all {
        let [q, v, a] = state(sample, turning);
        let dot = |x: [f64; 4], y: [f64; 4]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let length = dot(q, q).sqrt();
        let q = q.map(|x| x / length);
        let off = dot(q, v);
        let v = [0, 1, 2, 3].map(|k| v[k] - off * q[k]);
        let off = dot(q, a) + dot(v, v);
        let a = [0, 1, 2, 3].map(|k| a[k] - off * q[k]);
        let kinds: [fn(usize) -> Variable; 3] =
            [Variable::Coordinate, Variable::Velocity, Variable::Acceleration];
        for (kind, values) in kinds.into_iter().zip([q, v, a]) {
            let entries = values.into_iter().enumerate();
            sample.set(entries.map(|(k, x)| (kind(turning.first + k).symbol(), Approximate::exact(x))));
        }
    }
    if !system.derived.turnings.all.is_empty() || links::is_by_bodies(system) {
        make_symmetric(system, sample);
    }
}

fn make_symmetric(system: &System, sample: &mut Sample) {
    let parameters = &system.problem.parameters;
    let inertias = system.problem.bodies.iter().flat_map(|body| body.central.concat()).collect::<Vec<_>>();
    let moments: Vec<Symbol> = system.graph.symbols(&inertias).collect();
    let names: Vec<String> = (0..parameters.entries.len()).map(|k| parameters.name(k)).collect();
    let pairs = [(0, 1), (0, 2), (1, 2)];
    let is_moment = |k: &usize| moments.contains(&Variable::Parameter(*k).symbol());
    for (k, name) in names.iter().enumerate().filter(|(k, _)| is_moment(k)) {
        let transposed = pairs.iter().find_map(|(i, j)| {
            name.strip_suffix(&format!("[{i}][{j}]")).map(|whole| format!("{whole}[{j}][{i}]"))
        });
        let other = transposed.and_then(|transposed| names.iter().position(|name| *name == transposed));
        if let Some(other) = other {
            let same = sample.get(Variable::Parameter(k).symbol());
            sample.set([(Variable::Parameter(other).symbol(), same)]);
        }
    }
}

/// A quaternion with its first and second derivatives.
fn state(sample: &Sample, turning: &Turning) -> [[f64; 4]; 3] {
    let kinds: [fn(usize) -> Variable; 3] =
        [Variable::Coordinate, Variable::Velocity, Variable::Acceleration];
    kinds.map(|kind| [0, 1, 2, 3].map(|k| value(sample, kind(turning.first + k))))
}

/// ω = 2 q* q̇ and its rate 2 q* q̈, along the turned axes.
pub(super) fn angular(sample: &Sample, turning: &Turning) -> [[f64; 3]; 2] {
    let [q, v, a] = state(sample, turning);
    [v, a].map(|rate| spread(q).map(|column| 2.0 * column.iter().zip(rate).map(|(x, y)| x * y).sum::<f64>()))
}

/// q i, q j and q k for the unit quaternions i, j and k.
pub(super) fn spread([w, x, y, z]: [f64; 4]) -> [[f64; 4]; 3] {
    [[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]]
}

/// Checks q̇ = ½ q ω, and that the equations of ω are those of q along the three rotations.
pub(super) fn check<'l>(
    system: &Page,
    turning: &Turning,
    lines: &mut Peekable<impl Iterator<Item = &'l str>>,
) {
    let name = &system.problem.coordinates[turning.first].text;
    let name = name.strip_suffix("[0]").expect("a vector");
    let label = |name: &str| Notation::UNICODE.write(&Formula::labelled(name, 0));
    let line = |lines: &mut Peekable<_>, of: &str| {
        let line: &str = lines.next().unwrap_or_else(|| panic!("no line of {of} in {}", system.text));
        let (label, equation) = line.split_once(": ").expect("a label");
        assert_eq!(label, of, "{line} in {}", system.text);
        equation.trim().to_owned()
    };
    let relation = line(lines, &label(name));
    check_line(system, &relation, |sample| state(sample, turning)[1].to_vec());
    let omega = system.letters.text_of(PageQuantity::AngularVelocity, name);
    let torques = |sample: &mut Sample| {
        let along = spread(state(sample, turning)[0]);
        let forces = left_over(system, sample, turning.first..turning.first + 4);
        along.map(|column| column.iter().zip(&forces).map(|(x, y)| x * y / 2.0).sum::<f64>())
    };
    let is_by_component = lines.peek().is_some_and(|line| line.starts_with(&label(&format!("{omega}[0]"))));
    match turning.euler {
        Some(_) if !is_by_component => {
            let equation = line(lines, &label(&omega));
            if let Some((left, right)) = equation.split_once(" = ") {
                check_sides(system, 3, ([left, right], None), |sample| torques(sample).to_vec());
            }
            if let Some(inertia) =
                lines.next_if(|line| !line.contains(": ") && !links::is_resultant(system, line))
            {
                let entries =
                    turning.euler.iter().flat_map(|euler| euler.inertia).flatten().collect::<Vec<_>>();
                check_line(system, inertia, |sample| {
                    sample.values(&system.graph, &entries).iter().map(|entry| entry.value).collect()
                });
            }
        }
        _ => {
            for axis in 0..3 {
                let equation = line(lines, &label(&format!("{omega}[{axis}]")));
                if let Some((left, right)) = equation.split_once(" = ") {
                    check_sides(system, 1, ([left, right], None), |sample| vec![torques(sample)[axis]]);
                }
            }
        }
    }
}
