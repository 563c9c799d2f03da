//! Code decides about members, and no fingerprint sees it: a tag names it.

use std::ops::ControlFlow;

use lagrange_core::ensemble::EnsembleError;
use lagrange_core::prelude::*;

use lagrange_systems::DoublePendulum;

use crate::fields::trapped;
use crate::{COUNT, END, ensemble, member};

type Runs<'a> = Ensemble<'a, DoublePendulum<f64>, true>;

fn up<'a>() -> Runs<'a> {
    with(|event| event.terminal())
}

fn with<'a>(about: impl FnOnce(Watched) -> Watched) -> Runs<'a> {
    ensemble().event(about(member(0).0.event("up", |sample| sample.state().q[0] - 1.0)))
}

type Watched =
    lagrange_core::Event<DoublePendulum<f64>, fn(&lagrange_core::Sample<&DoublePendulum<f64>>) -> f64>;

fn steered<'a>() -> Runs<'a> {
    ensemble().controlled(0.1, |_, pendulum, _| {
        pendulum.g *= 1.1;
        Ok::<_, Error>(())
    })
}

fn seen<'a>() -> Runs<'a> {
    ensemble().samples_at([]).observe(|index, _| match index {
        3 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    })
}

/// Each names what is not seen, and goes on under the tag of the run that wrote the rows: none is the empty one.
#[test]
fn rows_are_taken_over_by_tag_where_code_decides() {
    let method = Dop853::default();
    for (run, code) in
        [(up as fn() -> Runs<'static>, "the event `up`"), (steered, "the controller"), (seen, "the observer")]
    {
        for tag in ["", "first"] {
            let tagged = |tag: &str| run().tag(tag);
            let whole = tagged(tag).integrate_on_lanes(END, method).unwrap();
            let table = whole.json_lines().to_string();
            let untagged = run().resume(&table).unwrap().integrate_on_lanes(END, method).unwrap_err();
            assert_eq!(untagged, Error::Ensemble(EnsembleError::Untagged { code: code.into() }));
            let again = tagged(tag).resume(&table).unwrap().integrate_on_lanes(END, method).unwrap();
            assert_eq!(again.json_lines().to_string(), table);
            let other = tagged("second").resume(&table).unwrap().integrate_on_lanes(END, method);
            assert!(matches!(other, Err(Error::Ensemble(EnsembleError::OtherRun { .. }))));
        }
        assert!(run().integrate_on_lanes(END, method) == run().tag("").integrate_on_lanes(END, method));
    }
}

/// The values of a quantity are in the table.
#[test]
fn rows_of_runs_with_quantities_need_a_tag() {
    let run = || ensemble().samples_at([END]).quantity("energy", |sample| sample.energy());
    let table = run().integrate_on_lanes(END, Dop853::default()).unwrap().json_lines().to_string();
    let untagged = run().resume(&table).unwrap().integrate_on_lanes(END, Dop853::default()).unwrap_err();
    assert_eq!(untagged, Error::Ensemble(EnsembleError::Untagged { code: "the quantity `energy`".into() }));
    assert!(run().tag("").resume(&table).unwrap().integrate_on_lanes(END, Dop853::default()).is_ok());
    // Samples alone need none.
    let run = || ensemble().samples_at([END]);
    let table = run().integrate_on_lanes(END, Dop853::default()).unwrap().json_lines().to_string();
    assert!(run().resume(&table).unwrap().integrate_on_lanes(END, Dop853::default()).is_ok());
}

/// Without a tag: what a supplied function holds is no parameter.
#[test]
fn rows_of_systems_with_supplied_functions_need_a_tag() {
    let run = || Ensemble::from_fn(9, trapped);
    let table = run().integrate(3.0, Dop853::default()).unwrap().json_lines().to_string();
    let untagged = run().resume(&table).unwrap().integrate(3.0, Dop853::default()).unwrap_err();
    assert_eq!(
        untagged.to_string(),
        "the function `U` of the system may have been another when the rows to resume from were made, and nothing in them tells: name it in both runs by `.tag(\"…\")` on the ensemble, and anew whenever it changes; `.tag(\"\")` takes over rows of a run without a tag"
    );
    assert!(run().tag("").resume(&table).unwrap().integrate(3.0, Dop853::default()).is_ok());
}

/// Without a tag of another name: what can be seen of an event is compared by itself.
#[test]
fn runs_with_other_events_are_told_apart() {
    let table = up().tag("").integrate_on_lanes(END, Dop853::default()).unwrap().json_lines().to_string();
    let other = |event: fn(Watched) -> Watched| {
        let run = with(event).tag("").resume(&table).unwrap();
        run.integrate_on_lanes(END, Dop853::default())
    };
    assert_eq!(other(Watched::terminal).unwrap().members().len(), COUNT);
    let others: [fn(Watched) -> Watched; 5] = [
        |event| event,
        |event| event.terminal_at(2),
        |event| event.terminal().rising(),
        |event| event.terminal().falling(),
        |event| event.terminal().subdivide(3),
    ];
    for event in others {
        assert!(matches!(other(event), Err(Error::Ensemble(EnsembleError::OtherRun { .. }))));
    }
    let renamed = ensemble().event(member(0).0.event("down", |sample| sample.state().q[0] - 1.0).terminal());
    assert!(renamed.tag("").resume(&table).unwrap().integrate_on_lanes(END, Dop853::default()).is_err());
}
