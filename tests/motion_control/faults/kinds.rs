//! The table: kinds of faults, the methods that they concern, and the texts of their errors.

use std::time::Duration;

use lagrange_core::prelude::*;

use crate::faults::case::{Ask, Case, Outcome};
use crate::faults::methods::{free, held};
use crate::faults::systems::*;
use crate::{ROD, Rod};

const NAN: f64 = f64::NAN;
const INFINITY: f64 = f64::INFINITY;

/// Beginnings of the names of methods, and a part of the text of their errors.
pub(super) type Says<'a> = (&'a [&'a str], &'a str);

pub(super) const ALL: &[&str] = &[""];
pub(super) const STEP_CONTROL: &[&str] = &["Dop853", "Dopri5", "Taylor", "Radau"];
const IMPLICIT: &[&str] = &["Gauss", "Lobatto", "DAlembert"];

/// Asserts that the text of each outcome contains what the first entry for its method states. An entry is for a method whose
/// name begins with one of its names.
pub(super) fn check(kind: &str, outcomes: &[Outcome], says: &[Says]) {
    println!("{kind}");
    for Outcome { method, text, .. } in outcomes {
        println!("    {method}: {text}");
        let is_of = |methods: &[&str]| methods.iter().any(|name| method.starts_with(name));
        let (_, part) = says.iter().find(|(methods, _)| is_of(methods)).unwrap();
        assert!(text.contains(part), "{kind} by {method}: {text}");
    }
}

/// Asserts that the texts of all outcomes contain this.
pub(super) fn all(kind: &str, outcomes: &[Outcome], part: &str) {
    check(kind, outcomes, &[(ALL, part)]);
}

/// Asserts that the motion reaches its end with these coordinates, to 10⁻³.
fn check_numbers(kind: &str, outcomes: &[Outcome], q: [f64; 2]) {
    all(kind, outcomes, "reached the end");
    for Outcome { method, state, .. } in outcomes {
        let off =
            [0, 1].map(|i| (state.unwrap().q[i] - q[i]).abs() / (1e-300 + q[i].abs()).max(q[1 - i].abs()));
        assert!(off[0] < 1e-3 && off[1] < 1e-3, "{kind} by {method}: off by {off:?}");
    }
}

fn swinging() -> State<f64, 2> {
    State::new([0.5, 0.2], [0.0, 0.3])
}

pub(super) fn hanging() -> State<f64, 2> {
    State::at_rest([0.6, -0.8])
}

pub(super) fn spring() -> Case<Spring> {
    Case::of(SPRING, swinging(), 1.0)
}

/// The same, for motions that do not get on.
fn few_steps() -> Case<Spring> {
    Case { max_steps: 500, ..spring() }
}

/// The particle on its spring at a time.
fn swung(t: f64) -> [f64; 2] {
    [0.5 * t.cos(), 0.2 * t.cos() + 0.3 * t.sin()]
}

pub(super) fn rod() -> Case<Rod> {
    Case::of(ROD, hanging(), 1.0)
}

#[test]
fn settings() {
    let late = || Case { start: swinging().at_time(1.0), end: 2.0, ..spring() };
    for (kind, step, text) in [
        ("step of zero", 0.0, "the fixed step is 0: it must be positive and finite"),
        ("negative step", -0.1, "the fixed step is -0.1: it must be"),
        ("step that is no number", NAN, "the fixed step is NaN: it must be"),
        ("infinite step", INFINITY, "the fixed step is inf: it must be"),
        ("denormal step", 5e-324, "after 500 steps, the limit; raise it with `max_steps`"),
    ] {
        all(kind, &free(&few_steps().with_step(step)), text);
    }
    let text = "a step of 5e-324 does not advance the time; allow longer ones, or count the time from nearby";
    all("denormal step far from zero", &free(&late().with_step(5e-324)), text);
    let near = Case { end: 0.01, ..spring() };
    check_numbers("step beyond the end", &free(&near.with_step(1e300)), swung(0.01));
    let far = Case { end: 1e3, ..rod() };
    check(
        "step over many oscillations",
        &held(&far.with_step(1e300)),
        &[
            (&["RungeKutta4"], "no consistent state found near the one given at t = 1000"),
            (ALL, "the iteration of a step does not converge; take shorter steps"),
        ],
    );
    for (kind, tolerance, text) in [
        ("tolerance of zero", 0.0, "the relative tolerance is 0: it must be positive and finite"),
        ("negative tolerance", -1e-6, "the relative tolerance is -0.000001: it must be"),
        ("tolerance that is no number", NAN, "the relative tolerance is NaN: it must be"),
        ("infinite tolerance", INFINITY, "the relative tolerance is inf: it must be"),
    ] {
        all(kind, &free(&spring().with_tolerance(tolerance)), text);
    }
    for tolerance in [1e-16, 1e-30] {
        let outcomes = free(&spring().with_tolerance(tolerance));
        check_numbers("tolerance below round-off", &outcomes, swung(1.0));
    }
}

#[test]
fn starts() {
    let from = |start| Case { start, ..spring() };
    for (x, value) in [(NAN, "NaN"), (INFINITY, "inf")] {
        for (entry, start) in [
            ("y", State::new([0.5, x], [0.0; 2])),
            ("x_dot", State::new([0.5, 0.0], [x, 0.0])),
            ("t", swinging().at_time(x)),
        ] {
            let text = format!("`{entry}` is {value} in the state given: every entry must be finite");
            all(&format!("{value} in {entry}"), &free(&from(start)), &text);
        }
    }
    let text = "the state violates constraint `rod` at t = 0: its residual is -7.5e-1, not 0; call `make_consistent` first";
    all("coordinates off the rod", &held(&Case { start: State::at_rest([0.5, 0.0]), ..rod() }), text);
    let text = "its rate F q_dot + b is 1.2e0, not 0; call `make_consistent` first";
    let leaving = State::new([0.6, -0.8], [1.0, 0.0]);
    all("velocities off the rod", &held(&Case { start: leaving, ..rod() }), text);
    let impossible = Case { system: Rod { square: -1.0, ..ROD }, ..rod() };
    all("rod of an imaginary length", &held(&impossible), "the state violates constraint `rod`");
    let system = Rod { square: 0.0, ..ROD };
    let text = "the gradient of constraint `rod` vanishes at t = 0, where it holds";
    all("rod of length zero", &held(&Case::of(system, State::at_rest([0.0; 2]), 1.0)), text);
}

#[test]
fn parameters() {
    let of = |system| Case { system, ..spring() };
    let undetermined = "the equations do not determine the acceleration of `y` at t = 0: give each a mass";
    all("mass of zero", &free(&of(Spring { n: 0.0, ..SPRING })), undetermined);
    let undetermined =
        "the equations do not determine the acceleration of `x`, `y` at t = 0: give each a mass";
    all("denormal mass", &free(&of(Spring { m: 1e-310, ..SPRING })), undetermined);
    all("rod without mass", &held(&Case { system: Rod { m: 0.0, ..ROD }, ..rod() }), undetermined);
    let is = |name, value| {
        format!("the parameter `{name}` is {value}: every parameter in the equations must be finite")
    };
    all("mass that is no number", &free(&of(Spring { m: NAN, ..SPRING })), &is("m", "NaN"));
    all("stiffness that is no number", &free(&of(Spring { k: NAN, ..SPRING })), &is("k", "NaN"));
    all("infinite stiffness", &free(&of(Spring { k: INFINITY, ..SPRING })), &is("k", "inf"));
    let heavy = Case { system: Rod { g: NAN, ..ROD }, ..rod() };
    all("gravity that is no number", &held(&heavy), &is("g", "NaN"));
    check(
        "infinite mass",
        &free(&of(Spring { m: INFINITY, ..SPRING })),
        &[(IMPLICIT, "the equations are not finite in the row of coordinate `x`"), (ALL, "reached the end")],
    );
    let numbers = [0.5 * 1.0_f64.cosh(), swung(1.0)[1]];
    check_numbers("negative mass", &free(&of(Spring { m: -1.0, ..SPRING })), numbers);
    check_numbers("huge masses", &free(&of(Spring { m: 1e300, n: 1e300, k: 1e300 })), swung(1.0));
}

#[test]
fn spans() {
    for (end, value) in [(NAN, "NaN"), (INFINITY, "inf")] {
        let text = format!("cannot integrate to t = {value}: the end must be finite");
        all(&format!("end at {value}"), &free(&Case { end, ..spring() }), &text);
    }
    check_numbers("no span", &free(&Case { end: 0.0, ..spring() }), swung(0.0));
    check_numbers("end before the start", &free(&Case { end: -1.0, ..spring() }), swung(-1.0));
    let next = Case { start: swinging().at_time(1.0), end: 1.0 + f64::EPSILON, ..spring() };
    check_numbers("end at the next time", &free(&next), swung(0.0));
    check(
        "times that lie far apart",
        &free(&Case { start: swinging().at_time(1e18), end: 2e18, ..spring() }),
        &[
            (STEP_CONTROL, "demands a step too small to advance the time"),
            (ALL, "does not advance the time; allow longer ones, or count the time from nearby"),
        ],
    );
    let whole = Case { start: swinging().at_time(-f64::MAX), end: f64::MAX, ..spring() };
    check(
        "all times",
        &free(&whole),
        &[
            (&["Radau"], "the iteration of a step does not converge, however short it is"),
            (STEP_CONTROL, "the equations are not finite in the row of coordinate `x`"),
            (ALL, "does not advance the time; allow longer ones, or count the time from nearby"),
        ],
    );
}

#[test]
fn limits() {
    let far = || Case { end: 100.0, ..spring() };
    all("too few steps", &free(&Case { max_steps: 7, ..far() }), "after 7 steps, the limit");
    let text = "stopped at t = 0 after 0 steps, the limit; raise it with `max_steps`";
    all("no steps", &free(&Case { max_steps: 0, ..far() }), text);
    let text = "stopped at t = 0 by the limit on wall time; raise it with `wall_time`";
    all("no time", &free(&Case { wall_time: Some(Duration::ZERO), ..far() }), text);
    all("progress that cancels", &free(&far().asking(Ask::Cancelled)), "cancelled at t = ");
}

#[test]
fn magnitudes() {
    let huge = free(&Case { start: State::at_rest([1e300, -1e300]), ..spring() });
    let (radau, others): (Vec<_>, Vec<_>) = huge.into_iter().partition(|outcome| outcome.method == "Radau");
    check_numbers("huge coordinates", &others, [1e300 * 1.0_f64.cos(), -1e300 * 1.0_f64.cos()]);
    // Squares of the errors overflow.
    all("huge coordinates", &radau, "the iteration of a step does not converge, however short it is");
    let denormal = free(&Case { start: State::at_rest([5e-324, 1e-310]), ..spring() });
    all("denormal coordinates", &denormal, "reached the end");
    let flying = Case {
        start: State::new([0.0; 2], [1e308; 2]),
        system: Spring { k: 0.0, ..SPRING },
        end: 1e3,
        ..spring()
    };
    check(
        "coordinates that overflow on the way",
        &free(&flying),
        &[
            (&["Radau", "Gauss 4", "Lobatto", "DAlembert"], "the iteration of a step does not converge"),
            (ALL, "the equations are not finite in the row of coordinate `x`"),
        ],
    );
}

#[test]
fn events() {
    let ringing = |function| spring().asking(Ask::Event(function));
    let text =
        "the function of the event `bell` is not a number at t = 0: make it one wherever the motion may lead";
    all("event that is no number", &free(&ringing(|_| NAN)), text);
    let late = |t| if t > 0.3 { NAN } else { 1.0 };
    let text = "the function of the event `bell` is not a number soon after; make it one wherever";
    all("event that is no number later on", &free(&ringing(late)), text);
    all("event that is no number later on, on a rod", &held(&rod().asking(Ask::Event(late))), text);
    // A jump to minus infinity is a crossing, a function that is zero has none.
    let falls = |t| if t > 0.3 { -INFINITY } else { 1.0 };
    check_numbers("event that becomes infinite", &free(&ringing(falls)), swung(1.0));
    check_numbers("event that is always zero", &free(&ringing(|_| 0.0)), swung(1.0));
    check_numbers("storm of events", &free(&ringing(|t| (300.0 * t).sin())), swung(1.0));
    all(
        "event of an unknown coordinate",
        &free(&spring().asking(Ask::UnknownEvent)),
        "there is no coordinate `z`",
    );
}

#[test]
fn samples() {
    let at = |times: &[f64]| free(&spring().asking(Ask::Samples(times.to_vec())));
    let text = "the sample time 1 (counted from 0) is 0.25: give finite times in the order of the motion";
    check("sample times out of order", &at(&[0.5, 0.25]), &[(ALL, text)]);
    check(
        "sample time that is no number",
        &at(&[0.5, NAN]),
        &[(ALL, "the sample time 1 (counted from 0) is NaN")],
    );
    check("sample time beyond the end", &at(&[0.5, 1.5]), &[(ALL, "t = 1.5 lies outside the trajectory")]);
    for interval in [0.0, -0.1, NAN, INFINITY] {
        let text = format!("the interval of the samples is {interval}: it must be positive and finite");
        all("interval of samples", &free(&spring().asking(Ask::Every(interval))), &text);
    }
    let text = "the interval of the samples is 1e-300: times this near are not told apart; make it longer";
    all("interval of samples below that of times", &free(&spring().asking(Ask::Every(1e-300))), text);
}

#[test]
fn controllers() {
    let by = |interval, value| free(&spring().asking(Ask::Controlled(interval, value)));
    for interval in [0.0, -0.1, NAN, INFINITY] {
        let text = format!("the interval of the controller is {interval}: it must be positive and finite");
        all("interval of a controller", &by(interval, Some(1.0)), &text);
    }
    all(
        "interval of a controller that takes all steps",
        &free(&few_steps().asking(Ask::Controlled(1e-300, Some(1.0)))),
        "after 500 steps, the limit",
    );
    // Methods that begin anew after a controller look at parameters; the others meet the equations.
    let row =
        "stopped at t = 0.5: the equations are not finite in the row of coordinate `x`; check the parameters";
    let is = "stopped at t = 0.5: the parameter `k` is NaN";
    let anew: &[&str] = &["Gauss", "Verlet", "Lobatto", "DAlembert"];
    let either = "stopped at t = 0.5: the";
    check(
        "controller that sets no number",
        &by(0.1, Some(NAN)),
        &[(anew, is), (&["Radau"], either), (ALL, row)],
    );
    let text = "stopped at t = 0.5: the controller failed: the battery is empty";
    all("controller that fails", &by(0.1, None), text);
    let lengthen = |square| held(&rod().asking(Ask::Controlled(0.1, Some(square))));
    let text = "stopped at t = 0.5: the state violates constraint `rod` at t = 0.5: its residual is";
    all("controller that lengthens a rod", &lengthen(2.0), text);
    all("controller that makes a rod no number", &lengthen(NAN), text);
}

/// A motion that refuses a state or a time stays where it was, and goes on.
#[test]
fn states_and_times_that_are_set() {
    let set = |state| Ask::SetState(state);
    let text = "`x` is NaN in the state given: every entry must be finite";
    all("state that is no number", &free(&spring().asking(set(State::at_rest([NAN, 0.0])))), text);
    let text = "the state violates constraint `rod` at t = 0: its residual is 3e0";
    all("state off the rod", &held(&rod().asking(set(State::at_rest([2.0, 0.0])))), text);
    for (t, value) in [(NAN, "NaN"), (INFINITY, "inf")] {
        let text = format!("stopped at t = 0.5: cannot integrate to t = {value}: the end must be finite");
        all(&format!("advance to {value}"), &free(&spring().asking(Ask::AdvanceTo(t))), &text);
    }
}
