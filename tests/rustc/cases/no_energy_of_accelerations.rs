//! A system that is stated by its accelerations alone has no energy.

use lagrange_core::motion::AccelerationField;
use lagrange_core::nalgebra::{Const, DVector, Dyn};
use lagrange_core::{System, generic, prelude::*};

struct Chain;

impl System for Chain {
    type Scalar = f64;
    type Length = Dyn;
    type M = Const<0>;
    type Field = AccelerationField;

    fn length(&self) -> Dyn {
        Dyn(1)
    }

    fn accelerations(&self, _: f64, q: &[f64], _: &[f64], a: &mut [f64]) {
        a[0] = -q[0];
    }
}

fn main() {
    let start = generic::State { t: 0.0, q: DVector::from_element(1, 1.0), v: DVector::zeros(1) };
    let path = Chain.integrate(start, 1.0, Dop853::default()).unwrap();
    path.end().energy();
    path.drift();
    let _ = path.csv(5).energy();
    path.end().momentum("q[0]").unwrap();
}
