//! A ball on a floor, a tilted plane or a turntable, Milton (8.4)–(8.7).

use lagrange_core::nalgebra::{Quaternion, UnitQuaternion, UnitVector3, Vector3};
use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob};

#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], q: [4])]
#[define(inertia = 2/5 * m * a^2)]
#[define(Omega = quat_rate(q, q_dot))]
#[lagrangian(m/2 * dot(r_dot, r_dot) + inertia/2 * dot(Omega, Omega) + m*dot(g, r))]
#[constraint(rolling: r_dot - a*cross(Omega, n) = w*cross(n, r))]
#[constraint(unit: (dot(q, q) - 1)/2 = 0)]
pub(super) struct RollingBall {
    m: f64,
    a: f64,
    g: Vector3<f64>,
    n: Vector3<f64>,
    w: f64,
}

impl Exhibit<5> for RollingBall {
    const TITLE: &'static str = "Ball on a turntable";
    const ABOUT: &'static str = "A ball that rolls without slipping, V − a Ω×n = w n×r: nonholonomic, its \
        orientation a unit quaternion. On a turntable it goes in circles at 2/7 of the table’s rate, and \
        where the table is tilted these drift sideways, not down. Milton (8.4)–(8.7).";
    const KNOBS: &'static [Knob; 5] = &[
        knob("w", "rate of the table", "rad/s", [-6.0, 6.0], 3.0),
        knob("alpha", "how far it is tilted", "rad", [0.0, 0.1], 0.01),
        knob("v_0", "speed at the start", "m/s", [0.0, 1.0], 0.3),
        knob("s", "spin about the normal", "rad/s", [-20.0, 20.0], 2.0),
        knob("a", "radius", "m", [0.03, 0.2], 0.1),
    ];
    const UNITS: Option<Units> = Some(&[("rolling", "N"), ("unit", "J")]);

    fn set([w, tilt, speed, spin, a]: [f64; 5]) -> (Self, State<f64, 7>) {
        let n = Point::new(tilt.sin(), 0.0, tilt.cos());
        let (r, v) = (n.cross(&Point::y()) * -0.3, Point::y() * speed);
        let rate = (n.cross(&(v - w * n.cross(&r))) / a + spin * n) / 2.0;
        let q = [r.x, r.y, r.z, 1.0, 0.0, 0.0, 0.0];
        let velocities = [v.x, v.y, v.z, 0.0, rate.x, rate.y, rate.z];
        (Self { m: 0.5, a, g: Point::z() * -9.81, n, w }, State::new(q, velocities))
    }

    fn view(&self, state: &State<f64, 7>) -> View {
        let away = state.q.fixed_rows::<3>(0).norm();
        View { from: Some([-0.9, 0.6]), ..View::space(Point::zeros(), away.max(0.9) + 0.2, 24.0 * self.m) }
    }

    fn trails(&self, state: &State<f64, 7>) -> Vec<Point> {
        let r: Point = state.q.fixed_rows::<3>(0).into();
        vec![r - self.a * self.n]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let (centre, below) = (now.place(0), -self.a * self.n);
        let table = 1.0;
        scene.disc(Paint::Guide, below, self.n, table);
        scene.circle(Paint::Fixed, 1.5, below, self.n, table);
        let turn = UnitQuaternion::from_axis_angle(&UnitVector3::new_normalize(self.n), self.w * now.state.t);
        for k in 0..6 {
            let (sine, cosine) = (f64::from(k) * std::f64::consts::TAU / 6.0).sin_cos();
            let east = Point::y().cross(&self.n).normalize();
            let spoke = turn * (east * cosine + Point::y() * sine);
            scene.line(Paint::Fixed, 1.0, &[below + spoke * 0.05, below + spoke * table]);
        }
        let q = now.state.q;
        let pose = UnitQuaternion::new_normalize(Quaternion::new(q[3], q[4], q[5], q[6]));
        scene.marked_ball(Paint::Body, self.a, centre, pose);
        scene.constraint_force(centre + below, now.multiplier(0));
    }
}
