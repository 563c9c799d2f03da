//! What serde writes, and reads back.

use std::fmt::Debug;

use lagrange_core::error::Row;
use lagrange_core::prelude::*;
use lagrange_core::{
    Ending, Solution, Statistics, hamiltonian::PhaseDerivative, nalgebra::Const, trajectory::Records,
};
use serde_json::{Value, from_str, from_value, json, to_string, to_value};

use crate::{BlowUp, START};

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[observable(tension = -lambda(rod))]
struct Bob {
    m: f64,
    g: f64,
    l: f64,
}

static BOB: Bob = Bob { m: 1.0, g: 9.81, l: 1.0 };

fn start() -> State<f64, 2> {
    State::at_rest([0.6, -0.8])
}

fn path() -> Trajectory<&'static Bob> {
    BOB.integrate(start(), 3.0, Dop853::default()).expect("a motion")
}

/// Written and read, it is the same to the bit.
fn comes_back<X: serde::Serialize + serde::de::DeserializeOwned + PartialEq + Debug>(x: &X) -> Value {
    let text = to_string(x).expect("written");
    assert_eq!(from_str::<X>(&text).expect("read"), *x, "{text}");
    to_value(x).expect("a value")
}

#[test]
fn numbers_come_back_to_the_bit() {
    let path = path();
    let (end, phase) = (path.end(), BOB.phase_state(path.end().state()));
    assert_eq!(comes_back(&start()), json!({ "t": 0.0, "q": [0.6, -0.8], "v": [0.0, 0.0] }));
    comes_back::<State<f64, 2>>(end.state());
    comes_back::<PhaseState<f64, 2>>(&phase);
    comes_back::<PhaseDerivative<f64, Const<2>, Const<1>>>(&BOB.hamilton_equations(&phase).unwrap());
    let written = comes_back::<Solution<f64, 2, 1>>(&end.solution().unwrap());
    assert_eq!(written["multipliers"], json!([end.multiplier("rod").unwrap()]));
    comes_back::<Statistics>(path.statistics());
    comes_back(&State::at_rest([0.1_f32, 1e-40]));
    let none: State<f64, 0> = State::new([], []);
    comes_back(&none);
}

#[test]
fn samples_come_back_with_their_names() {
    let path = path();
    let records = path.csv(7).energy().records();
    let written = comes_back::<Records<f64>>(&records);
    let names = ["t", "x", "y", "x_dot", "y_dot", "lambda(rod)", "force(x)", "force(y)", "tension", "energy"];
    assert_eq!(written["names"], json!(names));
    let table = path.csv(7).energy().to_string();
    let lines = table.lines().skip(1);
    for (line, row) in lines.zip(&records.rows) {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        assert_eq!(cells, *row);
    }
    assert_eq!(records.rows.len(), 7);
}

/// JSON has no word for what is not a number.
#[test]
fn unknown_numbers_come_back_unknown() {
    let records = Records { names: vec!["x".into(), "y".into()], rows: vec![vec![1.0, f64::NAN]] };
    let text = to_string(&records).unwrap();
    assert_eq!(text, r#"{"names":["x","y"],"rows":[[1.0,null]]}"#);
    let read: Records<f64> = from_str(&text).unwrap();
    assert!(read.rows[0][0] == 1.0 && read.rows[0][1].is_nan());
    // A state is no table: what is no number there is an error.
    let text = to_string(&State::new([f64::NAN, 1.0], [f64::INFINITY, 0.0])).unwrap();
    assert_eq!(text, r#"{"t":0.0,"q":[null,1.0],"v":[null,0.0]}"#);
    assert_eq!(
        from_str::<State<f64, 2>>(&text).unwrap_err().to_string(),
        "a number was NaN or infinite when it was written, for which JSON has `null` alone: invalid type: null, expected f64 at line 1 column 18"
    );
    let phase = to_string(&PhaseState::new([1.0], [1.0]).at_time(f64::NAN)).unwrap();
    assert!(from_str::<PhaseState<f64, 1>>(&phase).unwrap_err().to_string().contains("NaN or infinite"));
    for (length, q) in [(1, json!([1.0])), (3, json!([1.0, 2.0, 3.0]))] {
        let state = json!({ "t": 0.0, "q": q, "v": [0.0, 0.0] });
        let error = from_value::<State<f64, 2>>(state).unwrap_err().to_string();
        assert_eq!(error, format!("invalid length {length}, expected 2 numbers"));
    }
}

#[test]
fn endings_are_written_with_their_names() {
    let path = path();
    assert_eq!(to_value(path.ending()).unwrap(), json!({ "ending": "Complete", "time": 3.0 }));
    let short = BOB.motion(start()).by(Dop853::default().max_steps(3)).towards(3.0).unwrap();
    let time = short.ending().time();
    let Ending::StepLimit { pace, .. } = *short.ending() else { panic!("{}", short.ending()) };
    let pace = json!({ "step": pace.step.unwrap(), "stiffness": null, "time_apart": null });
    let limit = json!({ "ending": "StepLimit", "time": time, "steps": 3, "pace": pace });
    assert_eq!(to_value(short.ending()).unwrap(), limit);
    let path = BlowUp.motion(START).towards(3.0).unwrap();
    let written = to_value(path.ending()).unwrap();
    assert_eq!((&written["ending"], &written["entry"]), (&json!("StepTooSmall"), &json!("x_dot")));
    let error =
        Error::NotProjected { constraint: Row::Constraint("rod"), residual: 1.0, iterations: 3, time: 2.0 };
    let ending = Ending::OffConstraints { time: 2.0, error: error.clone() };
    let expected = json!({ "ending": "OffConstraints", "time": 2.0, "error": error.to_string() });
    assert_eq!(to_value(ending).unwrap(), expected);
}

#[test]
fn drift_and_members_are_written() {
    let drift = to_value(path().drift()).unwrap();
    assert_eq!((drift.as_array().map(Vec::len), &drift[0]["name"]), (Some(1), &json!("energy")));
    let members = [(&BOB, start()), (&BOB, State::at_rest([0.6, 0.0]))];
    let outcome = Ensemble::new(&members).integrate(1.0, Dop853::default()).unwrap();
    let written = to_value(outcome.members()).unwrap();
    let State { t, q, v } = outcome.get(0).unwrap().arrival().unwrap().state;
    assert_eq!(written[0]["ending"], json!("complete"));
    assert_eq!(written[0]["end"], json!({ "t": t, "x": q[0], "y": q[1], "x_dot": v[0], "y_dot": v[1] }));
    let said = written[1]["ending"].as_str().unwrap();
    assert!(said.starts_with("the state violates constraint `rod`"), "{said}");
}
