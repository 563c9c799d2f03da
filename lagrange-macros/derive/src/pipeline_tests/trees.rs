//! Random trees of frames, with joints, bodies, loads and constraints of every kind. Compares accelerations and
//! multipliers with the Newton–Euler equations of every body, which have the joint forces as unknowns.

mod algebra;
mod draft;
mod forest;
mod joints;
mod loads;
mod long;
mod model;
mod oracle;
mod split;

use std::collections::BTreeMap;

use lagrange_random::cases;

use super::equations;
use crate::codegen::solutions;
use crate::resolve::Problem;
use crate::symbolic::Symbol;
use crate::variables::Variable;
use draft::Draft;
use oracle::Solution;

/// Largest accepted error, relative to the largest entry.
const TOLERANCE: f64 = 1e-10;

#[test]
fn the_accelerations_are_those_of_newton_and_euler() {
    let trees = cases([12, 60, 500]) as u64;
    let (mut worst, mut counts) = (0.0_f64, BTreeMap::new());
    for number in 0..trees.max(60) {
        let draft = forest::tree(number);
        if number < trees {
            worst = worst.max(checked(number, &draft));
        }
        for (what, count) in draft.counts {
            *counts.entry(what).or_insert(0) += count;
        }
    }
    println!("{trees} trees, the worst {worst:.1e} of the largest entry off: {counts:?}");
    for what in joints::KINDS.map(|(name, ..)| name).into_iter().chain(loads::LOADS.map(|(name, ..)| name)) {
        assert!(counts.contains_key(what), "{what}: there is none");
    }
}

/// Largest error of all forms against the oracle, relative to the largest entry.
fn checked(number: u64, draft: &Draft) -> f64 {
    let source = draft.source();
    let (graph, problem, equations) = equations(&source);
    let Solution { accelerations, multipliers, pivot } = oracle::solve(&draft.model);
    assert!(pivot > 1e-6, "tree {number} is all but singular: {pivot:e}\n{source}");
    let multipliers: Vec<f64> =
        problem.constraints.iter().map(|(label, _)| multipliers[draft.multiplier(&label.text)]).collect();
    let largest = |x: &[f64]| x.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    // The multipliers may all be zero, so the accelerations enter their scale.
    let scale = largest(&accelerations).max(1e-3);
    let scales = [scale, scale.max(largest(&multipliers))];
    let found = solutions(&graph, &equations, |symbol| input(draft, &problem, symbol));
    assert!(found.iter().any(Option::is_some), "tree {number} is left to loops\n{source}");
    let mut worst = 0.0_f64;
    for (form, solution) in found.iter().enumerate() {
        let Some((pivot, entries)) = solution.as_ref().and_then(|solution| solution.split_last()) else {
            continue;
        };
        let (first, second) = entries.split_at(accelerations.len());
        assert!(*pivot > 0.0, "tree {number}, form {form}: the pivot is {pivot:e}\n{source}");
        for (found, expected, scale) in
            [(first, &accelerations, scales[0]), (second, &multipliers, scales[1])]
        {
            for (i, (x, y)) in found.iter().zip(expected).enumerate() {
                let off = (x - y).abs() / scale;
                assert!(
                    off < TOLERANCE,
                    "tree {number}, form {form}, entry {i}: {x:e}, not {y:e}, of {scale:e}\n{source}"
                );
                worst = worst.max(off);
            }
        }
    }
    worst
}

fn input(draft: &Draft, problem: &Problem, symbol: Symbol) -> f64 {
    let model = &draft.model;
    match Variable::of(symbol) {
        Variable::Time => model.time,
        Variable::Coordinate(i) => model.coordinates[i],
        Variable::Velocity(i) => model.velocities[i],
        Variable::Parameter(k) => {
            let entry = problem.parameters.entries[k];
            draft.number(&problem.parameters.fields[entry.field].name.text, entry.number)
        }
        other => panic!("the solution depends on {other:?}"),
    }
}
