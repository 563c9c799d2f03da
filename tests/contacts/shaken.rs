//! A block on a table that shakes, whose velocity is a part of that of friction: along a line against its closed pieces, in the plane against
//! small implicit steps.

use core::f64::consts::PI;

use lagrange_core::Method;
use lagrange_core::contact::{Friction, Transition};
use lagrange_core::prelude::*;
use lagrange_random::{Random, cases};

/// The table moves with a sin ωt, and friction holds up to `hold`.
#[derive(Clone, Debug, Lagrangian)]
#[coordinates(x)]
#[lagrangian(m/2 * x_dot^2)]
#[friction(table: x_dot - a*sin(w*t), sliding: hold)]
struct ShakenBlock {
    m: f64,
    a: f64,
    w: f64,
    hold: f64,
    table: Friction,
}

impl ShakenBlock {
    /// Times at which the block sticks, slips or slides back: between them it moves with the table or with the acceleration ±hold/m.
    fn changes(&self, end: f64) -> Vec<f64> {
        let (limit, mut t, mut v, mut changes) = (self.hold / self.m, 0.0, 0.0, vec![]);
        let table = |t: f64| [self.a * (self.w * t).sin(), self.a * self.w * (self.w * t).cos()];
        let part = (limit / (self.a * self.w)).acos();
        // It begins at rest on a table that accelerates most.
        let mut along = Some(-1.0);
        while t < end {
            (t, along) = if let Some(side) = along {
                let apart = |at: f64| v - side * limit * (at - t) - table(at)[0];
                let step = 1e-3 / self.w;
                let high =
                    (1..).map(|k| t + step * f64::from(k)).find(|&at| side * apart(at) <= 0.0).unwrap();
                let meets = bisect(|at| side * apart(at), high - step, high);
                v = table(meets)[0];
                let pull = table(meets)[1];
                (meets, (pull.abs() > limit).then_some(-pull.signum()))
            } else {
                let turn = ((self.w * t + part) / PI).floor() + 1.0;
                let slips = (turn * PI - part) / self.w;
                v = table(slips)[0];
                (slips, Some(-(turn * PI).cos()))
            };
            changes.push(t);
        }
        changes.retain(|change| *change < end);
        changes
    }

    fn check(&self, method: impl Method<Self>) {
        let end = 50.0 * 2.0 * PI / self.w;
        let path = self.motion(State::at_rest([0.0])).by(method).with_contacts().to(end).unwrap();
        let (times, expected) = (path.transitions().iter().map(Transition::time), self.changes(end));
        assert_eq!(path.transitions().len(), expected.len(), "{self:?}");
        for (time, expected) in times.zip(expected) {
            assert!((time - expected).abs() < 1e-9, "{self:?}: {time} for {expected}");
        }
    }
}

/// The zero of a function that falls through it.
fn bisect(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        *if of(middle) > 0.0 { &mut low } else { &mut high } = middle;
    }
    (low + high) / 2.0
}

#[test]
fn a_block_sticks_and_slips_where_its_pieces_meet() {
    for seed in 0..cases([2, 10, 500]) as u64 {
        let mut random = Random(seed);
        let [m, a, w] = [(); 3].map(|()| random.between(0.5, 3.0));
        let hold = m * a * w * random.between(0.3, 0.95);
        let block = ShakenBlock { m, a, w, hold, table: Friction::Sticks };
        block.check(Dop853::with_tolerance(1e-11));
        block.check(Radau::with_tolerance(1e-11));
    }
}

/// The table moves in two directions, with a sin ωt and b cos νt.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2))]
#[friction(table: [x_dot - a*sin(w*t), y_dot - b*cos(u*t)], sliding: hold)]
struct ShakenPlane {
    m: f64,
    a: f64,
    b: f64,
    w: f64,
    u: f64,
    hold: f64,
    table: Friction,
}

impl ShakenPlane {
    /// Velocity at this time after implicit steps of Euler's method from rest, whose equations have a closed solution: friction moves
    /// the velocity towards that of the table, and no further.
    fn by_small_steps(&self, end: f64, count: usize) -> [f64; 2] {
        let (h, mut v) = (end / count as f64, [0.0; 2]);
        for t in (1..=count).map(|step| step as f64 * h) {
            let table = [self.a * (self.w * t).sin(), self.b * (self.u * t).cos()];
            let apart = [v[0] - table[0], v[1] - table[1]];
            let part = (1.0 - h * self.hold / (self.m * apart[0].hypot(apart[1]))).max(0.0);
            v = [0, 1].map(|i| table[i] + part * apart[i]);
        }
        v
    }
}

/// A force that grows slowly past its limit sets the block in motion with a direction that turns at once: it is stiff.
#[test]
fn a_block_sticks_and_slips_in_a_plane() {
    for seed in 30..30 + cases([20, 40, 400]) as u64 {
        let mut random = Random(seed);
        let [a, b] = [(); 2].map(|()| random.between(0.3, 1.8));
        let [w, u] = [(); 2].map(|()| random.between(1.0, 4.0));
        let plane =
            ShakenPlane { m: 1.0, a, b, w, u, hold: random.between(0.5, 3.0), table: Friction::Sticks };
        let motion = plane.motion(State::at_rest([0.0; 2])).by(Radau::default());
        let path = motion.with_contacts().to(20.0).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let expected = plane.by_small_steps(20.0, 100_000);
        // Euler's method is off by h times the acceleration of the table, at most.
        let error = (0..2).map(|i| (path.end().state().v[i] - expected[i]).abs()).fold(0.0, f64::max);
        assert!(error < 2e-4 * (a * w + b * u), "seed {seed}: {error:e}");
    }
}
