//! A robot arm of six joints, led around a circle.

use lagrange_core::nalgebra::{Matrix3, Vector3};
use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob};

/// A link without the joint: in its frame, about its centre.
#[derive(Clone, Copy)]
pub(super) struct Body {
    m: f64,
    centre: Vector3<f64>,
    inertia: Matrix3<f64>,
}

/// By the convention of Denavit and Hartenberg; about a PUMA 560.
#[derive(Clone, Lagrangian)]
#[coordinates(q: [6])]
#[define(a = [0, 0.43, 0.02, 0, 0, 0])]
#[define(d = [0.67, 0, 0.15, 0.43, 0, 0.2])]
#[define(alpha = [pi/2, 0, -pi/2, pi/2, -pi/2, 0])]
#[frame(link[0]: rotate_z(q[0]), translate([a[0], 0, d[0]]), rotate_x(alpha[0]))]
#[frame(link[i in 1..6] in link[i-1]: rotate_z(q[i]), translate([a[i], 0, d[i]]), rotate_x(alpha[i]))]
#[parameter(body: [6] {m, centre: [3], inertia: symmetric})]
#[lagrangian(sum(i in 0..6,
    kinetic(link[i], body[i].m, body[i].centre, body[i].inertia) - body[i].m*g*position(link[i], body[i].centre)[2]
))]
#[define(turn = 2*pi*t/round)]
#[constraint(tool: position(link[5]) = middle + radius*[0, sin(turn), cos(turn)])]
#[define(along = express(vector(link[5], [0, 0, 1]), fixed))]
#[define(across = express(vector(link[5], [0, 1, 0]), fixed))]
#[constraint(points_down: [along[0], along[1], across[0]] = 0)]
#[observable(shoulder = position(link[0]))]
#[observable(elbow = position(link[1]))]
#[observable(forearm = position(link[2]))]
#[observable(wrist = position(link[3]))]
#[observable(tip = position(link[5]))]
pub(super) struct RobotArm {
    body: [Body; 6],
    g: f64,
    middle: Vector3<f64>,
    radius: f64,
    round: f64,
}

impl Exhibit<4> for RobotArm {
    const TITLE: &'static str = "Robot arm, led by the hand";
    const ABOUT: &'static str = "Six joints, and a hand that leads the tool around a circle, pointing down: \
        six constraints that depend on time. Their multipliers are the force and the moments of the hand, \
        which bears the arm, as its motors are off.";
    const KNOBS: &'static [Knob; 4] = &[
        knob("T", "time for a round", "s", [0.8, 6.0], 2.5),
        knob("R", "radius of the circle", "m", [0.02, 0.2], 0.15),
        knob("h", "height of its middle", "m", [0.3, 0.6], 0.45),
        knob("m", "load of the tool", "kg", [0.0, 5.0], 1.0),
    ];
    const UNITS: Option<Units> = Some(&[("tool", "N"), ("points_down", "N m")]);

    fn set([round, radius, height, load]: [f64; 4]) -> (Self, State<f64, 6>) {
        let body = |m: f64, centre: [f64; 3], inertia: [f64; 3]| Body {
            m,
            centre: centre.into(),
            inertia: Matrix3::from_diagonal(&inertia.into()),
        };
        let arm = Self {
            body: [
                body(13.0, [0.0, -0.3, 0.05], [0.8, 0.35, 0.8]),
                body(17.0, [-0.25, 0.0, 0.1], [0.13, 0.53, 0.54]),
                body(5.0, [-0.02, 0.0, 0.07], [0.07, 0.09, 0.013]),
                body(0.8, [0.0, -0.1, 0.0], [2e-3, 1.3e-3, 2e-3]),
                body(0.4, [0.0, 0.0, 0.0], [3e-4, 4e-4, 3e-4]),
                body(load, [0.0, 0.0, -0.08], [3e-3, 3e-3, 1e-3]),
            ],
            g: 9.81,
            middle: Point::new(0.5, 0.0, height),
            radius,
            round,
        };
        (arm, State::at_rest([0.0, 0.95, -3.47, 0.0, -0.62, 0.0]))
    }

    fn view(&self, _: &State<f64, 6>) -> View {
        View { from: Some([-0.7, 0.25]), ..View::space(Point::new(0.25, 0.0, 0.5), 0.75, 500.0) }
    }

    fn trails(&self, state: &State<f64, 6>) -> Vec<Point> {
        vec![self.tip(state)]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let s = &now.state;
        let (shoulder, tip) = (self.shoulder(s), self.tip(s));
        scene.floor(Point::new(0.25, 0.0, 0.0), 0.75, 0.0);
        scene.circle(Paint::Guide, 1.5, self.middle, Point::x(), self.radius);
        let joints = [shoulder, self.elbow(s), self.forearm(s), self.wrist(s)];
        scene.line(Paint::Fixed, 16.0, &[Point::zeros(), shoulder]);
        scene.line(Paint::Body, 11.0, &joints[..2]);
        scene.line(Paint::Body, 8.0, &joints[1..]);
        scene.line(Paint::Other, 5.0, &[joints[3], tip]);
        for joint in joints {
            scene.dot(Paint::Fixed, 12.0, joint);
        }
        scene.dot(Paint::Other, 8.0, tip);
        scene.constraint_force(tip, now.multiplier(0));
    }
}
