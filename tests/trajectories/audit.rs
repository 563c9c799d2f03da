//! No number that is wrong without a word: for everything that gives numbers, a state where it cannot know them.

use lagrange_core::error::Row;
use lagrange_core::prelude::*;
use lagrange_core::{Motion, Sample, hamiltonian::HamiltonianVectorField};

/// A bead on a wire that is nowhere for 2·10⁻⁹ s about t = 1/2, which no step meets.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[constraint(wire: x = gap * sqrt((t - 1/2)^2 - 1e-18))]
#[observable(pressure = lambda(wire))]
#[observable(push = m*y_dot)]
struct Bead {
    m: f64,
    gap: f64,
}

static BEAD: Bead = Bead { m: 2.0, gap: 1e-30 };

fn start() -> State<f64, 2> {
    State::new([5e-31, 0.0], [-1e-30, 1.0])
}

fn path() -> Trajectory<&'static Bead> {
    let path = BEAD.integrate(start(), 1.0, Dopri5::with_tolerance(1e-6)).expect("a motion");
    assert!(path.steps().all(|step| (step.time() - 0.5).abs() > 1e-6));
    path
}

fn path_in_momenta() -> Trajectory<&'static Bead, HamiltonianVectorField> {
    let phase = BEAD.phase_state(&start());
    BEAD.motion_in_momenta(phase).by(Dopri5::with_tolerance(1e-6)).to(1.0).expect("a motion")
}

fn knows_nothing(sample: &Sample<&Bead>) {
    assert_eq!(sample.time(), 0.5);
    let numbers =
        [sample.coordinate("x"), sample.coordinate("y"), sample.velocity("y"), sample.momentum("y")];
    assert!(numbers.iter().all(|number| number.as_ref().is_ok_and(|x| x.is_nan())), "{numbers:?}");
    assert!(sample.energy().is_nan() && sample.state().v.iter().all(|v| v.is_nan()));
    let errors = [
        sample.acceleration("y"),
        sample.multiplier("wire"),
        sample.constraint_force("x"),
        sample.observable("pressure"),
        sample.observable("push"),
        sample.solution().map(|solution| solution.pivot),
    ];
    for error in errors {
        assert!(matches!(error, Err(Error::StateNotFinite { .. })), "{error:?}");
    }
    assert!(sample.conserved("p_y").is_ok_and(f64::is_nan));
}

#[test]
fn a_state_between_the_steps_that_no_constraint_allows() {
    let error = path().at(0.5).unwrap_err();
    assert!(
        matches!(error, Error::NotProjected { constraint: Row::Constraint("wire"), time: 0.5, .. }),
        "{error}"
    );
    let error = path_in_momenta().at(0.5).unwrap_err();
    assert!(
        matches!(error, Error::NotProjected { constraint: Row::Constraint("wire"), time: 0.5, .. }),
        "{error}"
    );
    for samples in [path().samples(3).collect::<Vec<_>>(), path_in_momenta().samples(3).collect()] {
        let [first, middle, last] = &samples[..] else { panic!("{samples:?}") };
        knows_nothing(middle);
        for (sample, t) in [(first, 0.0), (last, 1.0)] {
            assert!((sample.coordinate("y").unwrap() - t).abs() < 1e-12);
            assert!((sample.energy() - 1.0).abs() < 1e-12 && sample.multiplier("wire").is_ok());
        }
    }
}

#[test]
fn a_line_of_a_table_there() {
    let path = path();
    let table = path.csv(3).energy().conserved();
    let text = table.to_string();
    let lines: Vec<&str> = text.lines().skip(1).collect();
    let unknown = "0.5".to_string() + &",NaN".repeat(table.records().names.len() - 1);
    assert_eq!(lines[1], unknown);
    assert!(!lines[0].contains("NaN") && !lines[2].contains("NaN"), "{text}");
    let rows = table.records().rows;
    assert!(rows[1][1..].iter().all(|x| x.is_nan()) && rows[0].iter().chain(&rows[2]).all(|x| x.is_finite()));
}

/// The state inside of a step that is steered.
#[test]
fn a_state_within_the_last_step_of_a_motion() {
    let mut motion = Motion::new(&BEAD, start(), Dopri5::with_tolerance(1e-6).fixed_step(1.0)).unwrap();
    motion.advance_to(1.0).unwrap();
    let error = motion.at(0.5).unwrap_err();
    assert!(
        matches!(error, Error::NotProjected { constraint: Row::Constraint("wire"), time: 0.5, .. }),
        "{error}"
    );
    assert!((motion.at(0.75).unwrap().q[1] - 0.75).abs() < 1e-12);
}

/// Times that are none, or elsewhere.
#[test]
fn states_where_there_are_none() {
    let path = path();
    for t in [f64::NAN, f64::INFINITY, -1e-300, 1.0 + f64::EPSILON] {
        assert!(matches!(path.at(t), Err(Error::OutsideTrajectory { .. })), "{t}");
    }
    assert_eq!((path.samples(0).count(), path.csv(0).records().rows.len()), (0, 0));
}

/// ln ẋ is conserved, and no number where x falls; ln(x − ẋ t) is one now and then, from x = 0 on.
#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
#[conserved(speed = ln(x_dot))]
#[conserved(origin = ln(x - x_dot*t))]
struct Free;

#[test]
fn the_drift_of_what_is_no_number() {
    let drift = |x: f64, v: f64| {
        let path = Free.integrate(State::new([x], [v]), 1.0, Dopri5::default().max_step(0.01)).unwrap();
        ["speed", "origin", "energy"].map(|name| *path.drift().get(name).unwrap())
    };
    let [speed, origin, energy] = drift(2.0, 3.0);
    assert!((speed.start - 3_f64.ln()).abs() < 1e-15 && (origin.start - 2_f64.ln()).abs() < 1e-15);
    assert!([speed, origin, energy].iter().all(|deviation| deviation.largest < 1e-12));
    let [speed, _, energy] = drift(2.0, -3.0);
    assert!(speed.start.is_nan() && speed.largest.is_nan() && energy.largest < 1e-12);
    let path = Free.integrate(State::new([1e-16], [0.3]), 1.0, Dopri5::default().max_step(0.01)).unwrap();
    let origins: Vec<f64> = path.steps().map(|step| step.conserved("origin").unwrap()).collect();
    assert!(
        origins[0].is_finite() && origins.iter().any(|x| x.is_nan()) && !origins.iter().all(|x| x.is_nan())
    );
    assert!(path.drift().get("origin").unwrap().largest.is_nan());
}

/// At the pole of polar coordinates, where angles mean nothing.
#[derive(Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(m/2 * (r_dot^2 + r^2 * phi_dot^2) - h*log_of)]
#[define(log_of = ln(r))]
#[observable(area = r^2 * phi_dot / 2)]
struct Polar {
    m: f64,
    h: f64,
}

#[test]
fn a_sample_at_a_pole() {
    let polar = Polar { m: 1.0, h: 0.0 };
    // A start from where a sample can be had, without a step.
    let error = polar.integrate(State::new([0.0, 0.0], [1.0, 0.0]), 0.0, Dopri5::default()).unwrap_err();
    assert!(matches!(error, Error::Singular { .. } | Error::EquationsNotFinite { .. }), "{error}");
    // It runs into the pole, and stops there.
    let polar = Polar { m: 1.0, h: 1.0 };
    let fall = State::at_rest([1.0, 0.0]);
    let error = polar.integrate(fall, 10.0, Dop853::default()).unwrap_err();
    assert!(matches!(&error, Error::Unfinished(ending) if ending.is_failure()), "{error}");
    let path = polar.motion(fall).towards(10.0).unwrap();
    assert!(path.end().time() < 2.0 && path.end().state().q[0] > 0.0);
    assert!(path.csv(50).energy().records().rows.iter().flatten().all(|x| x.is_finite()));
}
