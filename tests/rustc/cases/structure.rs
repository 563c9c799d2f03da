//! A method that needs a structure which the system lacks: the error names the reason and another method.
use lagrange_core::prelude::*;
use lagrange_core::structure::{ConstantMassMatrix, HolonomicConstraints, Unconstrained, VelocityFreeForces};

#[derive(Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(m/2 * (r_dot^2 + r^2*phi_dot^2))]
#[force(r: -k*r_dot)]
#[constraint(spiral: r_dot = k*phi_dot)]
struct Bead {
    m: f64,
    k: f64,
}

fn factored_once<L: ConstantMassMatrix>(_: &L) {}

fn kicked<L: VelocityFreeForces>(_: &L) {}

fn projected<L: HolonomicConstraints>(_: &L) {}

fn collocated<L: Unconstrained>(_: &L) {}

fn main() {
    let bead = Bead { m: 1.0, k: 2.0 };
    factored_once(&bead);
    kicked(&bead);
    projected(&bead);
    collocated(&bead);
}
