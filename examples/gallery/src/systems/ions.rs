//! Ions in a trap that is stirred, Milton (8.52), (8.53).

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob};

/// In the frame of the trap, which turns; k is the repulsion.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [5, 3])]
#[define(W = [0, 0, omega])]
#[define(U(s) = (s[0]^2 + stiffness*s[1]^2 + 3*s[2]^2)/2)]
#[define(interaction = sum(a in 0..4, sum(b in a+1..5, k/norm(r[a] - r[b]))))]
#[define(v_0[a in 0..5] = r_dot[a] + cross(W, r[a]))]
#[lagrangian(sum(a in 0..5, m/2*dot(v_0[a], v_0[a]) - U(r[a])) - interaction)]
pub(super) struct StirredIons {
    m: f64,
    omega: f64,
    stiffness: f64,
    k: f64,
}

/// Where they start, in x, y, z one ion after the other.
const PLACES: [f64; 15] = [1.4, 0.1, 0.0, -0.2, 0.7, 0.1, -1.5, -0.1, 0.0, 0.1, -0.8, -0.1, 0.1, 0.1, 0.6];

impl Exhibit<4> for StirredIons {
    const TITLE: &'static str = "Ions in a stirred trap";
    const ABOUT: &'static str = "Five ions repel each other in a trap that is longer in one direction and \
        turns. Seen from the trap nothing depends on the time, and E = E₀ − Σ L·Ω is conserved; neither \
        term is by itself. Milton (8.52), (8.53).";
    const KNOBS: &'static [Knob; 4] = &[
        knob("omega", "rate of the trap", "rad/s", [0.0, 0.9], 0.3),
        knob("k", "repulsion", "J m", [0.1, 3.0], 1.0),
        knob("stiffness", "across the trap, along it 1", "N/m", [1.0, 4.0], 1.6),
        knob("m", "mass", "kg", [0.2, 3.0], 1.0),
    ];
    const UNITS: Option<Units> = Some(&[]);
    const PACE: f64 = 2.0;

    fn set([rate, k, stiffness, m]: [f64; 4]) -> (Self, State<f64, 15>) {
        let kicks = std::array::from_fn(|i| 0.2 * (7.0 * i as f64).sin());
        (Self { m, omega: rate, stiffness, k }, State::new(PLACES, kicks))
    }

    fn view(&self, state: &State<f64, 15>) -> View {
        View { from: Some([-0.9, 0.6]), ..View::space(Point::zeros(), 2.4_f64.max(state.q.amax()), 5.0) }
    }

    fn trails(&self, state: &State<f64, 15>) -> Vec<Point> {
        (0..5).map(|a| state.q.fixed_rows::<3>(3 * a).into()).collect()
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        // Where the trap holds by as much.
        let ellipse: Vec<Point> = (0..=60)
            .map(|k| (std::f64::consts::TAU * f64::from(k) / 60.0).sin_cos())
            .map(|(sine, cosine)| Point::new(2.0 * cosine, 2.0 / self.stiffness.sqrt() * sine, 0.0))
            .collect();
        scene.face(Paint::Guide, &ellipse);
        scene.line(Paint::Fixed, 1.5, &ellipse);
        for a in 0..5 {
            let at = now.place(3 * a);
            scene.ball(if a % 2 == 0 { Paint::Body } else { Paint::Other }, 0.1 * self.m.cbrt(), at);
            scene.force(at, self.pushed(now, a));
        }
    }
}

impl StirredIons {
    /// What the others push an ion by.
    fn pushed(&self, now: &Moment<Self>, a: usize) -> Point {
        let from = |b: usize| now.place(3 * a) - now.place(3 * b);
        (0..5).filter(|b| *b != a).map(|b| from(b) * (self.k / from(b).norm().powi(3))).sum()
    }
}
