use lagrange_core::prelude::*;
use lagrange_core::structure::{ConstantMassMatrix, HolonomicConstraints, Unconstrained, VelocityFreeForces};

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2 - k*x)]
struct System<T> {
    m: T,
}

fn advance<L: ConstantMassMatrix + VelocityFreeForces + HolonomicConstraints + Unconstrained>(_: &L) {}

fn main() {
    advance(&System { m: 1.0 });
}
