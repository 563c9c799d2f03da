//! Methods apply where the type of a system says so.

use lagrange_core::Method;
use lagrange_core::motion::{Gauss, Lobatto};

use crate::systems::*;

fn applies<L: lagrange_core::Lagrangian<Scalar = f64>, P: Method<L>>() {}

#[test]
fn methods_apply_to_systems_of_their_kind() {
    use lagrange_core::prelude::{DAlembert, Verlet};
    applies::<Kepler<f64>, Verlet>();
    applies::<Spherical<f64>, Verlet>();
    applies::<&Shaken<f64>, Verlet>();
    applies::<DoublePendulum<f64>, Gauss<1>>();
    applies::<&Bead<f64>, Gauss<4>>();
    applies::<Bowl<f64>, Lobatto<2>>();
    applies::<Kepler<f64>, Lobatto<4>>();
    applies::<Wheel<f64>, DAlembert>();
    applies::<Kepler<f64>, DAlembert>();
}
