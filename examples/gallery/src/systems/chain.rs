//! Fifty rods.

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

const RODS: usize = 50;

#[derive(Clone, Lagrangian)]
#[coordinates(x: [50], y: [50])]
#[lagrangian(sum(i in 0..50, m/2*(x_dot[i]^2 + y_dot[i]^2) - m*g*y[i]))]
#[constraint(first: (x[0]^2 + y[0]^2 - l^2)/2 = 0)]
#[constraint(rod[i in 1..50]: ((x[i] - x[i-1])^2 + (y[i] - y[i-1])^2 - l^2)/2 = 0)]
pub(super) struct Chain {
    m: f64,
    l: f64,
    g: f64,
}

impl Exhibit<4> for Chain {
    const TITLE: &'static str = "Chain of 50 rods";
    const ABOUT: &'static str = "A hundred coordinates and fifty constraints. The derive solves for \
        accelerations and multipliers while it compiles, from one end of the chain to the other, so that a \
        step costs as much as the chain is long. The arrows are what the rods push each joint with, \
        together.";
    const KNOBS: &'static [Knob; 4] = &[
        knob("theta", "angle from hanging", "rad", [0.0, 3.0], 1.5),
        knob("beta", "how far it is bent", "rad", [-3.0, 3.0], 0.8),
        knob("m", "mass of all", "kg", [0.1, 5.0], 1.0),
        knob("g", "gravity", "m/s²", [0.0, 20.0], 9.81),
    ];
    const UNITS: Option<Units> = Some(&[("first", "N/m"), ("rod", "N/m")]);

    fn set([theta, bend, m, g]: [f64; 4]) -> (Self, State<f64, 100>) {
        let l = 1.0 / RODS as f64;
        let (mut start, mut at) = (State::at_rest([0.0; 100]), Point::zeros());
        for i in 0..RODS {
            let (sine, cosine) = (theta + bend * (i as f64 * l - 0.5)).sin_cos();
            at += l * xy(sine, -cosine);
            (start.q[i], start.q[RODS + i]) = (at.x, at.y);
        }
        (Self { m: m / RODS as f64, l, g }, start)
    }

    fn view(&self, _: &State<f64, 100>) -> View {
        View::plane(xy(0.0, -0.1), 1.1, 2.0 * RODS as f64 * self.m * 9.81)
    }

    fn trails(&self, state: &State<f64, 100>) -> Vec<Point> {
        vec![xy(state.q[RODS - 1], state.q[2 * RODS - 1])]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let joint = |i: usize| xy(now.state.q[i], now.state.q[RODS + i]);
        let joints: Vec<Point> = std::iter::once(Point::zeros()).chain((0..RODS).map(joint)).collect();
        scene.line(Paint::Fixed, 2.0, &joints);
        for (i, joint) in joints.iter().enumerate() {
            scene.dot(Paint::Body, 5.0, *joint);
            if i > 0 {
                scene.constraint_force(*joint, xy(now.force[i - 1], now.force[RODS + i - 1]));
            }
        }
        scene.dot(Paint::Fixed, 9.0, Point::zeros());
    }
}
