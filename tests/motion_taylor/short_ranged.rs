//! Forces that are nothing where a step begins, and strong within: none is stepped over, alone or on lanes.
//!
//! A failure says the number of its case.

use lagrange_core::{Lanes, Pack, TaylorSeries, nalgebra::Const, prelude::*};
use std::f64::consts::PI;

use lagrange_random::{Random, cases};

use super::control::Pulse;

const END: f64 = 12.0;
const TOLERANCES: [f64; 4] = [f64::EPSILON, 1e-12, 1e-9, 1e-6];

/// A step of the potential, from 0 to `a` within a few `w` of `c`.
#[derive(Lagrangian, Clone)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k*x^2/2 - a/2*(1 + tanh((x - c)/w)))]
struct Step<T> {
    k: T,
    a: T,
    c: T,
    w: T,
}

/// A scatterer.
#[derive(Lagrangian, Clone)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2 - k*x^2/2 - a*exp(-(x - c)^2/(2*w^2)))]
struct Scatterer<T> {
    k: T,
    a: T,
    c: T,
    w: T,
}

/// Pulses one after the other, `c` apart.
#[derive(Lagrangian, Clone)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
#[force(x: a*sin(pi*t/c)^400)]
struct Train<T> {
    a: T,
    c: T,
}

/// The same pulses, half of the interval earlier, with an exponent that is known at run time, half of the power of the cosine.
#[derive(Lagrangian, Clone)]
#[coordinates(x)]
#[lagrangian(x_dot^2/2)]
#[force(x: a*((1 + cos(2*pi*t/c))/2)^p)]
struct TrainOfPower<T> {
    a: T,
    c: T,
    p: T,
}

/// A system, its start, and by how much an end is off, as a part of what the force makes of it.
type Case<L> = (L, State<f64, 1>, Box<dyn Fn(&L, &State<f64, 1>) -> f64 + Send + Sync>);

/// Each case by Taylor's method alone and on lanes: a force that is stepped over would be off by 1.
fn are_seen<L>(few: usize, case: impl Fn(&mut Random) -> Case<L> + Sync) -> Result<(), Error>
where
    L: TaylorSeries<N = Const<1>, M = Const<0>, Scalar = f64>
        + Pack<Lanes, Packed: TaylorSeries<N = Const<1>, M = Const<0>, Scalar = Lanes>>,
{
    let count = cases([few, few, 3_000]);
    for tolerance in TOLERANCES {
        let (method, allowed) = (Taylor::with_tolerance(tolerance), (1e4 * tolerance).clamp(1e-6, 0.1));
        let case = |index: usize| case(&mut Random(index as u64));
        let members = Ensemble::from_fn(count, |index| {
            let (system, start, _) = case(index);
            (system, start)
        });
        let outcome = members.integrate_on_lanes(END, method)?;
        for index in 0..count {
            let (system, start, off) = case(index);
            let alone = *system
                .integrate(start, END, method)
                .unwrap_or_else(|error| panic!("case {index}, {tolerance:e}: {error}"))
                .end()
                .state();
            let abreast = outcome.get(index).and_then(|member| member.arrival()).map(|arrival| arrival.state);
            for (end, how) in [(Some(alone), "alone"), (abreast, "on lanes")] {
                let off = off(&system, &end.expect("an end"));
                assert!(off < allowed, "case {index}, {tolerance:e}, {how}: {off:e}");
            }
        }
    }
    Ok(())
}

/// The energy is what it was: that of a motion that did not see the step is off by `a`.
#[test]
fn steps_of_the_potential() -> Result<(), Error> {
    are_seen(12, |random| {
        let k = random.size(0.1, 4.0) * f64::from(random.between(0.0, 1.0) > 0.5);
        let c = if k > 0.0 { random.between(-0.9, 0.9) / k.sqrt() } else { random.between(1.0, 11.0) };
        // An eighth of what the mass has to climb with.
        let (a, w) = (random.between(0.05, 0.4), random.size(0.01, 1.0));
        let (step, start) = (Step { k, a, c, w }, State::new([0.0], [1.0]));
        let before = step.energy(&start);
        (step, start, Box::new(move |step, end| (step.energy(end) - before).abs() / a))
    })
}

#[test]
fn pulses() -> Result<(), Error> {
    are_seen(12, |random| {
        let k = random.size(0.1, 4.0) * f64::from(random.between(0.0, 1.0) > 0.5);
        let (a, w) = (random.size(0.01, 1.0), random.size(0.01, 0.5));
        let c = random.between(8.0 * w, END - 8.0 * w);
        let whole = a * w * (2.0 * PI).sqrt();
        // What is left of a force is its Fourier transform (Landau and Lifshitz, *Mechanics*, (22.10)).
        let omega = k.sqrt();
        let kick = whole * (-(omega * w).powi(2) / 2.0).exp();
        let (sine, cosine) = (omega * (END - c)).sin_cos();
        let free = k == 0.0;
        let expected = if free { [whole * (END - c), whole] } else { [kick * sine / omega, kick * cosine] };
        let off = move |_: &Pulse<f64>, end: &State<f64, 1>| {
            (end.q[0] - expected[0]).abs().max((end.v[0] - expected[1]).abs()) / whole / END
        };
        (Pulse { k, a, c, w }, State::at_rest([0.0]), Box::new(off))
    })
}

/// The mean of an even power of a sine is (2n)!/(2ⁿ n!)².
fn train<L>(a: f64, power: u32, train: L) -> Case<L> {
    let mean: f64 = (1..=power / 2).map(|n| 1.0 - 1.0 / f64::from(2 * n)).product();
    let expected = a * mean * END;
    (train, State::at_rest([0.0]), Box::new(move |_, end| (end.v[0] / expected - 1.0).abs()))
}

#[test]
fn trains_of_pulses() -> Result<(), Error> {
    are_seen(3, |random| {
        let (a, c) = (random.between(0.1, 1.0), END / random.between(2.0, 30.0).floor());
        train(a, 400, Train { a, c })
    })?;
    are_seen(12, |random| {
        let (a, c) = (random.between(0.1, 1.0), END / random.between(2.0, 12.0).floor());
        let p = random.between(20.0, 500.0).floor();
        train(a, 2 * p as u32, TrainOfPower { a, c, p })
    })
}

/// Against a pair whose steps cannot be longer than half of the width.
#[test]
fn scatterers() -> Result<(), Error> {
    are_seen(4, |random| {
        let k = random.size(0.1, 4.0) * f64::from(random.between(0.0, 1.0) > 0.5);
        let c = if k > 0.0 { random.between(-0.9, 0.9) / k.sqrt() } else { random.between(1.0, 11.0) };
        let (a, w) = (random.between(0.05, 0.4), random.size(0.02, 1.0));
        let (system, start) = (Scatterer { k, a, c, w }, State::new([0.0], [1.0]));
        let by_pair = |system: &Scatterer<f64>| {
            let method = Dop853::with_tolerance(1e-13).max_step(w / 2.0);
            *system.integrate(start, END, method).expect("a motion").end().state()
        };
        let [expected, without] = [by_pair(&system), by_pair(&Scatterer { a: 0.0, ..system.clone() })];
        let far = move |one: &State<f64, 1>| (one.q - expected.q).amax().max((one.v - expected.v).amax());
        // Some turn back before the scatterer, and feel next to nothing of it.
        let effect = far(&without).max(1e-3);
        (system, start, Box::new(move |_, end| far(end) / effect))
    })
}
