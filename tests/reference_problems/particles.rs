//! Particles that attract or repel each other: stars, planets, lattices.

use lagrange_core::prelude::*;
use lagrange_systems::OuterSolarSystem;

use crate::reference::{BAR, IS_LONG, Problem, table};

/// Seven stars in a plane.
#[derive(Lagrangian)]
#[coordinates(r: [7, 2])]
#[lagrangian(sum(i in 0..7, m[i]/2*dot(r_dot[i], r_dot[i]) + sum(j in 0..i, m[i]*m[j]/norm(r[i] - r[j]))))]
struct Pleiades {
    m: [f64; 7],
}

/// Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, II.10.
#[test]
fn pleiades() {
    let system = Pleiades { m: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0] };
    let problem = Problem { name: "Pleiades", system, known: table!("pleiades") };
    problem.check(&[[1e-11, 1e-11, 0.0], [1e-10, 1e-10, 0.0]]);
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

/// Two turns of Jupiter, and the 46 turns of the book.
#[test]
fn outer_solar_system() {
    let problem = |name| Problem { name, system: OUTER_SOLAR_SYSTEM, known: table!("outer_solar_system") };
    let decades = problem("outer solar system, 10⁴ days").until(1e4);
    decades.check(&[[1e-12, 1e-12, 0.0], [1e-11, 1e-11, 0.0]]);
    if IS_LONG {
        problem("outer solar system, 2·10⁵ days").check(&[[1e-11, 1e-11, 0.0], BAR]);
    }
}

/// Toda's lattice, a ring of six.
#[derive(Lagrangian)]
#[coordinates(q: [6])]
#[define(pull[i in 0..5] = exp(q[i] - q[i+1]))]
#[define(last = exp(q[5] - q[0]))]
#[lagrangian(sum(i in 0..6, q_dot[i]^2/2) - sum(i in 0..5, pull[i]) - last)]
struct Toda;

#[test]
fn toda_lattice() {
    let known = table!("toda");
    let problem = Problem { name: "Toda's lattice, ring of 6", system: Toda, known };
    problem.check(&[[1e-13, 1e-14, 0.0], [1e-11, 1e-11, 0.0], BAR]);
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

/// Half a period of the first mode, and its recurrence after 157 of its periods, t = 10,053.
#[test]
fn fput_lattice() {
    let problem = |name| Problem { name, system: Fput { alpha: 0.25 }, known: table!("fput") };
    let begins = problem("FPUT lattice, half a period").until(30.0);
    begins.check(&[[1e-13, 1e-12, 0.0], [1e-10, 1e-10, 0.0], BAR]);
    if IS_LONG {
        problem("FPUT lattice, t = 10⁴").check(&[[1e-12, 1e-12, 0.0], [1e-8, 1e-8, 0.0]]);
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
    problem.until(5.0).check(&[[1e-13, 1e-12, 0.0], [1e-11, 1e-9, 0.0]]);
}
