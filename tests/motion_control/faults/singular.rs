//! Forces with poles and edges, and constraints that depend on one another.

use lagrange_core::prelude::*;

use crate::faults::case::{Case, Scope, SetParameter};
use crate::faults::kinds::{ALL, STEP_CONTROL, all, check, hanging, rod, spring};
use crate::faults::methods::{free, held};
use crate::faults::systems::{SPRING, Spring};
use crate::{ROD, Rod};

/// A potential with a pole at the origin, with a root that ends at x = 2, and with a force that drives the particle to
/// infinity in finite time.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 + star/sqrt(x^2 + y^2) - cliff*sqrt(2 - x) + escape*x^4/2)]
struct Field {
    star: f64,
    cliff: f64,
    escape: f64,
}

/// A bob on two rods, which are one for a = 1.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - y)]
#[constraint(rod: x^2 + y^2 = 1)]
#[constraint(again: a*x^2 + y^2 = 1)]
struct TwoRods {
    a: f64,
}

impl SetParameter for Field {
    fn set_first(&mut self, value: f64) {
        self.star = value;
    }
}

impl SetParameter for TwoRods {
    fn set_first(&mut self, value: f64) {
        self.a = value;
    }
}

fn field(star: f64, cliff: f64, escape: f64, start: State<f64, 2>) -> Case<Field> {
    Case::of(Field { star, cliff, escape }, start, 10.0)
}

#[test]
fn forces() {
    let row = "the equations are not finite at t = 0; row of coordinate `x`: check the parameters, and whether the state is at a pole";
    all("start at a pole", &free(&field(1.0, 0.0, 0.0, State::at_rest([0.0; 2]))), row);
    all("start where a root is imaginary", &free(&field(0.0, 1.0, 0.0, State::at_rest([2.5, 0.0]))), row);
    all("forces that overflow at the start", &free(&field(0.0, 0.0, 1.0, State::at_rest([1e200, 0.0]))), row);
    let row = "the equations are not finite in the row of coordinate `x`; check the parameters, whether the motion runs into a pole";
    let outcomes = free(&field(0.0, 1.0, 0.0, State::new([1.0, 0.0], [0.5, 0.0])));
    all("root that ends on the way", &outcomes, row);
    // Up to a step before the end of the root.
    assert!(outcomes.iter().all(|outcome| outcome.state.unwrap().q[0] > 1.95));
    all(
        "fall on a star",
        &free(&Case { scope: Scope::StepControl, ..field(1.0, 0.0, 0.0, State::at_rest([1.0, 0.0])) }),
        "demands a step too small to advance the time; the motion is singular nearby",
    );
    check(
        "rod that shrinks to nothing",
        &held(&Case {
            system: Rod { shrinks: 1.0, ..ROD },
            start: State::new([0.6, -0.8], [-0.3, 0.4]),
            end: 2.0,
            ..rod()
        }),
        &[
            (&["Radau"], "the iteration of a step does not converge, however short it is"),
            (STEP_CONTROL, "demands a step too small to advance the time; the motion is singular nearby"),
            (&["RungeKutta4"], "constraint `rod` has residual"),
            (ALL, "the iteration of a step does not converge; take shorter steps"),
        ],
    );
    let stiff = Case { system: Spring { k: 1e6, ..SPRING }, end: 10.0, ..spring() };
    check(
        "oscillations shorter than a step",
        &free(&stiff),
        &[
            (
                &["Gauss", "Lobatto 4", "DAlembert, order 6"],
                "the iteration of a step does not converge; take shorter steps",
            ),
            (&["Taylor"], "reached the end"),
            (STEP_CONTROL, "after 20000 steps, the limit, where the next is"),
            (ALL, "with steps of one length, whether shorter ones are stable"),
        ],
    );
}

#[test]
fn two_rods() {
    check(
        "one rod twice",
        &held(&Case::of(TwoRods { a: 1.0 }, hanging(), 1.0)),
        &[
            (&["RungeKutta4", "Dop853", "Dopri5", "Taylor", "Radau"], "reached the end"),
            (ALL, "if constraints depend on one another, `Dop853`"),
        ],
    );
    let text = "constraints `rod`, `again` depend on one another at t = 0 to first order";
    all("two rods that touch", &held(&Case::of(TwoRods { a: 2.0 }, State::at_rest([0.0, -1.0]), 1.0)), text);
}
