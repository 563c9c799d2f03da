//! Ensembles of motions across contacts.

use lagrange_core::contact::Contact;
use lagrange_core::ensemble::EnsembleError;
use lagrange_core::{Event, prelude::*};

use lagrange_random::cases;
use lagrange_systems::Ball;

use crate::{arrival, noise};

const COUNT: usize = 60;
const END: f64 = 2.5;

fn member(k: usize) -> (Ball, State<f64, 2>) {
    let [e, h, v] = [0, 1, 2].map(|entry| noise(k, entry));
    (Ball { m: 0.2, g: 9.81, e: 0.9 * e, ..Ball::default() }, State::new([0.0, 0.2 + h], [v, 0.0]))
}

/// Impacts before a time, height and velocity there, by the series of bounces.
fn bouncing(k: usize, t: f64) -> (usize, [f64; 2]) {
    let (Ball { g, e, .. }, State { q, .. }) = member(k);
    let (mut begins, mut speed, mut count) = ((2.0 * q[1] / g).sqrt(), (2.0 * g * q[1]).sqrt() * e, 1);
    if t < begins {
        return (0, [q[1] - g * t * t / 2.0, -g * t]);
    }
    while t >= begins + 2.0 * speed / g && speed > 1e-7 {
        (begins, speed, count) = (begins + 2.0 * speed / g, speed * e, count + 1);
    }
    let since = t - begins;
    if speed > 1e-7 {
        (count, [speed * since - g * since * since / 2.0, speed - g * since])
    } else {
        (count, [0.0; 2])
    }
}

fn lands() -> Event<Ball, impl Fn(&lagrange_core::Sample<&Ball>) -> f64 + Send + Sync> {
    member(0).0.event("lands", |sample| sample.state().q[1]).falling()
}

#[test]
fn members_are_those_of_single_motions_and_of_the_series() {
    let method = Dop853::with_tolerance(1e-12);
    let balls = || Ensemble::from_fn(COUNT, member).event(lands()).every(0.5);
    let outcome =
        balls().quantity("speed", |sample| sample.velocity("y")).integrate_with_contacts(END, method);
    let outcome = outcome.unwrap();
    assert!(outcome.members().iter().map(|member| member.index).eq(0..COUNT));
    let (mut resting, checked) = (0, (0..COUNT).take(cases([15, 60, 60])));
    for k in checked.clone() {
        let arrival = arrival(&outcome, k);
        let (ball, start) = member(k);
        let motion = ball.motion(start).by(method).with_contacts().event(lands()).every(0.5);
        let alone = motion.to(END).unwrap();
        assert_eq!(
            (alone.end().state(), alone.samples(), alone.crossings()),
            (&arrival.state, &arrival.samples[..], &arrival.crossings[..])
        );
        assert_eq!(arrival.samples.len(), 6);
        for (sample, speed) in arrival.samples.iter().zip(outcome.quantity(k, "speed").unwrap()) {
            let (_, [y, v]) = bouncing(k, sample.t);
            assert!((sample.q[1] - y).abs() < 1e-7 && (speed - v).abs() < 1e-6, "{k}: {sample:?} {y} {v}");
        }
        let (count, [_, v]) = bouncing(k, END);
        match v == 0.0 {
            true => resting += 1,
            false => assert_eq!(arrival.crossings.len(), count, "{k}"),
        }
    }
    assert!((checked.len()..11 * checked.len()).contains(&(12 * resting)), "{resting}");
    // In parts, and once more: the same bits.
    let part = |shard| balls().shard(shard, 3).integrate_with_contacts(END, method).unwrap();
    let whole = balls().integrate_with_contacts(END, method).unwrap();
    assert_eq!(whole, part(2).merge(part(0)).unwrap().merge(part(1)).unwrap());
}

#[test]
fn controllers_observers_and_failures_are_those_of_the_member() {
    let balls = Ensemble::from_fn(COUNT, member).controlled(0.25, |index, ball, state| match () {
        () if index == 3 && state.t > 1.0 => Err("enough"),
        () => {
            ball.g = if state.t < 0.5 { 9.81 } else { 0.0 };
            Ok(())
        }
    });
    let outcome = balls.integrate_with_contacts(END, Dop853::default()).unwrap();
    let failed: Vec<usize> = outcome.failures().map(|member| member.index).collect();
    assert_eq!(failed, [3]);
    // Without weight, a ball that rises goes on as it was.
    let rising = (0..COUNT).filter(|&k| k != 3 && bouncing(k, 0.5).1[1] > 0.0);
    for k in rising {
        let (_, [y, v]) = bouncing(k, 0.5);
        let end = arrival(&outcome, k).state;
        assert!((end.q[1] - (y + 2.0 * v)).abs() < 1e-6 && (end.v[1] - v).abs() < 1e-6, "{k}: {end}");
    }
}

#[test]
fn members_that_differ_in_their_contacts_are_not_resumed() {
    let standing =
        |floor| Ensemble::from_fn(2, move |_| (Ball { floor, ..member(0).0 }, State::at_rest([0.0, 0.0])));
    let open = standing(Contact::Open).integrate_with_contacts(1.0, Dop853::default()).unwrap();
    let table = open.json_lines().to_string();
    let again =
        standing(Contact::Open).resume(&table).unwrap().integrate_with_contacts(1.0, Dop853::default());
    assert_eq!(again.unwrap().json_lines().to_string(), table);
    let closed = standing(Contact::Closed).resume(&table).unwrap();
    let error = closed.integrate_with_contacts(1.0, Dop853::default()).unwrap_err();
    assert!(matches!(error, Error::Ensemble(EnsembleError::OtherRun { .. })), "{error}");
}
