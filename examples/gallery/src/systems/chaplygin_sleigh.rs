//! Chaplygin's sleigh.

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

/// A sleigh on a blade at (x, y), with the centre of mass ahead of it.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(centre = [x + d*cos(theta), y + d*sin(theta)])]
#[lagrangian(m/2*dot(der(centre), der(centre)) + inertia/2*theta_dot^2)]
#[constraint(blade: x_dot*sin(theta) - y_dot*cos(theta) = 0)]
pub(super) struct ChaplyginSleigh {
    m: f64,
    d: f64,
    inertia: f64,
}

impl Exhibit<4> for ChaplyginSleigh {
    const TITLE: &'static str = "Chaplygin’s sleigh";
    const ABOUT: &'static str = "It glides along its blade and cannot slip sideways. The energy is \
        conserved, and yet all motions end alike: straight ahead with the centre of mass in front, as if \
        there were friction. Let it start backwards: it turns around. The constraint is nonholonomic.";
    const KNOBS: &'static [Knob; 4] = &[
        knob("v_0", "speed along the blade", "m/s", [-2.0, 2.0], -1.0),
        knob("w_0", "rate of turning", "rad/s", [-3.0, 3.0], 0.15),
        knob("d", "how far ahead the centre of mass is", "m", [0.05, 1.0], 0.35),
        knob("m", "mass", "kg", [0.2, 5.0], 1.0),
    ];
    const UNITS: Option<Units> = Some(&[("blade", "N")]);

    fn set([speed, rate, d, m]: [f64; 4]) -> (Self, State<f64, 3>) {
        (Self { m, d, inertia: 0.2 * m }, State::new([0.0; 3], [speed, 0.0, rate]))
    }

    fn view(&self, state: &State<f64, 3>) -> View {
        View::plane(xy(state.q[0], state.q[1]), 2.2, 4.0 * self.m)
    }

    fn trails(&self, state: &State<f64, 3>) -> Vec<Point> {
        vec![xy(state.q[0], state.q[1])]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let (blade, (sine, cosine)) = (xy(now.state.q[0], now.state.q[1]), now.state.q[2].sin_cos());
        let (along, across) = (xy(cosine, sine), xy(-sine, cosine));
        let hull = [[-0.25, -0.3], [0.65, -0.3], [1.0, 0.0], [0.65, 0.3], [-0.25, 0.3]];
        let corners = hull.map(|[a, b]| blade + along * a + across * b);
        scene.face(Paint::Body, &corners);
        scene.line(Paint::Fixed, 5.0, &[blade - along * 0.2, blade + along * 0.2]);
        scene.dot(Paint::Other, 12.0, blade + along * self.d);
        scene.constraint_force(blade, xy(now.force[0], now.force[1]));
    }
}
