//! Three bodies that follow each other on an eight.

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

#[derive(Clone, Lagrangian)]
#[coordinates(x: [3], y: [3])]
#[define(apart(i, j) = sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2))]
#[lagrangian(sum(i in 0..3, m[i]/2*(x_dot[i]^2 + y_dot[i]^2))
    + m[0]*m[1]/apart(0, 1) + m[1]*m[2]/apart(1, 2) + m[2]*m[0]/apart(2, 0))]
#[conserved(P_x = sum(i in 0..3, m[i]*x_dot[i]))]
#[conserved(P_y = sum(i in 0..3, m[i]*y_dot[i]))]
#[conserved(L_z = sum(i in 0..3, m[i]*(x[i]*y_dot[i] - y[i]*x_dot[i])))]
pub(super) struct ThreeBodies {
    m: [f64; 3],
}

/// A body at one end of the eight, and the velocity of the one in its middle (A. Chenciner and R. Montgomery, *Annals of
/// Mathematics* 152, 2000; the numbers are by C. Simó).
const END: [f64; 2] = [0.97000436, -0.24308753];
const MIDDLE: [f64; 2] = [-0.93240737, -0.86473146];

impl Exhibit<3> for ThreeBodies {
    const TITLE: &'static str = "Three bodies on an eight";
    const ABOUT: &'static str = "Three equal masses chase each other along one curve, by gravity alone. The \
        motion is stable: a little push makes the eight drift and turn. With masses too different it falls \
        apart.";
    const KNOBS: &'static [Knob; 3] = &[
        knob("m_1", "mass of the first, to the others’", "", [0.9, 1.1], 1.0),
        knob("u", "push of the first along x", "", [-0.1, 0.1], 0.0),
        knob("v", "push of the first along y", "", [-0.1, 0.1], 0.0),
    ];
    const UNITS: Option<Units> = None;

    fn set([m, u, v]: [f64; 3]) -> (Self, State<f64, 6>) {
        let [vx, vy] = MIDDLE.map(|v| -v / 2.0);
        let start = State::new(
            [END[0], -END[0], 0.0, END[1], -END[1], 0.0],
            [vx + u, vx, MIDDLE[0], vy + v, vy, MIDDLE[1]],
        );
        (Self { m: [m, 1.0, 1.0] }, start)
    }

    fn view(&self, state: &State<f64, 6>) -> View {
        let middle = xy(state.q.fixed_rows::<3>(0).mean(), state.q.fixed_rows::<3>(3).mean());
        View::plane(middle, 1.2, 4.0)
    }

    fn trails(&self, state: &State<f64, 6>) -> Vec<Point> {
        (0..3).map(|i| xy(state.q[i], state.q[3 + i])).collect()
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let pulls = self.momentum_rate(&now.state);
        for (i, paint) in [Paint::Body, Paint::Other, Paint::Momentum].into_iter().enumerate() {
            let at = xy(now.state.q[i], now.state.q[3 + i]);
            scene.ball(paint, 0.06 * self.m[i].cbrt(), at);
            scene.force(at, xy(pulls[i], pulls[3 + i]));
        }
    }
}
