//! Foucault's pendulum on an Earth that turns faster, Milton (8.44).

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob};

#[derive(Clone, Lagrangian)]
#[coordinates(r: [3])]
#[frame(site: rotate_z(rate*t), rotate_x(pi/2), rotate_x(-latitude))]
#[lagrangian(kinetic(site, m, r) - m*g*r[2])]
#[constraint(string: (dot(r, r) - l^2)/2 = 0)]
pub(super) struct FoucaultPendulum {
    m: f64,
    g: f64,
    l: f64,
    rate: f64,
    latitude: f64,
}

impl Exhibit<4> for FoucaultPendulum {
    const TITLE: &'static str = "Foucault’s pendulum";
    const ABOUT: &'static str = "A pendulum let go from rest in the frame of the Earth, which here turns in \
        minutes. Its plane turns clockwise in the north by sin(latitude) of a turn a day, and not at all on \
        the equator. The Lagrangian is that of a frame: no force of Coriolis is written anywhere. x points \
        east, y north. Milton (8.44).";
    const KNOBS: &'static [Knob; 4] = &[
        knob("latitude", "north of the equator", "rad", [-1.57, 1.57], 0.85),
        knob("rate", "how fast the Earth turns", "rad/s", [0.0, 0.3], 0.08),
        knob("a", "how far it is held to the east", "m", [0.2, 5.0], 3.0),
        knob("l", "length", "m", [6.0, 67.0], 15.0),
    ];
    const UNITS: Option<Units> = Some(&[("string", "N/m")]);
    const PACE: f64 = 3.0;

    fn set([latitude, rate, a, l]: [f64; 4]) -> (Self, State<f64, 3>) {
        (Self { m: 28.0, g: 9.81, l, rate, latitude }, State::at_rest([a, 0.0, -(l * l - a * a).sqrt()]))
    }

    fn view(&self, _: &State<f64, 3>) -> View {
        View {
            from: Some([-1.2, 0.6]),
            ..View::space(Point::z() * (-0.72 * self.l), 0.5 * self.l, 4.0 * self.m * self.g)
        }
    }

    fn trails(&self, state: &State<f64, 3>) -> Vec<Point> {
        vec![state.q]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let (bob, below) = (now.state.q, Point::z() * (-1.03 * self.l));
        let radius = 0.35 * self.l;
        for k in [1.0, 2.0 / 3.0, 1.0 / 3.0] {
            scene.circle(Paint::Guide, 1.0, below, Point::z(), k * radius);
        }
        for [x, y] in [[1.0, 0.0], [0.0, 1.0]] {
            let along = Point::new(x, y, 0.0) * radius;
            scene.line(Paint::Guide, 1.0, &[below - along, below + along]);
        }
        scene.arrow(Paint::Guide, below + Point::y() * radius, Point::y() * (0.15 * radius));
        scene.line(Paint::Fixed, 1.5, &[Point::zeros(), bob]);
        scene.ball(Paint::Body, 0.03 * self.l, bob);
        scene.constraint_force(bob, now.force);
    }
}
