//! Tables, steps and summaries of motions with contacts.

use lagrange_core::contact::{Contact, Transition};
use lagrange_core::prelude::*;
use lagrange_systems::Ball;

/// It falls for one unit of time, and after half of another it rests.
const BALL: Ball = Ball { m: 3.0, g: 2.0, r: 0.0, e: 0.2, thrust: 0.0, floor: Contact::Open };

const START: State<f64, 2> = State {
    t: 0.0,
    q: lagrange_core::nalgebra::SVector::<f64, 2>::new(0.0, 1.0),
    v: lagrange_core::nalgebra::SVector::<f64, 2>::new(0.0, 0.0),
};

/// Height, velocity and force of the floor.
fn expected(t: f64) -> [f64; 3] {
    let (mut begins, mut speed) = (1.0, 2.0 * BALL.e);
    if t < begins {
        return [1.0 - t * t, -2.0 * t, 0.0];
    }
    while speed > 1e-9 {
        if t < begins + speed {
            let since = t - begins;
            return [speed * since - since * since, speed - 2.0 * since, 0.0];
        }
        (begins, speed) = (begins + speed, speed * BALL.e);
    }
    [0.0, 0.0, 6.0]
}

#[test]
fn a_table_has_the_system_of_each_time() {
    let path = BALL.motion(START).by(Taylor::with_tolerance(1e-15)).with_contacts();
    let path = path.to(2.0).unwrap();
    let records = path.csv(400).energy().records();
    assert_eq!(
        records.names,
        ["t", "x", "y", "x_dot", "y_dot", "lambda(floor)", "force(x)", "force(y)", "height", "energy"]
    );
    for row in &records.rows {
        let [t, _, y, _, v, lambda, _, force, height, energy] = row[..] else { panic!("{row:?}") };
        let [at, speed, push] = expected(t);
        assert!((y - at).abs() < 1e-12 && (v - speed).abs() < 1e-9, "{row:?} {at} {speed}");
        assert!((lambda - push).abs() < 1e-12 && force == lambda, "{row:?}");
        assert!(height == 2.0 * y && (energy - (1.5 * v * v + 6.0 * y)).abs() < 1e-12);
    }
    assert_eq!((records.rows[0][0], records.rows[399][0]), (0.0, 2.0));
    let text = path.csv(400).energy().to_string();
    let read = text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect());
    assert_eq!(read.collect::<Vec<Vec<f64>>>(), records.rows);
    for sample in path.samples(7) {
        assert_eq!(path.at(sample.time()).unwrap().state(), sample.state());
    }
}

#[test]
fn steps_have_both_states_of_an_impact() {
    let path = BALL.motion(START).with_contacts().to(2.0).unwrap();
    let Transition::Impact { time, .. } = path.transitions()[0] else { panic!("{path:?}") };
    let at_impact: Vec<f64> =
        path.steps().filter(|step| step.time() == time).map(|step| step.state().v[1]).collect();
    assert!(
        matches!(at_impact[..], [before, after] if (before + 2.0).abs() < 1e-8 && (after - 0.4).abs() < 1e-8)
    );
    assert_eq!(path.steps().last().unwrap().state(), path.end().state());
    assert_eq!(path.steps().next().unwrap().state(), &START);
    let lambda = |t| path.at(t).unwrap().multiplier("floor").unwrap();
    assert!(lambda(0.5) == 0.0 && (lambda(2.0) - 6.0).abs() < 1e-14);
    // The motion loses its energy, 6, but for what is left by round-off.
    let drift = path.drift();
    assert!((drift.get("energy").unwrap().largest - 6.0).abs() < 1e-12, "{drift}");
    for t in [-0.1, 2.1, f64::NAN] {
        assert!(matches!(path.at(t), Err(Error::OutsideTrajectory { .. })));
    }
}

#[test]
fn a_summary_counts_the_transitions() {
    let path = BALL.motion(START).with_contacts().to(2.0).unwrap();
    let impacts = path.transitions().len() - 1;
    let (steps, rest) = path.to_string().split_once('\n').map(|(a, b)| (a.to_owned(), b.to_owned())).unwrap();
    assert!(steps.starts_with("Ball from t = 0 to t = 2: ") && steps.ends_with(" evaluations"), "{steps}");
    let expected = format!("{impacts} impacts, 1 rest; closed at the end: `floor`\nreached the end at t = 2");
    assert_eq!(rest, expected);
    let path = BALL.motion(START).with_contacts().to(1.2).unwrap();
    assert!(path.to_string().ends_with(" evaluations\n1 impact\nreached the end at t = 1.2"), "{path}");
    let path = BALL.motion(START).with_contacts().to(0.1).unwrap();
    assert!(path.to_string().contains("\nno transitions\n"), "{path}");
}
