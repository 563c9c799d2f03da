//! A pendulum in a carriage that accelerates, Milton (8.32)–(8.42).

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

/// In the carriage, Milton (8.40): A is the acceleration of that.
#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[define(A = gain + reach*omega^2*sin(omega*t))]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) - m*g*y - m*A*x)]
#[constraint(rod: (x^2 + y^2 - l^2)/2 = 0)]
#[observable(push = -m*A)]
pub(super) struct Carriage {
    m: f64,
    g: f64,
    l: f64,
    gain: f64,
    reach: f64,
    omega: f64,
}

impl Exhibit<5> for Carriage {
    const TITLE: &'static str = "Pendulum in a carriage";
    const ABOUT: &'static str = "Seen from the carriage, which accelerates by A(t), a force −mA acts \
        (green); the rod’s is red. With a steady A it hangs askew. Shaken close to its own frequency it \
        swings up. Its energy here is not conserved. Milton (8.32)–(8.42).";
    const KNOBS: &'static [Knob; 5] = &[
        knob("gain", "steady acceleration", "m/s²", [-10.0, 10.0], 2.0),
        knob("reach", "how far it is shaken", "m", [0.0, 0.5], 0.1),
        knob("omega", "how fast it is shaken", "rad/s", [0.0, 10.0], 2.7),
        knob("l", "length", "m", [0.3, 1.2], 1.0),
        knob("theta_0", "angle from hanging", "rad", [-3.0, 3.0], 0.0),
    ];
    const UNITS: Option<Units> = Some(&[("rod", "N/m")]);

    fn set([gain, reach, omega, l, theta]: [f64; 5]) -> (Self, State<f64, 2>) {
        (Self { m: 1.0, g: 9.81, l, gain, reach, omega }, State::at_rest([l * theta.sin(), -l * theta.cos()]))
    }

    fn view(&self, _: &State<f64, 2>) -> View {
        View::plane(xy(0.0, -0.1), 1.6, 3.0 * self.m * self.g)
    }

    fn trails(&self, state: &State<f64, 2>) -> Vec<Point> {
        vec![state.q.push(0.0)]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let corner = |x: f64, y: f64| xy(1.45 * x, 1.3 * y);
        let walls =
            [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0)];
        scene.line(Paint::Fixed, 3.0, &walls);
        // Where the carriage is: A twice integrated, from rest.
        let (t, turn) = (now.state.t, self.omega * now.state.t);
        let went = self.gain * t * t / 2.0 + self.reach * (turn - turn.sin());
        for k in -4..=4 {
            let tie = f64::from(k) * 0.5 - went.rem_euclid(0.5);
            scene.line(Paint::Guide, 3.0, &[xy(tie, -1.62), xy(tie, -1.54)]);
        }
        for x in [-0.9, 0.9] {
            let axle = xy(x, -1.4);
            scene.circle(Paint::Fixed, 2.5, axle, Point::z(), 0.12);
            let spoke = xy((went / 0.12).sin(), (went / 0.12).cos()) * 0.12;
            scene.line(Paint::Fixed, 1.5, &[axle - spoke, axle + spoke]);
        }
        let bob = now.state.q.push(0.0);
        scene.line(Paint::Fixed, 3.0, &[Point::zeros(), bob]);
        scene.dot(Paint::Fixed, 8.0, Point::zeros());
        scene.ball(Paint::Body, 0.09, bob);
        scene.constraint_force(bob, now.force.push(0.0));
        scene.force(bob, xy(self.push(&now.state), 0.0));
    }
}
