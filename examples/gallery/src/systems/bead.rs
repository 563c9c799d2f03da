//! A bead on a wire.

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(wire: y - b*x^2/2 = 0)]
pub(super) struct Bead {
    m: f64,
    g: f64,
    b: f64,
}

impl Exhibit<3> for Bead {
    const TITLE: &'static str = "Bead on a wire";
    const ABOUT: &'static str = "The wire is a constraint, and pushes across itself, by what the multiplier \
        says: more than the weight where it is curved and the bead is fast.";
    const KNOBS: &'static [Knob; 3] = &[
        knob("x_0", "where it is let go", "m", [-1.2, 1.2], 1.0),
        knob("b", "curvature of the wire", "1/m", [0.2, 3.0], 1.5),
        knob("m", "mass", "kg", [0.1, 3.0], 1.0),
    ];
    const UNITS: Option<Units> = Some(&[("wire", "N")]);

    fn set([x, b, m]: [f64; 3]) -> (Self, State<f64, 2>) {
        (Self { m, g: 9.81, b }, State::at_rest([x, b * x * x / 2.0]))
    }

    fn view(&self, _: &State<f64, 2>) -> View {
        View::plane(xy(0.0, 0.7), 1.3, 4.0 * self.m * self.g)
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let wire = (-60..=60).map(|k| f64::from(k) / 40.0).map(|x| xy(x, self.b * x * x / 2.0));
        scene.line(Paint::Fixed, 2.5, &wire.collect::<Vec<Point>>());
        let bead = xy(now.state.q[0], now.state.q[1]);
        scene.ball(Paint::Body, 0.06, bead);
        scene.constraint_force(bead, xy(now.force[0], now.force[1]));
    }
}
