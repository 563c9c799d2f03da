//! Zeros on the series.

use std::f64::consts::PI;

use lagrange_core::nalgebra::{Const, Vector2};
use lagrange_core::{Crossing, prelude::*};
use lagrange_random::cases;
use lagrange_systems::{HenonHeiles, Spring};

use super::{SPRING, spherical};

type Result<T> = std::result::Result<T, Error>;

/// On x = 0, with the energy 1/12, where motions are regular.
const START: State<f64, 2> =
    State { t: 0.0, q: Vector2::new(0.0, 0.1), v: Vector2::new(0.383_840_244_546_260_8, 0.1) };

/// When this crossing of x = 0, counted from 1 in both directions, is, by heyoka 7.13.2 with 64 bits of mantissa. None are
/// closer than 2.45 or further apart than 4.
const KNOWN: [(usize, f64); 5] = [
    (1, 2.954_232_171_146_524_3),
    (2, 6.441_787_100_765_046),
    (500, 1_593.719_820_214_897),
    (1000, 3_187.493_274_586_113_3),
    (10_000, 31_872.833_486_038_795),
];

/// The crossings of x = 0 in the order of the motion.
fn section(
    motion: &mut Motion<HenonHeiles, Taylor>,
    end: f64,
    count: usize,
) -> Result<Vec<Crossing<f64, Const<2>>>> {
    let mut section = HenonHeiles.event("section", |sample| sample.state().q[0]);
    let found: std::result::Result<Vec<_>, _> =
        motion.crossings(end, &mut [&mut section]).take(count).collect();
    Ok(found?)
}

#[test]
fn every_crossing_is_found() -> Result<()> {
    let count = cases([200, 500, 10_000]);
    let mut motion = Motion::new(HenonHeiles, START, Taylor::default())?;
    let found = section(&mut motion, 1e6, count)?;
    for (k, time) in KNOWN.into_iter().filter(|&(k, _)| k <= count) {
        let off = found[k - 1].state.t - time;
        assert!(off.abs() < 1e-14 * time, "{k}: {off:e}");
    }
    for (pair, k) in found.windows(2).zip(0..) {
        let apart = pair[1].state.t - pair[0].state.t;
        assert!(2.45 < apart && apart < 4.0 && pair[0].rising == (k % 2 == 1), "{k}: {apart}");
    }
    let most = found.iter().map(|crossing| crossing.state.q[0].abs()).fold(0.0, f64::max);
    assert!(found.len() == count && most <= 1e-14, "{most:e}");
    Ok(())
}

#[test]
fn backwards_they_are_the_same() -> Result<()> {
    let mut motion = Motion::new(HenonHeiles, START, Taylor::default())?;
    let there = section(&mut motion, 100.0, 1000)?;
    assert_eq!(motion.advance_to(100.0), Ok(()));
    let back = section(&mut motion, 1.0, 1000)?;
    assert_eq!((there.len(), back.len()), (31, 31));
    for (one, other) in there.iter().zip(back.iter().rev()) {
        let off = (one.state.t - other.state.t).abs();
        assert!(off < 2e-13 && one.rising != other.rising && other.state.q[0].abs() < 1e-15, "{off:e}");
    }
    Ok(())
}

/// −cos t is at a level near 1 twice about each odd multiple of π, within one of the steps, which are about 2.5 long.
/// They are two without being asked for, and in pieces that are shorter than what is between them.
#[test]
fn two_zeros_within_a_step_are_two() -> Result<()> {
    for (apart, pieces) in [(0.5, None), (0.13, None), (0.02, None), (0.02, Some(128))] {
        let level = (apart / 2.0_f64).cos();
        let event = SPRING.event("level", move |sample| sample.state().q[0] - level);
        let mut event = if let Some(pieces) = pieces { event.subdivide(pieces) } else { event };
        let method = Taylor::default();
        let path = SPRING.motion(State::at_rest([-1.0])).by(method).event(&mut event).towards(60.0)?;
        assert!(path.statistics().accepted < 70 && path.crossings().len() == 20, "{apart}");
        for (crossing, k) in path.crossings().iter().zip(0..) {
            let turn = PI * f64::from(k / 2 * 2 + 1);
            let expected = if k % 2 == 0 { turn - apart / 2.0 } else { turn + apart / 2.0 };
            let off = crossing.state.t - expected;
            // The slope there is sin(apart/2). The terms of a step add up to e^2.5 = 12, of which 24 steps round each.
            assert!(off.abs() * apart < 2e-14 && crossing.rising == (k % 2 == 0), "{apart}, {k}: {off:e}");
        }
    }
    Ok(())
}

/// A free body: its series is itself, so that steps may end where they like.
#[test]
fn a_zero_at_the_end_of_a_step_is_one() -> Result<()> {
    let free = Spring { m: 1.0, k: 0.0 };
    let times = |start: f64, end: f64, at: f64| -> Result<Vec<f64>> {
        let mut event = free.event("there", move |sample| sample.state().q[0] - at);
        let start = State { t: start, ..State::new([start], [1.0]) };
        let path = free.motion(start).by(Taylor::default().max_step(0.25)).event(&mut event).towards(end)?;
        assert_eq!(path.statistics().accepted, ((end - start.t).abs() * 4.0) as usize);
        Ok(path.crossings().iter().map(|crossing| crossing.state.t).collect())
    };
    for at in [0.25, 0.5, 1.0, 1.75] {
        assert_eq!(times(0.0, 2.0, at)?, [at]);
        assert_eq!(times(2.0, 0.0, at)?, [at], "backwards");
    }
    // At the end of the motion it is reported, at its start it is not.
    assert_eq!((times(0.0, 2.0, 2.0)?, times(0.0, 2.0, 0.0)?), (vec![2.0], vec![]));
    assert_eq!((times(2.0, 0.0, 0.0)?, times(2.0, 0.0, 2.0)?), (vec![0.0], vec![]));
    Ok(())
}

/// Around a great circle, z = 0.8 sin t.
#[test]
fn zeros_lie_on_the_constraint() -> Result<()> {
    let sphere = spherical(0.0);
    let mut event = sphere.event("equator", |sample| sample.state().q[2]);
    let start = State::new([1.0, 0.0, 0.0], [0.0, 0.6, 0.8]);
    let path = sphere.motion(start).by(Taylor::default()).event(&mut event).towards(200.0)?;
    assert_eq!(path.crossings().len(), 63);
    for (crossing, k) in path.crossings().iter().zip(1..) {
        let State { t, q, .. } = crossing.state;
        let off = [t - PI * f64::from(k), q[2], q.norm_squared() - 1.0, q[0].abs() - 1.0].map(f64::abs);
        // Within a step the state is the sum of a series whose terms add up to e^2.5 = 12, and a speed that is off by a
        // round-off of as much for each of 80 steps is off by 10⁻¹³ at the end: it makes 2·10⁻¹¹ of 200.
        // What is left of the rod's equation by four units of round-off or less, twice that of the square, stays.
        assert!(off[0] < 5e-12 && off[1..].iter().all(|off| *off <= 8.0 * f64::EPSILON), "{off:?}");
    }
    Ok(())
}
