//! Motions of systems whose constraints a field switches on and off.

use approx::assert_relative_eq;
use lagrange_core::{Method, prelude::*};

use crate::switched_constraints::{Cart, Free, Held, start};

/// Compares where a method ends, on and off.
fn compare<P>(method: P)
where
    P: Method<Cart> + Method<Held> + Method<Free> + Clone,
{
    let (on, off) = (Cart::new(true), Cart::new(false));
    let ends = |found: State<f64, 3>, expected: State<f64, 3>| {
        assert_relative_eq!(found.q, expected.q, epsilon = 1e-10);
        assert_relative_eq!(found.v, expected.v, epsilon = 1e-10);
    };
    let found = *on.integrate(start(), 1.0, method.clone()).unwrap().end().state();
    ends(found, *Held::new().integrate(start(), 1.0, method.clone()).unwrap().end().state());
    let found = *off.integrate(start(), 1.0, method.clone()).unwrap().end().state();
    ends(found, *Free::new().integrate(start(), 1.0, method).unwrap().end().state());
}

#[test]
fn every_method_takes_switches() {
    compare(Dop853::with_tolerance(1e-10));
    compare(Taylor::default());
    compare(RungeKutta4::with_step(0.01));
    compare(Verlet::with_step(0.01));
    compare(Lobatto::<3>::with_step(0.01));
    compare(DAlembert::with_step(0.01));
    compare(Radau::with_tolerance(1e-10));
}
