use crate::fixtures::{GRAVITY, Mechanism, oscillator, rolling_sphere, spherical_pendulum};
use crate::prelude::*;

type Pendulum = Mechanism<3, 1, 1>;

fn close(a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * b.abs(), "{a} is not {b} to {relative}");
}

#[test]
fn a_sphere_rolls_down_an_incline() {
    let sphere = rolling_sphere();
    let g = GRAVITY * 0.3_f64.sin();
    let path = sphere.integrate(State::at_rest([0.0, 0.0]), 3.0, Dop853::with_tolerance(1e-12)).unwrap();
    let end = path.end();
    close(end.coordinate("x").unwrap(), 0.5 * 5.0 / 7.0 * g * 9.0, 1e-12);
    close(end.velocity("y").unwrap(), 5.0 / 7.0 * g * 3.0 / 0.1, 1e-12);
    close(end.acceleration("x").unwrap(), 5.0 / 7.0 * g, 1e-14);
    close(end.multiplier("c0").unwrap(), -2.0 / 7.0 * 2.0 * g, 1e-14);
    close(end.constraint_force("y").unwrap(), 0.1 * 2.0 / 7.0 * 2.0 * g, 1e-14);
    assert_eq!(*path.ending(), Ending::Complete { time: 3.0 });
    assert!(path.multipliers_are_unique());
}

fn starts() -> [State<f64, 3>; 4] {
    [
        State::new([0.6, 0.0, -0.8], [0.0, 1.0, 0.0]),
        State::new([0.0, 1.0, 0.0], [0.5, 0.0, 0.0]),
        State::new([0.0, 0.6, 0.8], [0.3, 0.4, -0.3]),
        State::new([0.28, 0.0, -0.96], [0.0, 6.0, 0.0]),
    ]
}

/// The largest |Φ| and |Φ̇|, as fractions of the squared length and of length times speed.
fn off_constraints<'a>(
    pendulum: &Pendulum,
    samples: impl Iterator<Item = Sample<'a, Pendulum, 3, 1>>,
) -> f64 {
    samples.fold(0.0, |most, sample| {
        let s = sample.state();
        let phi = pendulum.constraint_residual(s)[0].abs();
        let rate = pendulum.constraint_rate(s)[0].abs() / s.v.norm().max(1.0);
        most.max(phi).max(rate)
    })
}

fn drift(path: &Trajectory<'_, Pendulum, 3, 1>) -> (f64, f64) {
    let energy = |s: &State<f64, 3>| 0.5 * s.v.norm_squared() + GRAVITY * s.q[2];
    let moment = |s: &State<f64, 3>| s.q[0] * s.v[1] - s.q[1] * s.v[0];
    let start = path.start();
    let (e, l) = (energy(start.state()), moment(start.state()));
    path.steps().fold((0.0, 0.0), |(de, dl), sample| {
        let s = sample.state();
        (f64::max(de, (energy(s) - e).abs() / GRAVITY), f64::max(dl, (moment(s) - l).abs()))
    })
}

fn swing(method: impl Method<Pendulum, 3, 1> + Copy, bound: f64) {
    let pendulum = spherical_pendulum();
    for start in starts() {
        let path = pendulum.integrate(start, 100.0, method).unwrap();
        assert!(path.ending().is_complete(), "{}", path.ending());
        let (at_steps, between) =
            (off_constraints(&pendulum, path.steps()), off_constraints(&pendulum, path.samples(20_001)));
        let (energy, moment) = drift(&path);
        std::eprintln!("{:?}: {at_steps:e} {between:e} {energy:e} {moment:e}", path.statistics());
        assert!(at_steps < 1e-12, "{at_steps:e} off at the steps");
        assert!(between < 1e-9, "{between:e} off between the steps");
        assert!(energy < bound && moment < bound, "energy drifts by {energy:e}, momentum by {moment:e}");
    }
}

#[test]
fn dop853_keeps_a_spherical_pendulum_on_its_sphere() {
    swing(Dop853::with_tolerance(1e-10), 2e-8);
    swing(Dop853::with_tolerance(1e-12), 1e-10);
}

#[test]
fn dopri5_keeps_a_spherical_pendulum_on_its_sphere() {
    swing(Dopri5::with_tolerance(1e-10), 1e-7);
}

/// Slopes of log error over log step, of the end and of the interpolant in between, over five halvings.
fn slopes<P: Copy>(method: impl Fn(f64) -> P, first: f64) -> (f64, f64)
where
    P: Method<Mechanism<1, 0, 0>, 1, 0>,
{
    let system = oscillator();
    let errors = |h: f64| {
        let path = system.integrate(State::new([1.0], [0.0]), 8.0, method(h)).unwrap();
        let error = |s: &Sample<'_, Mechanism<1, 0, 0>, 1, 0>| {
            let (t, q, v) = (s.time(), s.state().q[0], s.state().v[0]);
            (q - t.cos()).hypot(v + t.sin())
        };
        (error(&path.end()), path.samples(1000).map(|s| error(&s)).fold(0.0, f64::max))
    };
    let (coarse, fine) = (errors(first), errors(first / 16.0));
    ((coarse.0 / fine.0).log2() / 4.0, (coarse.1 / fine.1).log2() / 4.0)
}

#[test]
fn the_orders_of_convergence_are_five_and_eight() {
    let (end, between) = slopes(|h| Dopri5::default().fixed_step(h), 0.5);
    std::eprintln!("{end} {between}");
    assert!(end >= 4.9 && between >= 4.5, "{end}, {between}");
    let (end, between) = slopes(|h| Dop853::default().fixed_step(h), 2.0);
    std::eprintln!("{end} {between}");
    assert!(end >= 7.7 && between >= 7.5, "{end}, {between}");
}
