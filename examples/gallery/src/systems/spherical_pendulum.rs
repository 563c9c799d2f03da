//! A bob on a string, Milton (8.11)–(8.31).

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob};

#[derive(Clone, Lagrangian)]
#[coordinates(r: [3])]
#[lagrangian(m/2 * dot(r_dot, r_dot) - m*g*r[2])]
#[constraint(string: (dot(r, r) - l^2)/2 = 0)]
#[conserved(L_z = m*(r[0]*r_dot[1] - r[1]*r_dot[0]))]
pub(super) struct SphericalPendulum {
    m: f64,
    g: f64,
    l: f64,
}

impl Exhibit<5> for SphericalPendulum {
    const TITLE: &'static str = "Spherical pendulum";
    const ABOUT: &'static str = "A bob on a string. It swings between two heights and the ellipse turns, by \
        3πab/4l² an orbit where it is small: try small angles. The red arrow is the tension, −λl; the \
        string could not push. Milton (8.11)–(8.31).";
    const KNOBS: &'static [Knob; 5] = &[
        knob("theta_0", "angle from hanging", "rad", [0.05, 3.0], 1.1),
        knob("v_0", "speed sideways", "m/s", [0.0, 5.0], 1.2),
        knob("m", "mass", "kg", [0.1, 3.0], 1.0),
        knob("l", "length", "m", [0.3, 2.0], 1.0),
        knob("g", "gravity", "m/s²", [0.0, 20.0], 9.81),
    ];
    const UNITS: Option<Units> = Some(&[("L_z", "J s"), ("string", "N/m")]);

    fn set([theta, speed, m, l, g]: [f64; 5]) -> (Self, State<f64, 3>) {
        (Self { m, g, l }, State::new([l * theta.sin(), 0.0, -l * theta.cos()], [0.0, speed, 0.0]))
    }

    fn view(&self, _: &State<f64, 3>) -> View {
        View::space(Point::z() * (-0.3 * self.l), 1.1 * self.l, 4.0 * self.m * 9.81)
    }

    fn trails(&self, state: &State<f64, 3>) -> Vec<Point> {
        vec![state.q]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let bob = now.state.q;
        scene.floor(Point::zeros(), self.l, -1.2 * self.l);
        let shadow = Point::new(bob.x, bob.y, -1.2 * self.l);
        scene.disc(Paint::Guide, shadow, Point::z(), 0.05 * self.l);
        scene.line(Paint::Fixed, 2.0, &[Point::zeros(), bob]);
        scene.dot(Paint::Fixed, 8.0, Point::zeros());
        scene.ball(Paint::Body, 0.07 * self.l, bob);
        scene.constraint_force(bob, now.force);
    }
}
