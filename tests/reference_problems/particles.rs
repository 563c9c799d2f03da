//! Particles that attract or repel each other: stars, planets, lattices.

use std::f64::consts::PI;

use lagrange_core::prelude::*;

use crate::reference_motions::reference::{ARE_SPANS_WHOLE, BAR, Known, Problem, table};

/// Seven stars in a plane.
#[derive(Lagrangian)]
#[coordinates(r: [7, 2])]
#[lagrangian(sum(i in 0..7, m[i]/2*dot(r_dot[i], r_dot[i]) + sum(j in 0..i, m[i]*m[j]/norm(r[i] - r[j]))))]
struct Pleiades {
    m: [f64; 7],
}

/// Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, II.10; the IVP test set publishes the end.
#[test]
fn pleiades() {
    let known: Vec<Known<14, 0>> = table!("pleiades");
    // x₁, y₁, ẋ₁ and ẏ₇ at t = 3 as published.
    let end = known[known.len() - 1];
    let published = [
        (end.q[0], 0.370_613_914_397_050_2),
        (end.q[1], -3.943_437_585_517_392),
        (end.v[0], 3.417_003_806_314_313),
        (end.v[13], -1.947_020_434_263_292),
    ];
    for (recomputed, published) in published {
        assert!((recomputed - published).abs() < 4e-15, "{recomputed} {published}");
    }
    let problem =
        Problem { name: "Pleiades", system: Pleiades { m: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0] }, known };
    problem.check(&[("Taylor", [1e-11, 1e-11, 0.0]), ("Dop853", [1e-10, 1e-10, 0.0])]);
}

/// The sun with the inner planets, and the outer planets with Pluto.
#[derive(Lagrangian)]
#[coordinates(r: [6, 3])]
#[lagrangian(sum(i in 0..6, m[i]/2*dot(r_dot[i], r_dot[i]) + sum(j in 0..i, G*m[i]*m[j]/norm(r[i] - r[j]))))]
#[allow(non_snake_case)]
struct OuterSolarSystem {
    m: [f64; 6],
    G: f64,
}

/// Hairer, Lubich and Wanner, *Geometric Numerical Integration*, I.2.4.
const OUTER_SOLAR_SYSTEM: OuterSolarSystem = OuterSolarSystem {
    m: [
        1.000_005_976_82,
        0.000_954_786_104_043,
        0.000_285_583_733_151,
        0.000_043_727_316_454_6,
        0.000_051_775_913_844_9,
        1.0 / 1.3e8,
    ],
    G: 2.959_122_082_86e-4,
};

/// Two turns of Jupiter.
#[test]
fn outer_solar_system() {
    let known = table!("outer_solar_system");
    let problem = Problem { name: "outer solar system, 10⁴ days", system: OUTER_SOLAR_SYSTEM, known };
    problem.until(1e4).check(&[("Taylor", [1e-12, 1e-12, 0.0]), ("Dop853", [1e-11, 1e-11, 0.0])]);
}

/// The span of the book, 46 turns of Jupiter.
#[test]
fn outer_solar_system_over_centuries() {
    if ARE_SPANS_WHOLE {
        let known: Vec<Known<18, 0>> = table!("outer_solar_system");
        let problem =
            Problem { name: "outer solar system, 2·10⁵ days", system: OUTER_SOLAR_SYSTEM, known };
        problem.check(&[("Taylor", [1e-11, 1e-11, 0.0]), ("Dop853", BAR)]);
    }
}

/// Toda's lattice, a ring of six. The cubic integral is a multiple of the trace of L³ of the Lax pair (L, B).
#[derive(Lagrangian)]
#[coordinates(q: [6])]
#[define(pull[i in 0..5] = exp(q[i] - q[i+1]))]
#[define(last = exp(q[5] - q[0]))]
#[lagrangian(sum(i in 0..6, q_dot[i]^2/2) - sum(i in 0..5, pull[i]) - last)]
#[conserved(cubic = sum(i in 0..6, q_dot[i]^3/3) + sum(i in 0..5, (q_dot[i] + q_dot[i+1])*pull[i])
    + (q_dot[5] + q_dot[0])*last)]
struct Toda;

#[test]
fn toda_lattice() {
    let known = table!("toda");
    let problem = Problem { name: "Toda's lattice, ring of 6", system: Toda, known };
    problem.check(&[("Taylor", [1e-13, 1e-14, 0.0]), ("Dop853", [1e-11, 1e-11, 0.0]), ("Dopri5", BAR)]);
}

#[test]
fn toda_lattice_keeps_its_cubic_integral() {
    let known: Vec<Known<6, 0>> = table!("toda");
    let path = Toda.integrate(State::new(known[0].q, known[0].v), 30.0, Taylor::default()).unwrap();
    let drift = path.drift();
    assert!(drift.get("cubic").unwrap().largest < 1e-13, "{drift}");
}

/// The lattice of Fermi, Pasta, Ulam and Tsingou with 31 masses between walls, and springs that stiffen as they stretch.
#[derive(Lagrangian)]
#[coordinates(q: [31])]
#[define(s[0] = q[0])]
#[define(s[i in 1..31] = q[i] - q[i-1])]
#[define(s[31] = -q[30])]
#[lagrangian(sum(i in 0..31, q_dot[i]^2/2) - sum(i in 0..32, s[i]^2/2 + alpha/3*s[i]^3))]
struct Fput {
    alpha: f64,
}

#[test]
fn fput_lattice() {
    let known = table!("fput");
    let problem = Problem { name: "FPUT lattice, half a period", system: Fput { alpha: 0.25 }, known };
    problem.until(30.0).check(&[
        ("Taylor", [1e-13, 1e-12, 0.0]),
        ("Dop853", [1e-10, 1e-10, 0.0]),
        ("Dopri5", BAR),
    ]);
}

/// Energy of the first mode, sin(πk/32), to second order.
fn first_mode(state: &State<f64, 31>) -> f64 {
    let shape = |x: &[f64]| {
        let terms = x.iter().enumerate().map(|(k, x)| x * (PI * (k as f64 + 1.0) / 32.0).sin());
        terms.sum::<f64>() * (2.0 / 32.0_f64).sqrt()
    };
    let frequency = 2.0 * (PI / 64.0).sin();
    (shape(state.v.as_slice()).powi(2) + (frequency * shape(state.q.as_slice())).powi(2)) / 2.0
}

/// The energy leaves the first mode and is back in it after 157 of its periods, t = 10,053.
#[test]
fn fput_lattice_recurs() {
    if ARE_SPANS_WHOLE {
        let known: Vec<Known<31, 0>> = table!("fput");
        let energy = |known: &Known<31, 0>| first_mode(&State::new(known.q, known.v));
        let part = |k: usize| energy(&known[k]) / energy(&known[0]);
        assert!(part(4) < 0.7 && part(5) > 0.85, "{} at t = 1000, {} at t = 10⁴", part(4), part(5));
        let problem = Problem { name: "FPUT lattice, t = 10⁴", system: Fput { alpha: 0.25 }, known };
        problem.check(&[("Taylor", [1e-12, 1e-12, 0.0]), ("Dop853", [1e-8, 1e-8, 0.0])]);
    }
}

/// Soft quartic springs that alternate with three stiff harmonic ones (Hairer, Lubich and Wanner, I.5.1).
#[derive(Lagrangian)]
#[coordinates(q: [6])]
#[define(stiff = sum(i in 0..3, (q[2*i+1] - q[2*i])^2))]
#[define(soft = q[0]^4 + sum(i in 0..2, (q[2*i+2] - q[2*i+1])^4) + q[5]^4)]
#[lagrangian(sum(i in 0..6, q_dot[i]^2/2) - omega^2/4*stiff - soft)]
struct StiffSprings {
    omega: f64,
}

#[test]
fn stiff_springs() {
    let known = table!("stiff_springs");
    let problem =
        Problem { name: "stiff and soft springs, ω = 50", system: StiffSprings { omega: 50.0 }, known };
    problem.until(5.0).check(&[("Taylor", [1e-13, 1e-12, 0.0]), ("Dop853", [1e-11, 1e-9, 0.0])]);
}
