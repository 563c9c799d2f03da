//! A block on a table that shakes, whose velocity is a part of that of friction, against its closed pieces.

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
