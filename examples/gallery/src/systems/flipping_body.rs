//! A free body that turns over, Dzhanibekov's effect.

use lagrange_core::nalgebra::{Matrix3, Quaternion, UnitQuaternion};
use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob};

#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[parameter(inertia: symmetric)]
#[frame(body: translate(r), rotate(q))]
#[lagrangian(kinetic(body, m, [0, 0, 0], inertia))]
#[define(M = express(inertia*angular_velocity(body), fixed))]
#[conserved(M_x = M[0])]
#[conserved(M_y = M[1])]
#[conserved(M_z = M[2])]
#[observable(spin = M)]
pub(super) struct FlippingBody {
    m: f64,
    inertia: Matrix3<f64>,
    edges: [f64; 3],
}

impl Exhibit<5> for FlippingBody {
    const TITLE: &'static str = "Book thrown into the air";
    const ABOUT: &'static str = "A free body spun about its middle axis turns over, again and again, while \
        its angular momentum (the arrow) stands still. The closer the axis was aimed at, the longer it \
        waits. About the other two axes it is steady: make the height the longest edge or the shortest.";
    const KNOBS: &'static [Knob; 5] = &[
        knob("s", "spin, about the height", "rad/s", [0.0, 20.0], 9.0),
        knob("epsilon", "how far off the axis", "rad", [0.0, 0.5], 0.01),
        knob("w", "width", "m", [0.02, 0.4], 0.3),
        knob("h", "height", "m", [0.02, 0.4], 0.2),
        knob("d", "depth", "m", [0.02, 0.4], 0.05),
    ];
    const UNITS: Option<Units> =
        Some(&[("p_r", "N s"), ("M_x", "J s"), ("M_y", "J s"), ("M_z", "J s"), ("q", "J")]);

    fn set([spin, off, w, h, d]: [f64; 5]) -> (Self, State<f64, 7>) {
        let m = 0.6;
        let [x, y, z] = [w, h, d].map(|edge| edge * edge * m / 12.0);
        let inertia = Matrix3::from_diagonal(&Point::new(y + z, x + z, x + y));
        // Its second axis is upright.
        let pose = UnitQuaternion::from_axis_angle(&Point::x_axis(), std::f64::consts::FRAC_PI_2);
        let omega = pose * (spin * Point::new(0.0, off.cos(), off.sin()));
        let rate = (Quaternion::from_imag(omega) * pose.into_inner()) / 2.0;
        let q = [0.0, 0.0, 0.0, pose.w, pose.i, pose.j, pose.k];
        (
            Self { m, inertia, edges: [w, h, d] },
            State::new(q, [0.0, 0.0, 0.0, rate.w, rate.i, rate.j, rate.k]),
        )
    }

    fn view(&self, _: &State<f64, 7>) -> View {
        View::space(Point::zeros(), 0.4, 1.0)
    }

    fn trails(&self, state: &State<f64, 7>) -> Vec<Point> {
        vec![pose(state) * Point::y() * (0.75 * self.edges[1])]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let pose = pose(&now.state);
        scene.solid(Paint::Body, Point::zeros(), pose, self.edges);
        let tip = pose * Point::y() * (0.75 * self.edges[1]);
        scene.line(Paint::Other, 3.0, &[-tip, tip]);
        scene.dot(Paint::Other, 8.0, tip);
        let spin = self.spin(&now.state);
        scene.arrow(Paint::Momentum, Point::zeros(), spin.try_normalize(0.0).unwrap_or_default() * 0.36);
    }
}

fn pose(state: &State<f64, 7>) -> UnitQuaternion<f64> {
    UnitQuaternion::new_normalize(Quaternion::new(state.q[3], state.q[4], state.q[5], state.q[6]))
}
