//! Taylor's method on lanes: each member as it moves alone by it, and nothing from its neighbours.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Mutex;

use lagrange_core::prelude::*;
use lagrange_core::{Ending, ensemble::Arrival, generic::StaticLength};

use lagrange_systems::{PushedSpring, Thrown};

use crate::{COUNT, END, arrival, constraints, ensemble, far, fields, member, noise, on_threads};

fn steps<N: StaticLength>(arrival: &Arrival<f64, N>) -> [usize; 3] {
    let statistics = &arrival.statistics;
    [statistics.accepted, statistics.rejected, statistics.evaluations]
}

/// By the rounding of sines and sums, in a second in which chaos makes little of it; and as another method has it.
#[test]
fn each_member_moves_as_it_does_alone() -> Result<(), Error> {
    for (tolerance, close) in [(f64::EPSILON, 1e-12), (1e-9, 1e-9)] {
        let method = Taylor::with_tolerance(tolerance);
        let outcome = ensemble().integrate_on_lanes(END, method)?;
        assert_eq!(outcome.completed().count(), COUNT);
        for (index, state) in outcome.completed() {
            let (system, start) = member(index);
            let path = system.integrate(start, END, method)?;
            let off = (state.q - path.end().state().q).amax().max((state.v - path.end().state().v).amax());
            assert!(off < 1e-12, "member {index} is off by {off:e}");
            let alone = path.statistics();
            let alone = [alone.accepted, alone.rejected, alone.evaluations];
            assert_eq!(steps(arrival(&outcome, index)), alone, "member {index}");
            let path = system.integrate(start, END, Dop853::with_tolerance(1e-14))?;
            let off = (state.q - path.end().state().q).amax();
            assert!(off < 10.0 * close, "member {index} is off by {off:e}");
        }
    }
    Ok(())
}

#[derive(Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2*x_dot^2 - k/2*x^2 + m*x*cos(5*t))]
struct Driven<T> {
    m: T,
    k: T,
}

/// Where a spring driven by cos 5t is, and how fast, with x = 0.5 and ẋ = −1 at the time `from`.
fn driven(omega: f64, from: f64, t: f64) -> (f64, f64) {
    let forced =
        |t: f64| ((5.0 * t).cos() / (omega.powi(2) - 25.0), -5.0 * (5.0 * t).sin() / (omega.powi(2) - 25.0));
    let (a, b) = (0.5 - forced(from).0, (-1.0 - forced(from).1) / omega);
    let (sin, cos) = (omega * (t - from)).sin_cos();
    (a * cos + b * sin + forced(t).0, omega * (b * cos - a * sin) + forced(t).1)
}

/// Explicit time, each with its own parameters and its own start; there and back.
#[test]
fn driven_springs_swing_to_round_off() -> Result<(), Error> {
    let k = |index: usize| 1.0 + 20.0 * noise(index, 0);
    let from = |index: usize| 2.0 * noise(index, 1);
    let springs = || {
        Ensemble::from_fn(50, |index| {
            (Driven { m: 2.0, k: k(index) }, State::new([0.5], [-1.0]).at_time(from(index)))
        })
    };
    for (outcome, end, most) in [
        (springs().integrate_on_lanes(7.0, Taylor::default())?, 7.0, 1e-13),
        (springs().integrate_on_lanes(-5.0, Taylor::default())?, -5.0, 1e-13),
        (springs().integrate_on_lanes(7.0, Dop853::with_tolerance(1e-12))?, 7.0, 1e-9),
    ] {
        assert_eq!(outcome.completed().count(), 50);
        for (index, state) in outcome.completed() {
            let omega = (k(index) / 2.0).sqrt();
            let (x, v) = driven(omega, from(index), end);
            // Near resonance the formula cancels.
            let off = (state.q[0] - x).hypot(state.v[0] - v) * (omega - 5.0).abs().min(1.0);
            assert!(state.t == end && off < most, "member {index} is off by {off:e}");
        }
    }
    Ok(())
}

/// Every step of every member, |Φ| and |Φ̇| in units of the last place, and the energy.
#[test]
fn members_with_a_multiplier_stay_on_their_spheres() -> Result<(), Error> {
    let worst = Mutex::new(([0.0_f64; 3], 0_usize));
    let watched = Ensemble::from_fn(21, constraints::member).observe(|index, state| {
        let (system, start) = constraints::member(index);
        let speed = state.v.amax().max(1.0);
        let off = [
            system.constraint_residual(state)[0].abs() / system.l.powi(2),
            system.constraint_rate(state)[0].abs() / (system.l * speed),
            (system.energy(state) - system.energy(&start)).abs(),
        ];
        let mut worst = worst.lock().expect("a number");
        *worst = (std::array::from_fn(|i| worst.0[i].max(off[i])), worst.1 + 1);
        ControlFlow::Continue(())
    });
    let outcome = watched.integrate_on_lanes(10.0, Taylor::default())?;
    let ([phi, rate, energy], count) = worst.into_inner().expect("a number");
    assert_eq!(outcome.completed().count(), 21);
    println!("{phi:e} {rate:e} {energy:e}");
    let ulp = f64::EPSILON;
    assert!(
        count > 21 * 50 && phi < 4.0 * ulp && rate < 4.0 * ulp && energy < 1e-12,
        "{phi:e}, {rate:e}, {energy:e}"
    );
    for (index, state) in outcome.completed() {
        let (system, start) = constraints::member(index);
        let path = system.integrate(start, 10.0, Taylor::default())?;
        let off = (state.q - path.end().state().q).amax();
        assert!(off < 1e-11, "member {index} is off by {off:e}");
        let alone = Ensemble::from_fn(21, constraints::member)
            .members([index])
            .integrate_on_lanes(10.0, Taylor::default())?;
        assert_eq!(alone.members(), &outcome.members()[index..=index]);
    }
    Ok(())
}

/// Three masses on rods, one after the other.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(x: [3], y: [3])]
#[lagrangian(sum(i in 0..3, m[i]*((x_dot[i]^2 + y_dot[i]^2)/2 - g*y[i])))]
#[constraint(first: (x[0]^2 + y[0]^2 - l[0]^2)/2 = 0)]
#[constraint(rod[i in 1..3]: ((x[i] - x[i - 1])^2 + (y[i] - y[i - 1])^2 - l[i]^2)/2 = 0)]
struct Rods<T> {
    m: [T; 3],
    l: [T; 3],
    g: T,
}

fn rods(index: usize) -> (Rods<f64>, State<f64, 6>) {
    let n = |entry| 0.5 + noise(index, entry);
    let system = Rods { m: [n(0), n(1), n(2)], l: [n(3), n(4), n(5)], g: 9.81 };
    let (mut q, mut x, mut y) = ([0.0; 6], 0.0, 0.0);
    for i in 0..3 {
        let (sin, cos) = (n(6 + i) - 0.2).sin_cos();
        (x, y) = (x + system.l[i] * sin, y - system.l[i] * cos);
        (q[i], q[3 + i]) = (x, y);
    }
    (system, State::at_rest(q))
}

/// Samples lie on the series, on the constraints and with the multipliers of the equations.
#[test]
fn rods_have_samples_with_their_multipliers() -> Result<(), Error> {
    let times = || (0..=20).map(|k| 0.1 * f64::from(k));
    let sampled = || {
        Ensemble::from_fn(9, rods)
            .samples_at(times())
            .quantity("pull", |sample| sample.multiplier("first"))
            .quantity("energy", |sample| sample.energy())
    };
    let plain = Ensemble::from_fn(9, rods).integrate_on_lanes(2.0, Taylor::default())?;
    let outcome = sampled().integrate_on_lanes(2.0, Taylor::default())?;
    for index in 0..9 {
        let (system, start) = rods(index);
        let path = system.integrate(start, 2.0, Dop853::with_tolerance(1e-14))?;
        let found = arrival(&outcome, index);
        assert_eq!(
            (found.state, steps(found)),
            (arrival(&plain, index).state, steps(arrival(&plain, index)))
        );
        assert_eq!(found.samples.len(), 21);
        for ((state, pull), t) in found.samples.iter().zip(outcome.quantity(index, "pull")?).zip(times()) {
            let there = path.at(t)?;
            let off = (state.q - there.state().q).amax();
            assert!(state.t == t && off < 1e-9, "member {index} at {t} is off by {off:e}");
            assert!((pull - there.multiplier("first")?).abs() < 1e-8);
            assert!(system.constraint_residual(state).amax() < 1e-14);
        }
        let energy = system.energy(&start);
        assert!(outcome.quantity(index, "energy")?.all(|sampled| (sampled - energy).abs() < 1e-12));
        let alone = sampled().members([index]).integrate_on_lanes(2.0, Taylor::default())?;
        assert_eq!(alone.members(), &outcome.members()[index..=index]);
    }
    Ok(())
}

/// A mass that falls into a centre, or rises from it where `p` keeps it off.
#[derive(Lagrangian, Clone, Copy)]
#[coordinates(r)]
#[lagrangian(r_dot^2/2 + k/r - p/r^2)]
struct Fall<T> {
    k: T,
    p: T,
}

/// Five of eight that need a lane fall in, from another height each; one starts in the centre. From rest at r it takes
/// π √(r³/8k) to fall.
#[test]
fn collisions_end_their_members_alone() -> Result<(), Error> {
    let height = |index: usize| 0.5 + 0.2 * index as f64;
    let falls = |index: usize| match index % 3 {
        0 => (Fall { k: 1.0, p: 0.0 }, State::at_rest([height(index)])),
        _ => (Fall { k: 1.0, p: 0.3 }, State::at_rest([height(index)])),
    };
    let with_singular = |index: usize| match index {
        4 => (Fall { k: 1.0, p: 0.0 }, State::at_rest([0.0])),
        _ => falls(index),
    };
    let run = |threads, member: &(dyn Fn(usize) -> (Fall<f64>, State<f64, 1>) + Send + Sync)| {
        on_threads(threads, || Ensemble::from_fn(13, member).integrate_on_lanes(20.0, Taylor::default()))
    };
    let (well, outcome) = (run(1, &falls)?, run(1, &with_singular)?);
    assert_eq!(outcome, run(3, &with_singular)?);
    let singular = outcome.get(4).expect("a member");
    assert!(matches!(singular.result, Err(Error::EquationsNotFinite { .. })), "{singular}");
    for index in (0..13).filter(|index| *index != 4) {
        assert_eq!(outcome.get(index), well.get(index));
        let (arrival, (system, start)) = (arrival(&outcome, index), falls(index));
        if index % 3 == 0 {
            let expected = PI * (height(index).powi(3) / 8.0).sqrt();
            let off = arrival.ending.time() - expected;
            assert!(!arrival.ending.is_complete() && off.abs() < 1e-9, "{:?}: {off:e}", arrival.ending);
        } else {
            let energy = (system.energy(&arrival.state) - system.energy(&start)).abs();
            assert!(arrival.ending.is_complete() && energy < 1e-12, "{energy:e}");
        }
    }
    Ok(())
}

/// Each with its own time, count and ending; lanes are given to others on the way. x = cos √k t.
#[test]
fn events_end_members_at_their_times() -> Result<(), Error> {
    let k = |index: usize| 1.0 + noise(index, 0);
    let spring = |index: usize| {
        (PushedSpring { m: 1.0, k: k(index), ..PushedSpring::default() }, State::at_rest([1.0]))
    };
    let count = |index: usize| 1 + index % 5;
    let any = spring(0).0;
    let run = |indices: Vec<usize>| {
        let ends = any.event("ends", |s| s.state().q[0]).terminal_at(4);
        let turns = any.event("turns", |s| s.state().v[0]).rising();
        Ensemble::from_fn(30, spring)
            .members(indices)
            .event(ends)
            .event(turns)
            .samples_at((0..40).map(|tick| 0.25 * f64::from(tick)))
            .integrate_on_lanes(20.0, Taylor::default())
    };
    let whole = run((0..30).collect())?;
    for index in 0..30 {
        let (found, omega) = (arrival(&whole, index), k(index).sqrt());
        let Ending::Event { event: "ends", time } = found.ending else { panic!("{found:?}") };
        assert!((time * omega - 3.5 * PI).abs() < 1e-14 * 3.5 * PI, "member {index}: {time}");
        let turns = found.crossings.iter().filter(|crossing| crossing.event == "turns");
        let times: Vec<f64> = turns.map(|crossing| crossing.state.t * omega / PI).collect();
        // At rest on the left at π and 3π: the velocity rises there.
        assert!(
            times.len() == 2 && times.iter().zip([1.0, 3.0]).all(|(t, n)| (t - n).abs() < 1e-14),
            "{times:?}"
        );
        for state in &found.samples {
            assert!((state.q[0] - (omega * state.t).cos()).abs() < 1e-14);
        }
        assert_eq!(found.samples.len(), (0..40).filter(|tick| 0.25 * f64::from(*tick) <= time).count());
        assert_eq!(run(vec![index, (index + count(index)) % 30])?.get(index), whole.get(index));
    }
    Ok(())
}

/// Those that start at rest where they stay take one step, beside others that take many.
#[test]
fn a_member_in_equilibrium_takes_one_step() -> Result<(), Error> {
    let spring = |index: usize| {
        (
            PushedSpring { m: 1.0, k: 1.0, ..PushedSpring::default() },
            State::at_rest([if index == 2 { 0.0 } else { 1.0 }]),
        )
    };
    let outcome = Ensemble::from_fn(6, spring).integrate_on_lanes(50.0, Taylor::default())?;
    assert_eq!((steps(arrival(&outcome, 2))[0], arrival(&outcome, 2).state.q[0]), (1, 0.0));
    assert!((arrival(&outcome, 5).state.q[0] - 50.0_f64.cos()).abs() < 1e-14);
    Ok(())
}

/// m v̇ = −m g − c v √v² upwards and down: v = w tan(φ₀ − g t/w) to the top, then −w tanh(g t/w), with w = √(g/c).
/// The root comes down to zero at the top, which the series does not know.
#[test]
fn drag_by_the_root_of_a_square_turns_with_the_velocity() -> Result<(), Error> {
    let drag = |index: usize| 0.2 + noise(index, 0);
    let thrown = |index: usize| (Thrown { g: 9.81, c: drag(index) }, State::new([0.0], [1.0 + index as f64]));
    let outcome = Ensemble::from_fn(10, thrown).integrate_on_lanes(2.0, Taylor::default())?;
    for (index, state) in outcome.completed() {
        let w = (9.81 / drag(index)).sqrt();
        let top = w / 9.81 * ((1.0 + index as f64) / w).atan();
        let expected = -w * (9.81 * (2.0 - top) / w).tanh();
        assert!((state.v[0] / expected - 1.0).abs() < 1e-12, "member {index}: {} {expected}", state.v[0]);
        let alone =
            Ensemble::from_fn(10, thrown).members([index]).integrate_on_lanes(2.0, Taylor::default())?;
        assert_eq!(alone.members(), &outcome.members()[index..=index]);
    }
    assert_eq!(outcome.completed().count(), 10);
    Ok(())
}

/// Constraints that depend on one another, and angles that lanes have no sines of: such steps are taken alone.
#[test]
fn what_the_lanes_cannot_do_is_done_alone() -> Result<(), Error> {
    let outcome = Ensemble::from_fn(9, constraints::twice).integrate_on_lanes(3.0, Taylor::default())?;
    for (index, state) in outcome.completed() {
        let (system, start) = constraints::twice(index);
        assert_eq!(state, system.integrate(start, 3.0, Taylor::default())?.end().state(), "member {index}");
    }
    assert_eq!(outcome.completed().count(), 9);
    let times = [0.01, 0.05, 0.1];
    let near = Ensemble::from_fn(4, member).samples_at(times).integrate_on_lanes(0.1, Taylor::default())?;
    let turned = Ensemble::from_fn(4, far).samples_at(times).integrate_on_lanes(0.1, Taylor::default())?;
    for index in [0, 1, 3] {
        assert_eq!(near.get(index), turned.get(index));
    }
    let (system, start) = far(2);
    let path = system.integrate(start, 0.1, Taylor::default())?;
    assert_eq!(&arrival(&turned, 2).state, path.end().state());
    for (state, t) in arrival(&turned, 2).samples.iter().zip(times) {
        assert_eq!(state, path.at(t)?.state());
    }
    Ok(())
}

/// A function that the user supplies, of each member its own.
#[test]
fn functions_are_expanded_on_lanes() -> Result<(), Error> {
    let trapped = || Ensemble::from_fn(20, fields::trapped);
    let outcome = trapped().integrate_on_lanes(3.0, Taylor::default())?;
    assert_eq!(outcome.completed().count(), 20);
    for (index, state) in outcome.completed() {
        let (system, start) = fields::trapped(index);
        let path = system.integrate(start, 3.0, Dop853::with_tolerance(1e-14))?;
        let off = (state.q[0] - path.end().state().q[0]).abs();
        assert!(off < 1e-12, "member {index} is off by {off:e}");
        let alone = trapped().members([index]).integrate_on_lanes(3.0, Taylor::default())?;
        assert_eq!(alone.members(), &outcome.members()[index..=index]);
    }
    Ok(())
}

/// ẍ = |(t − s)² − d²|, which is negative without the bars between s − d and s + d only, well within a step.
#[test]
fn a_root_that_comes_down_to_zero_twice_in_a_step_is_seen() -> Result<(), Error> {
    #[derive(Lagrangian, Clone, Copy)]
    #[coordinates(x)]
    #[lagrangian(x_dot^2/2 + x * sqrt(((t - s)^2 - d^2)^2))]
    struct Touching<T> {
        s: T,
        d: T,
    }
    let width = |index: usize| [0.3, 1e-2, 1e-3][index % 3];
    let driven = |index: usize| (Touching { s: 1.0, d: width(index) }, State::at_rest([0.0]));
    let outcome = Ensemble::from_fn(9, driven).integrate_on_lanes(3.0, Taylor::default())?;
    assert_eq!(outcome.completed().count(), 9);
    for (index, state) in outcome.completed() {
        let d = width(index);
        // ∫|s² − d²| from −1 to 2 is that without bars and twice the part that is negative.
        let expected = (8.0 + 1.0) / 3.0 - 3.0 * d * d + 2.0 * (4.0 / 3.0) * d.powi(3);
        let off = (state.v[0] - expected).abs();
        assert!(off < 4e-14, "member {index} is off by {off:e}");
    }
    Ok(())
}

/// The first four have no series on lanes, as their sines are no numbers there, and leave soon. Nothing of that is left.
#[test]
fn a_lane_forgets_who_was_in_it() -> Result<(), Error> {
    let members = |index: usize| {
        let (system, start) = member(index);
        match index < 4 {
            true => (system, State::at_rest(start.q.add_scalar(2e9 * PI)).at_time(0.9 - 0.2 * index as f64)),
            false => (system, start),
        }
    };
    let ensemble = || Ensemble::from_fn(12, members);
    let whole = on_threads(1, || ensemble().integrate_on_lanes(END, Taylor::default()))?;
    assert_eq!(whole.completed().count(), 12);
    for index in 0..12 {
        let alone = ensemble().members([index]).integrate_on_lanes(END, Taylor::default())?;
        assert_eq!(alone.members(), &whole.members()[index..=index]);
    }
    Ok(())
}

/// ẍ = u, set anew every tenth of a second: parabolas, put together.
#[test]
fn controllers_steer_members() -> Result<(), Error> {
    let input = |index: usize, t: f64| (3.0 * t + index as f64).sin();
    let carts = |indices: &[usize]| {
        Ensemble::from_fn(11, |index| {
            (PushedSpring { m: 1.0, ..PushedSpring::default() }, State::at_rest([index as f64]))
        })
        .members(indices.iter().copied())
        .controlled(0.1, move |index, cart, state| {
            cart.u = input(index, state.t);
            if state.t < 0.1 * index as f64 + 0.45 { Ok(()) } else { Err("enough") }
        })
        .integrate_on_lanes(1.0, Taylor::default())
    };
    let outcome = carts(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10])?;
    for index in 0..11 {
        let found = arrival(&outcome, index);
        let calls = ((found.state.t / 0.1).round() as usize).min(10);
        let (mut x, mut v) = (index as f64, 0.0);
        for call in 0..calls {
            let u = input(index, 0.1 * call as f64);
            (x, v) = (x + 0.1 * v + 0.005 * u, v + 0.1 * u);
        }
        let off = (found.state.q[0] - x).abs().max((found.state.v[0] - v).abs());
        assert!(off < 4e-15 * (1.0 + x.abs()), "member {index} is off by {off:e}");
        let fails = matches!(&found.ending, Ending::ControllerFailed { said, .. } if said == "enough");
        assert_eq!((fails, calls), (index < 5, (index + 5).min(10)), "{:?}", found.ending);
        assert_eq!(carts(&[index])?.get(index), outcome.get(index));
    }
    Ok(())
}

#[test]
fn a_limit_on_steps_ends_the_member_that_meets_it() -> Result<(), Error> {
    let free = ensemble().integrate_on_lanes(END, Taylor::default())?;
    let mut needed: Vec<usize> = (0..COUNT).map(|index| steps(arrival(&free, index))[0]).collect();
    needed.sort_unstable();
    let limit = needed[COUNT / 2];
    let outcome = ensemble().integrate_on_lanes(END, Taylor::default().max_steps(limit))?;
    for index in 0..COUNT {
        let (found, free) = (arrival(&outcome, index), arrival(&free, index));
        match &found.ending {
            Ending::StepLimit { steps, time, .. } => assert_eq!((*steps, *time), (limit, found.state.t)),
            _ => assert_eq!(found, free),
        }
        assert_eq!(found.ending.is_complete(), steps(free)[0] <= limit);
    }
    assert!(matches!(
        ensemble().integrate_on_lanes(END, Taylor::with_tolerance(0.0)),
        Err(Error::Setting { name: "relative tolerance", .. })
    ));
    Ok(())
}
