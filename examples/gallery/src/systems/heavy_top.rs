//! A heavy top.

use lagrange_core::nalgebra::{Matrix3, Quaternion, UnitQuaternion};
use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob};

/// Its centre of mass is at r; its tip, at the distance l below that, is held by three constraints.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[parameter(inertia: symmetric)]
#[frame(top: translate(r), rotate(q))]
#[lagrangian(kinetic(top, m, [0, 0, 0], inertia) - m*g*r[2])]
#[constraint(tip: position(top, [0, 0, -l]) = 0)]
#[observable(spin = express(inertia*angular_velocity(top), fixed))]
pub(super) struct HeavyTop {
    m: f64,
    g: f64,
    l: f64,
    inertia: Matrix3<f64>,
}

impl Exhibit<5> for HeavyTop {
    const TITLE: &'static str = "Heavy top";
    const ABOUT: &'static str = "A top on its tip, its pose a unit quaternion, the push of the floor a \
        multiplier (red). It is let go leaning and nods while it precesses; give it the right turn and it \
        does not nod; spun too slowly it falls under the floor. The angular momentum about its centre is \
        blue-green.";
    const KNOBS: &'static [Knob; 5] = &[
        knob("s", "spin", "rad/s", [0.0, 200.0], 90.0),
        knob("theta_0", "angle from upright", "rad", [0.05, 1.5], 0.6),
        knob("p", "precession at the start", "rad/s", [-5.0, 5.0], 0.0),
        knob("l", "height of its centre", "m", [0.05, 0.3], 0.15),
        knob("m", "mass", "kg", [0.1, 2.0], 0.5),
    ];
    const UNITS: Option<Units> = Some(&[("tip", "N"), ("q", "J")]);
    const PACE: f64 = 0.5;

    fn set([spin, theta, precession, l, m]: [f64; 5]) -> (Self, State<f64, 7>) {
        let a = 0.1;
        let inertia = Matrix3::from_diagonal(&(m * a * a / 4.0 * Point::new(1.0, 1.0, 2.0)));
        let pose = UnitQuaternion::from_axis_angle(&Point::x_axis(), -theta);
        let axis = pose * Point::z();
        let omega = spin * axis + precession * Point::z();
        let rate = (Quaternion::from_imag(omega) * pose.into_inner()) / 2.0;
        let (r, v) = (l * axis, omega.cross(&(l * axis)));
        let q = [r.x, r.y, r.z, pose.w, pose.i, pose.j, pose.k];
        (Self { m, g: 9.81, l, inertia }, State::new(q, [v.x, v.y, v.z, rate.w, rate.i, rate.j, rate.k]))
    }

    fn view(&self, _: &State<f64, 7>) -> View {
        View::space(Point::z() * (0.5 * self.l), 1.5 * self.l + 0.12, 4.0 * self.m * self.g)
    }

    fn trails(&self, state: &State<f64, 7>) -> Vec<Point> {
        let r: Point = state.q.fixed_rows::<3>(0).into();
        vec![1.7 * r]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let (r, q) = (now.place(0), now.state.q);
        let pose = UnitQuaternion::new_normalize(Quaternion::new(q[3], q[4], q[5], q[6]));
        scene.floor(Point::zeros(), 2.0 * self.l, 0.0);
        scene.line(Paint::Fixed, 4.0, &[Point::zeros(), 1.7 * r]);
        scene.disc(Paint::Body, r, pose * Point::z(), 0.1);
        scene.circle(Paint::Fixed, 3.0, r, pose * Point::z(), 0.1);
        for side in [-1.0, 1.0] {
            let mark = pose * Point::x() * (0.1 * side);
            scene.line(Paint::Fixed, 1.5, &[r + mark * 0.2, r + mark]);
        }
        let spin = self.spin(&now.state);
        scene.arrow(Paint::Momentum, r, spin * (1.2 * self.l / (0.005 * self.m * 90.0)));
        scene.constraint_force(Point::zeros(), now.multiplier(0));
    }
}
