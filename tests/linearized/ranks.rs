//! Matrices of every rank: constraints that depend on one another, and equilibria in families, drawn at random.

use lagrange_core::nalgebra::{DMatrix, DVector};
use lagrange_core::prelude::*;

use lagrange_random::{Random, cases};

/// Four rows in six directions, of which `rank` are independent.
fn rows(random: &mut Random, rank: usize) -> [[f64; 6]; 4] {
    let [left, right] = [(4, rank), (rank, 6)].map(|(m, n)| DMatrix::from_fn(m, n, |_, _| random.number()));
    let product = left * right;
    std::array::from_fn(|a| std::array::from_fn(|i| product[(a, i)]))
}

/// Matrices of each kind.
fn count() -> usize {
    cases([100, 200, 100_000])
}

/// A point that velocity constraints lead.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [6])]
#[lagrangian(dot(q_dot, q_dot)/2 + dot(h, q))]
#[constraint(led: c*q_dot = [0, 0, 0, 0])]
struct Led {
    c: [[f64; 6]; 4],
    h: [f64; 6],
}

/// As many forces as the constraints leave free hold it at rest: h + Fᵀλ + τ = 0.
#[test]
fn forces_are_found_beside_constraints_that_depend_on_one_another() {
    let (mut random, mut worst) = (Random(0x9E37_79B9_7F4A_7C15), 0.0_f64);
    for _ in 0..count() {
        let rank = 1 + random.below(4);
        let led = Led { c: rows(&mut random, rank), h: random.vector() };
        let names = &["q[0]", "q[1]", "q[2]", "q[3]", "q[4]"][..6 - rank];
        let found = led.inputs_for(&State::at_rest([0.0; 6]), &[0.0; 6].into(), names).unwrap();
        let terms = |i: usize| {
            let by_constraints = (0..4).map(move |a| led.c[a][i] * found.multipliers[a]);
            by_constraints.chain([led.h[i], found.inputs.get(i).copied().unwrap_or(0.0)])
        };
        let left = DVector::from_fn(6, |i, _| terms(i).sum::<f64>());
        let size = (0..6).map(|i| terms(i).map(f64::abs).sum::<f64>()).fold(1.0, f64::max);
        assert!(left.amax() < 1e-13 * size, "rank {rank}: {left} of {size:e}, {:?}", led.c);
        worst = worst.max(left.amax() / size);
    }
    println!("{} systems: forces are off by up to {worst:.1e}", count());
}

/// Springs between a point and four hyperplanes.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [6])]
#[define(way = c*q - b)]
#[lagrangian(dot(q_dot, q_dot)/2 - dot(way, way)/2)]
struct Hung {
    c: [[f64; 6]; 4],
    b: [f64; 4],
}

/// The springs' planes meet in a family of equilibria.
#[test]
fn one_of_a_family_of_equilibria_is_found_at_once() {
    let (mut random, mut most) = (Random(7), 0);
    for _ in 0..count() {
        let rank = 1 + random.below(4);
        let (c, q) = (rows(&mut random, rank), random.vector::<6>());
        let b = c.map(|row| row.iter().zip(&q).map(|(x, y)| x * y).sum());
        let hung = Hung { c, b };
        let found = hung.equilibrium(&State::at_rest(random.vector()), &[]).unwrap();
        let force = hung.forcing(&found.state).amax();
        assert!(force < 1e-13, "rank {rank}: {force:e}, {c:?}");
        most = most.max(found.iterations);
    }
    println!("{} systems: up to {most} steps", count());
    assert!(most <= 12, "{most}");
}

#[test]
fn nothing_to_find_is_found() {
    let free = Hung { c: [[0.0; 6]; 4], b: [0.0; 4] };
    let found = free.inputs_for(&State::at_rest([0.0; 6]), &[0.0; 6].into(), &[]).unwrap();
    assert!(found.inputs.is_empty());
    let asked = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    let error = free.inputs_for(&State::at_rest([0.0; 6]), &asked.into(), &[]).unwrap_err();
    assert!(error.to_string().contains("`q[1]`"), "{error}");
}
