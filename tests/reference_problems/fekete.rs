//! Fekete's points: 20 particles on a sphere that repel each other and come to rest.
//!
//! The IVP test set (Hairer and Wanner; Mazzia and Magherini) states the problem as a system of index 2, in positions p, velocities
//! q and two multipliers for each particle: ṗ = q + Gᵀμ, q̇ = f(p, q) + Gᵀλ, 0 = φ(p), 0 = G q. On the motion μ = 0. So
//! this is a mechanical system of second order with the friction −½ q: the constraints φ = 0 have the multipliers λ and imply
//! G q = 0.

use lagrange_core::prelude::*;

use crate::reference::{BAR, IS_LONG, Problem, table};

#[derive(Lagrangian)]
#[coordinates(p: [20, 3])]
#[lagrangian(sum(i in 0..20, dot(p_dot[i], p_dot[i])/2 + sum(j in 0..i, ln(norm(p[i] - p[j])^2)/2)))]
#[dissipation(alpha/2*sum(i in 0..20, dot(p_dot[i], p_dot[i])))]
#[constraint(sphere[i in 0..20]: (dot(p[i], p[i]) - 1)/2 = 0)]
struct Fekete {
    alpha: f64,
}

/// The published positions at t = 1000 have eleven correct digits: `Taylor` and `Dop853` differ less from each other than from them.
#[test]
fn fekete_points_come_to_rest() {
    let problem = |name, known| Problem { name, system: Fekete { alpha: 0.5 }, known };
    let begins = problem("Fekete's points, t = 3", table!("fekete")).until(3.0);
    begins.check(&[[1e-13, 1e-12, 1e-14], [1e-11, 1e-10, 1e-13]]);
    if IS_LONG {
        let nearly = problem("Fekete's points, t = 20", table!("fekete"));
        nearly.check(&[[1e-12, 1e-12, 1e-14], BAR]);
        let known = [&nearly.known[..1], &table!("fekete_published")].concat();
        let ends = problem("Fekete's points, t = 1000", known);
        ends.check(&[[1e-10, 1e-13, 1e-14], [1e-10, 1e-11, 1e-14], BAR]);
    }
}
