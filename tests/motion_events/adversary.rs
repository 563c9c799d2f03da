//! Random events whose zeros are known: none lost, none invented, none twice.
//! A failure says the number of its case.

use lagrange_core::{Sample, StateOf, prelude::*};

use lagrange_random::{Random, cases};
use lagrange_systems::PushedSpring;

use crate::{FREE, Plane, SPRING};

/// A quarter of `few` cases for `cargo test`, `few` for `.ci/run`, 100,000 for `.ci/full`.
fn count(few: usize) -> u64 {
    cases([few / 4, few, 100_000]) as u64
}

/// From a thousandth of a millionth to one, any decade alike.
fn any_length(random: &mut Random) -> f64 {
    random.size(1e-9, 1.0)
}

/// Times and directions of the crossings from `start` to `end`.
fn found<L>(
    system: L,
    start: StateOf<L>,
    end: f64,
    method: usize,
    g: &dyn Fn(&Sample<&L>) -> f64,
) -> Vec<(f64, bool)>
where
    L: Lagrangian<Scalar = f64> + Copy + lagrange_core::TaylorSeries,
{
    let (mut event, motion) = (system.event("g", g), system.motion(start));
    let path = match method {
        0 => motion.by(Taylor::default()).event(&mut event).towards(end),
        1 => motion.by(Dop853::default()).event(&mut event).towards(end),
        2 => motion.by(Dopri5::default()).event(&mut event).towards(end),
        3 => motion.by(Dop853::with_tolerance(1e-9).max_step(1.5)).event(&mut event).towards(end),
        _ => motion.by(RungeKutta4::with_step(0.05)).event(&mut event).towards(end),
    };
    let path = path.expect("a start");
    assert!(path.ending().is_complete(), "{}", path.ending());
    path.crossings().iter().map(|crossing| (crossing.state.t, crossing.rising)).collect()
}

/// What is wrong with the crossings of a function with these zeros, if anything is.
fn fault(found: &[(f64, bool)], zeros: &[f64], rises_first: bool, tolerance: f64) -> Option<String> {
    let lost = found.len() != zeros.len();
    let off = found.iter().zip(zeros).any(|((t, _), zero)| (t - zero).abs() > tolerance);
    let turned = (0..found.len()).any(|k| found[k].1 != (rises_first == (k % 2 == 0)));
    (lost || off || turned).then(|| format!("{} of {}: {found:?}, not {zeros:?}", found.len(), zeros.len()))
}

/// Counts the cases that fail, and shows the first of them.
fn campaign(name: &str, count: u64, case: impl Fn(&mut Random) -> Option<String>) {
    let mut failed = 0;
    for k in 0..count {
        if let Some(fault) = case(&mut Random(k.wrapping_mul(0x5851_f42d_4c95_7f2d))) {
            failed += 1;
            if failed <= 5 {
                println!("{name} {k}: {fault}");
            }
        }
    }
    println!("{name}: {failed} of {count} cases");
    assert_eq!(failed, 0, "{name}: {failed} of {count} cases");
}

/// Sorted in the order of the motion, none nearer than a thousandth of a millionth of `length` to the next.
fn in_order(mut zeros: Vec<f64>, backwards: bool, length: f64) -> Vec<f64> {
    zeros.sort_by(f64::total_cmp);
    zeros.dedup_by(|a, b| (*a - *b).abs() < 0.9e-9 * length);
    if backwards {
        zeros.reverse();
    }
    zeros
}

/// Up to twelve zeros, alone or in clusters, in `start..end`.
fn clustered(random: &mut Random, [low, high]: [f64; 2], most: usize) -> Vec<f64> {
    let (mut zeros, count, length) = (Vec::new(), 1 + random.below(most), high - low);
    while zeros.len() < count {
        let (zero, apart) =
            (random.between(low + 0.05 * length, high - 0.2 * length), length * any_length(random));
        for k in 0..(1 + random.below(4)).min(count - zeros.len()) {
            zeros.push(zero + 0.045 * apart.max(1e-9 / 0.045 * length) * k as f64);
        }
    }
    zeros
}

/// Products of differences, up to degree 12, of the time and of a coordinate that is the time.
#[test]
fn polynomials() {
    campaign("polynomials", count(150), |random| {
        let length = random.between(1.0, 6.0);
        let [backwards, of_time] = [random.below(2) == 0, random.below(2) == 0];
        let zeros = in_order(clustered(random, [0.0, length], 12), backwards, length);
        let (start, end) = if backwards { (length, 0.0) } else { (0.0, length) };
        let (method, factor) =
            (random.below(5), random.between(0.1, 3.0) * if random.below(2) == 0 { 1.0 } else { -1.0 });
        let g = |sample: &Sample<&PushedSpring<f64>>| {
            let t = if of_time { sample.time() } else { sample.state().q[0] };
            zeros.iter().fold(factor, |product, zero| product * (t - zero))
        };
        let at_start = zeros.iter().fold(factor, |product, zero| product * (start - zero));
        let found = found(FREE, State::new([start], [1.0]).at_time(start), end, method, &g);
        fault(&found, &zeros, at_start < 0.0, 1e-13 * length)
    });
}

/// Products of two sines with up to sixty zeros.
#[test]
fn sines() {
    campaign("sines", count(100), |random| {
        let length = random.between(1.0, 4.0);
        let (backwards, of_time, method) = (random.below(2) == 0, random.below(2) == 0, random.below(5));
        let [one, other] =
            [(); 2].map(|()| (30.0 / length * any_length(random).powf(0.3), random.between(0.0, 3.0)));
        let value = |t: f64| (one.0 * t - one.1).sin() * (other.0 * t - other.1).sin();
        let zeros = [one, other].into_iter().flat_map(|(rate, phase)| {
            (-1..12).map(move |k| (std::f64::consts::PI * f64::from(k) + phase) / rate).filter(|t| *t > 0.0)
        });
        let zeros = zeros.filter(|t| *t < length);
        let mut sorted: Vec<f64> = zeros.collect();
        sorted.sort_by(f64::total_cmp);
        let ends = [0.0, length];
        if sorted.windows(2).any(|pair| pair[1] - pair[0] < 1e-9 * length)
            || sorted.iter().any(|t| ends.iter().any(|end| (t - end).abs() < 1e-6))
        {
            return None;
        }
        if backwards {
            sorted.reverse();
        }
        let (start, end) = if backwards { (length, 0.0) } else { (0.0, length) };
        let g = |sample: &Sample<&PushedSpring<f64>>| {
            value(if of_time { sample.time() } else { sample.state().q[0] })
        };
        let found = found(FREE, State::new([start], [1.0]).at_time(start), end, method, &g);
        fault(&found, &sorted, value(start) < 0.0, 1e-13 * length)
    });
}

/// Two or four levels of x = a cos(t − φ), together in one function.
#[test]
fn levels() {
    campaign("levels", count(100), |random| {
        let (amplitude, phase) = (random.between(0.5, 2.0), random.between(0.0, 6.3));
        let (count, apart) = (2 + 2 * random.below(2), amplitude * any_length(random));
        let first = random.between(-0.95, 0.9) * amplitude;
        let levels: Vec<f64> = (0..count).map(|k| first + apart.max(1e-8) * k as f64 * 0.9).collect();
        let (length, backwards, method) = (random.between(3.0, 20.0), random.below(2) == 0, random.below(5));
        let mut zeros = Vec::new();
        for level in &levels {
            // The motion is known to its tolerance: how close it comes to a level that it all but touches is not.
            if (level.abs() - amplitude).abs() < 1e-4 * amplitude {
                return None;
            }
            if level.abs() < amplitude {
                let angle = (level / amplitude).acos();
                let turns = (-10..10).map(|k| 2.0 * std::f64::consts::PI * f64::from(k) + phase);
                zeros.extend(turns.flat_map(|turn| [turn - angle, turn + angle]));
            }
        }
        let direction = if backwards { -1.0 } else { 1.0 };
        if zeros.iter().any(|t| t.abs() < 1e-4 || (t - direction * length).abs() < 1e-4) {
            return None;
        }
        zeros.retain(|t| (0.0..length).contains(&(t * direction)));
        zeros.sort_by(|a, b| (a * direction).total_cmp(&(b * direction)));
        let start = State::new([amplitude * phase.cos()], [amplitude * phase.sin()]);
        let value = |x: f64| levels.iter().fold(1.0, |product, level| product * (x - level));
        let found = found(SPRING, start, direction * length, method, &|sample| value(sample.state().q[0]));
        fault(&found, &zeros, value(start.q[0]) < 0.0, 1e-4)
    });
}

/// From a zero of the first or of the second order on, at the time 0 and far from it.
#[test]
fn starts_on_a_zero() {
    campaign("starts on a zero", count(150), |random| {
        let (time, length) = ([0.0, 1.0, 1e9][random.below(3)], random.between(1.0, 6.0));
        let (order, method) = (1 + random.below(2) as i32, random.below(5));
        let direction = if random.below(2) == 0 { 1.0 } else { -1.0 };
        let zeros = in_order(clustered(random, [0.0, length], 4), false, length);
        // To the resolution of the time, 1.2e-7 at 1e9.
        let zeros: Vec<f64> = match time {
            1e9 => zeros
                .into_iter()
                .filter(|t| (t * 1e3).fract() < 0.5)
                .map(|t| (t * 1e3).floor() / 1e3)
                .collect(),
            _ => zeros,
        };
        let mut zeros = zeros;
        zeros.dedup();
        zeros.retain(|t| *t > 0.0);
        // A point on a circle of any size, and how it leaves it: along the radius or along the tangent.
        let (sin, cos) = random.between(0.0, 6.3).sin_cos();
        let (radius, kind) = (random.between(0.1, 10.0), random.below(2));
        let origin = [radius * cos, radius * sin];
        let along = if order == 1 { [cos, sin] } else { [-sin, cos] };
        let value = |x: f64, y: f64| {
            let path = (x - origin[0]) * along[0] + (y - origin[1]) * along[1];
            let start = if kind == 0 { x.hypot(y) - radius } else { path.powi(order) };
            zeros.iter().fold(start, |product, zero| product * (path - zero))
        };
        let start = State::new(origin, along.map(|v| direction * v)).at_time(time);
        let of_state = |sample: &Sample<&Plane>| value(sample.state().q[0], sample.state().q[1]);
        let expected: Vec<f64> = zeros.iter().map(|zero| time + direction * zero).collect();
        let end = time + direction * length;
        let found = found(Plane { g: 0.0 }, start, end, method, &of_state);
        fault(&found, &expected, zeros.len() % 2 == 1, 1e-12 * length + 4.0 * f64::EPSILON * time)
    });
}

/// Dips 1 − a exp(−(t/w)²) of a function that is flat elsewhere, two zeros each, from w = 0.15 steps on.
#[test]
fn dips() {
    campaign("dips", count(100), |random| {
        let (step, direction) = (random.between(0.1, 10.0), if random.below(2) == 0 { 1.0 } else { -1.0 });
        let [width, depth] =
            [0.15 * 27_f64.powf(random.between(0.0, 1.0)), 10_f64.powf(random.between(-6.0, 0.5))];
        let (middle, half) = (direction * random.between(15.0, 25.0), width * depth.ln_1p().sqrt());
        let g = |sample: &Sample<&PushedSpring<f64>>| {
            1.0 - (1.0 + depth) * (-((sample.time() / step - middle) / width).powi(2)).exp()
        };
        let mut event = FREE.event("dip", g);
        let (start, method) = (State::new([0.0], [1.0]), RungeKutta4::with_step(step));
        let path = FREE
            .motion(start)
            .by(method)
            .event(&mut event)
            .towards(40.0 * direction * step)
            .expect("a start");
        let found: Vec<_> = path.crossings().iter().map(|at| (at.state.t / step, at.rising)).collect();
        // With the zeros at ±h the slope there is 2h/w², by which the round-off of the function moves them.
        let zeros = [middle - direction * half, middle + direction * half];
        fault(&found, &zeros, false, 1e-14 * (width * width / half + middle.abs()))
    });
}
