//! Two bobs on two rods.

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

#[derive(Clone, Lagrangian)]
#[coordinates(x: [2], y: [2])]
#[lagrangian(sum(i in 0..2, m[i]/2*(x_dot[i]^2 + y_dot[i]^2) - m[i]*g*y[i]))]
#[constraint(upper: (x[0]^2 + y[0]^2 - l[0]^2)/2 = 0)]
#[constraint(lower: ((x[1] - x[0])^2 + (y[1] - y[0])^2 - l[1]^2)/2 = 0)]
pub(super) struct DoublePendulum {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
}

impl Exhibit<7> for DoublePendulum {
    const TITLE: &'static str = "Double pendulum";
    const ABOUT: &'static str = "Two bobs on rigid rods, in Cartesian coordinates: each rod is a \
        constraint, and its multiplier is what the rod pulls with. Let go from high up it is chaos, yet the \
        energy stays.";
    const KNOBS: &'static [Knob; 7] = &[
        knob("theta_1", "first angle from hanging", "rad", [-3.1, 3.1], 2.0),
        knob("theta_2", "second angle from hanging", "rad", [-3.1, 3.1], 2.6),
        knob("m_1", "mass of the upper bob", "kg", [0.1, 3.0], 1.0),
        knob("m_2", "mass of the lower bob", "kg", [0.1, 3.0], 1.0),
        knob("l_1", "length of the upper rod", "m", [0.2, 1.5], 1.0),
        knob("l_2", "length of the lower rod", "m", [0.2, 1.5], 1.0),
        knob("g", "gravity", "m/s²", [0.0, 20.0], 9.81),
    ];
    const UNITS: Option<Units> = Some(&[("upper", "N/m"), ("lower", "N/m")]);

    fn set([first, second, m_1, m_2, l_1, l_2, g]: [f64; 7]) -> (Self, State<f64, 4>) {
        let joint = [l_1 * first.sin(), -l_1 * first.cos()];
        let tip = [joint[0] + l_2 * second.sin(), joint[1] - l_2 * second.cos()];
        let start = State::at_rest([joint[0], tip[0], joint[1], tip[1]]);
        (Self { m: [m_1, m_2], l: [l_1, l_2], g }, start)
    }

    fn view(&self, _: &State<f64, 4>) -> View {
        let weight = (self.m[0] + self.m[1]) * 9.81;
        View::plane(Point::zeros(), 1.15 * (self.l[0] + self.l[1]), 10.0 * weight)
    }

    fn trails(&self, state: &State<f64, 4>) -> Vec<Point> {
        vec![xy(state.q[1], state.q[3])]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let bobs = [0, 1].map(|i| xy(now.state.q[i], now.state.q[2 + i]));
        scene.line(Paint::Fixed, 4.0, &[Point::zeros(), bobs[0], bobs[1]]);
        scene.dot(Paint::Fixed, 8.0, Point::zeros());
        let reach = self.l[0] + self.l[1];
        for (bob, m) in bobs.into_iter().zip(self.m) {
            scene.ball(Paint::Body, 0.06 * reach * m.cbrt(), bob);
        }
        // Φ = (r² − l²)/2: a rod acts along itself, by λ times its vector.
        let pulls = [bobs[0] * now.multipliers[0], (bobs[1] - bobs[0]) * now.multipliers[1]];
        scene.constraint_force(bobs[0], pulls[0]);
        scene.constraint_force(bobs[0], -pulls[1]);
        scene.constraint_force(bobs[1], pulls[1]);
    }
}
