//! A coin that rolls on a floor.

use lagrange_core::nalgebra::{Matrix3, Rotation3};
use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob};

/// Its pose is where its centre is, its heading, how far it leans, and how far it has rolled.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3], heading, lean, roll)]
#[parameter(inertia: symmetric)]
#[frame(tilted: translate(r), rotate_z(heading), rotate_x(lean))]
#[frame(coin in tilted: rotate_y(roll))]
#[lagrangian(kinetic(coin, m, [0, 0, 0], inertia) - m*g*r[2])]
#[define(below = express(vector(tilted, [0, 0, -a]), fixed))]
#[constraint(rolling: vector(fixed, r_dot) + cross(express(angular_velocity(coin), fixed), below) = 0)]
pub(super) struct RollingCoin {
    m: f64,
    a: f64,
    g: f64,
    inertia: Matrix3<f64>,
}

impl Exhibit<4> for RollingCoin {
    const TITLE: &'static str = "Rolling coin";
    const ABOUT: &'static str = "A coin whose lowest point is at rest: three constraints on six \
        coordinates, two of them nonholonomic. Fast enough it stays up by itself, its path a row of loops.";
    const KNOBS: &'static [Knob; 4] = &[
        knob("lean", "how far it leans", "rad", [-0.8, 0.8], 0.35),
        knob("w_r", "how fast it rolls", "rad/s", [0.0, 12.0], 6.0),
        knob("w_h", "how fast it turns", "rad/s", [-4.0, 4.0], 0.3),
        knob("a", "radius", "m", [0.2, 0.6], 0.4),
    ];
    const UNITS: Option<Units> = Some(&[("rolling", "N")]);

    fn set([lean, rolls, turns, a]: [f64; 4]) -> (Self, State<f64, 6>) {
        let (m, (sine, cosine)) = (1.0, lean.sin_cos());
        let inertia = Matrix3::from_diagonal(&(m * a * a / 4.0 * Point::new(1.0, 2.0, 1.0)));
        let omega = Point::new(0.0, rolls * cosine, rolls * sine + turns);
        let v = -omega.cross(&(a * Point::new(0.0, sine, -cosine)));
        let start = State::new([0.0, 0.0, a * cosine, 0.0, lean, 0.0], [v.x, v.y, v.z, turns, 0.0, rolls]);
        (Self { m, a, g: 9.81, inertia }, start)
    }

    fn view(&self, state: &State<f64, 6>) -> View {
        let middle = Point::new(state.q[0], state.q[1], 0.5 * self.a);
        View { from: Some([-0.9, 0.45]), ..View::space(middle, 4.5 * self.a, 3.0 * self.m * self.g) }
    }

    fn trails(&self, state: &State<f64, 6>) -> Vec<Point> {
        vec![self.contact(state)]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let (centre, contact) = (now.place(0), self.contact(&now.state));
        let tile = 2.0 * self.a;
        let nearest = Point::new((centre.x / tile).round() * tile, (centre.y / tile).round() * tile, 0.0);
        scene.floor(nearest, 4.0 * tile, 0.0);
        let pose = self.tilted(&now.state) * Rotation3::from_axis_angle(&Point::y_axis(), now.state.q[5]);
        scene.disc(Paint::Body, centre, pose * Point::y(), self.a);
        scene.circle(Paint::Fixed, 2.0, centre, pose * Point::y(), self.a);
        for axis in [Point::x(), Point::z()] {
            let spoke = pose * axis * (0.8 * self.a);
            scene.line(Paint::Fixed, 1.5, &[centre - spoke, centre + spoke]);
        }
        scene.constraint_force(contact, now.multiplier(0));
    }
}

impl RollingCoin {
    fn tilted(&self, state: &State<f64, 6>) -> Rotation3<f64> {
        Rotation3::from_axis_angle(&Point::z_axis(), state.q[3])
            * Rotation3::from_axis_angle(&Point::x_axis(), state.q[4])
    }

    fn contact(&self, state: &State<f64, 6>) -> Point {
        let centre: Point = state.q.fixed_rows::<3>(0).into();
        centre - self.tilted(state) * Point::z() * self.a
    }
}
