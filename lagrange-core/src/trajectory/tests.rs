use std::format;
use std::string::ToString;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::vec::Vec;

use crate::fixtures::{GRAVITY, Mechanism, free, oscillator, rolling_sphere, spherical_pendulum};
use crate::prelude::*;

#[test]
fn a_state_is_set_up_by_names() {
    let system = free::<4>(|_| [0.0; 4]);
    let state = system.state_from(&[("y", 0.1), ("x_dot", 1.0), ("w[0]", 2.0), ("w_dot[0]", 3.0)]).unwrap();
    assert_eq!(state, State::new([0.0, 0.1, 0.0, 2.0], [1.0, 0.0, 0.0, 3.0]));
    let error = system.state_from(&[("q", 1.0)]).unwrap_err();
    let names = "`x`, `y`, `z` and 5 more";
    assert_eq!(format!("{error}"), format!("there is no coordinate or velocity `q`; there are {names}"));
    let error = system.state_from(&[("x", 1.0), ("x", 1.0)]).unwrap_err();
    assert_eq!(error, Error::RepeatedName { name: "x".into() });
}

#[test]
fn a_sample_is_written_with_its_names() {
    let system = free::<4>(|_| [0.0; 4]);
    let sample = system.sample(State::new([0.5, 2e-17, -1.0, 2.0], [1.0, 0.0, 0.25, 3.0]).at_time(1.5));
    let expected = "t = 1.5: x = 0.5, y = 2e-17, z = -1.0, w[0] = 2.0, x_dot = 1.0, y_dot = 0.0, z_dot = 0.25, w_dot[0] = 3.0";
    assert_eq!(sample.to_string(), expected);
    assert!(format!("{sample:.3}").starts_with("t = 1.500: x = 0.500"));
}

#[test]
fn unknown_names_and_times_are_refused() {
    let system = oscillator();
    let path = system.integrate(State::new([1.0], [0.0]), 1.0, Dop853::default()).unwrap();
    let error = path.end().coordinate("phi").unwrap_err();
    assert_eq!(format!("{error}"), "there is no coordinate `phi`; there are `x`");
    let error = path.end().multiplier("rod").unwrap_err();
    assert_eq!(format!("{error}"), "there is no constraint `rod`; the system has none");
    assert!(path.end().observable("energy").is_err() && path.end().observable("kinetic").is_ok());
    for t in [-0.1, 1.1, f64::NAN] {
        assert!(matches!(path.at(t), Err(Error::OutsideTrajectory { start: 0.0, end: 1.0, .. })));
    }
}

#[test]
fn samples_are_evenly_spaced_and_end_at_the_end() {
    let system = oscillator();
    let path = system.integrate(State::new([1.0], [0.0]).at_time(0.1), 0.8, Dop853::default()).unwrap();
    let times: Vec<f64> = path.samples(8).map(|sample| sample.time()).collect();
    assert_eq!((times.len(), times[0], times[7]), (8, 0.1, 0.8));
    assert!(times.windows(2).all(|t| (t[1] - t[0] - 0.1).abs() < 1e-15));
    assert_eq!((path.samples(0).count(), path.samples(1).count()), (0, 1));
}

/// The span from −0.1 to 1000 is rounded up, and parts near 1 round to 1.
#[test]
fn no_sample_is_past_the_last() {
    for (first, last) in [(-0.1_f32, 1e3), (-1e-3, 4.0), (-f32::MAX, f32::MAX), (0.0, f32::MAX)] {
        for part in [1.0, 1.0 - 1e-9, 1.0 - 1e-7, 1.0 - 1e-6, 0.75, 0.5, 1e-9, 0.0] {
            let t = super::stored::between(first, last, part);
            let exact = f64::from(first) * (1.0 - part) + f64::from(last) * part;
            assert!((first..=last).contains(&t), "{t} at {part} from {first} to {last}");
            let off = (f64::from(t) - exact).abs() / f64::from(last.max(-first));
            assert!(off < 4.0 * f64::from(f32::EPSILON), "off by {off:e} at {part} from {first} to {last}");
        }
        assert_eq!(
            (super::stored::between(first, last, 0.0), super::stored::between(first, last, 1.0)),
            (first, last)
        );
    }
}

#[test]
fn a_table_reads_back_the_same() {
    let sphere = rolling_sphere();
    let path = sphere.integrate(State::at_rest([0.0, 0.0]), 3.0, Dop853::default()).unwrap();
    let csv = path.csv(4).to_string();
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("t,x,y,x_dot,y_dot,lambda(c0),force(x),force(y),kinetic"));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 4);
    for (row, sample) in rows.iter().zip(path.samples(4)) {
        let (state, lambda) = (sample.state(), sample.multiplier("c0").unwrap());
        let expected = [
            state.t,
            state.q[0],
            state.q[1],
            state.v[0],
            state.v[1],
            lambda,
            lambda,
            -0.1 * lambda,
            sample.observable("kinetic").unwrap(),
        ];
        assert_eq!(row[..], expected);
    }
}

#[test]
fn a_table_says_nan_where_the_equations_have_no_solution() {
    // Singular only at t = 0.5: no step evaluates there, but a sample does.
    let mass = |s: &State<f64, 1>| [[if s.t == 0.5 { 0.0 } else { 1.0 }]];
    let bead = Mechanism::<1, 1, 0> {
        mass,
        forcing: |_| [1.0],
        residual: |_| [0.0],
        rate: |_| [0.0],
        jacobian: |_| [[0.0]],
        bias: |_| [0.0],
    };
    let path = bead.integrate(State::at_rest([0.0]), 1.0, Dopri5::default()).unwrap();
    assert!(path.ending().is_complete() && path.at(0.5).unwrap().multiplier("c0").is_err());
    let csv = path.csv(3).to_string();
    let nan: Vec<bool> = csv.lines().map(|line| line.contains(",NaN,NaN")).collect();
    assert_eq!(nan, [false, false, true, false], "{csv}");
}

/// The search for the velocity that belongs to interpolated momenta starts from this velocity.
#[test]
fn between_the_steps_the_velocity_is_that_of_the_interpolant() {
    let system = oscillator();
    let path = system.integrate(State::new([1.0], [0.0]), 3.0, Dop853::with_tolerance(1e-10)).unwrap();
    for i in 0..30 {
        let t = 0.1 * f64::from(i);
        let point = path.legs()[0].path.at(t).unwrap();
        assert!((point.velocity[0] + t.sin()).abs() < 1e-7 && (point.y[1][0] + t.sin()).abs() < 1e-9);
    }
}

/// The forces are evaluated only when the equations are solved, so they count the solves.
#[test]
fn a_line_of_a_table_solves_once() {
    static SOLVED: AtomicUsize = AtomicUsize::new(0);
    let bob = Mechanism::<3, 1, 1> {
        forcing: |_| {
            SOLVED.fetch_add(1, Ordering::Relaxed);
            [0.0, 0.0, -GRAVITY]
        },
        ..spherical_pendulum()
    };
    let path = bob.integrate(State::at_rest([0.6, 0.0, -0.8]), 3.0, Dop853::default()).unwrap();
    let before = SOLVED.load(Ordering::Relaxed);
    let table = path.csv(20).energy().conserved().to_string();
    assert_eq!((table.lines().count(), SOLVED.load(Ordering::Relaxed) - before), (21, 20));
}
