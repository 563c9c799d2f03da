//! The spherical pendulum in angles, between its turning points, Milton (8.23)–(8.31).

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob};

/// θ is measured from hanging.
#[derive(Clone, Lagrangian)]
#[coordinates(theta, phi)]
#[lagrangian(m*l^2/2*(theta_dot^2 + sin(theta)^2*phi_dot^2) + m*g*l*cos(theta))]
pub(super) struct PolarPendulum {
    m: f64,
    g: f64,
    l: f64,
}

impl Exhibit<5> for PolarPendulum {
    const TITLE: &'static str = "Spherical pendulum in angles";
    const ABOUT: &'static str = "The spherical pendulum by two angles needs no constraint, and the derive \
        sees that φ is cyclic: p_φ is conserved. With that and the energy the bob moves between two \
        heights, drawn as circles, which it touches in turn. Milton (8.23)–(8.31).";
    const KNOBS: &'static [Knob; 5] = &[
        knob("theta_0", "angle from hanging", "rad", [0.1, 2.8], 1.1),
        knob("w_0", "rate of turning", "rad/s", [0.3, 6.0], 1.4),
        knob("m", "mass", "kg", [0.1, 3.0], 1.0),
        knob("l", "length", "m", [0.3, 2.0], 1.0),
        knob("g", "gravity", "m/s²", [1.0, 20.0], 9.81),
    ];
    const UNITS: Option<Units> = Some(&[("p_phi", "J s")]);

    fn set([theta, rate, m, l, g]: [f64; 5]) -> (Self, State<f64, 2>) {
        (Self { m, g, l }, State::new([theta, 0.0], [0.0, rate]))
    }

    fn view(&self, _: &State<f64, 2>) -> View {
        View::space(Point::z() * (-0.3 * self.l), 1.1 * self.l, 4.0 * self.m * 9.81)
    }

    fn trails(&self, state: &State<f64, 2>) -> Vec<Point> {
        vec![self.place(state.q[0], state.q[1])]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        for theta in self.turning_points(&now.state) {
            let height = Point::z() * (-self.l * theta.cos());
            scene.circle(Paint::Other, 1.5, height, Point::z(), self.l * theta.sin());
        }
        let bob = self.place(now.state.q[0], now.state.q[1]);
        scene.line(Paint::Fixed, 2.0, &[Point::zeros(), bob]);
        scene.dot(Paint::Fixed, 8.0, Point::zeros());
        scene.ball(Paint::Body, 0.07 * self.l, bob);
    }
}

impl PolarPendulum {
    fn place(&self, theta: f64, phi: f64) -> Point {
        let across = self.l * theta.sin();
        Point::new(across * phi.cos(), across * phi.sin(), -self.l * theta.cos())
    }

    /// Where θ̇ is zero at this energy and p_φ, below and above the angle of the least energy with that.
    fn turning_points(&self, state: &State<f64, 2>) -> [f64; 2] {
        let (energy, p) = (self.energy(state), self.momentum(state)[1]);
        let inertia = self.m * self.l * self.l;
        let least = |theta: f64| {
            p * p / (2.0 * inertia * theta.sin().powi(2)) - self.m * self.g * self.l * theta.cos()
        };
        let slope = |theta: f64| {
            self.m * self.g * self.l * theta.sin() - p * p * theta.cos() / (inertia * theta.sin().powi(3))
        };
        let (low, high) = (1e-6, std::f64::consts::PI - 1e-6);
        let bottom = bisect(slope, low, high);
        [
            bisect(|theta| energy - least(theta), low, bottom),
            bisect(|theta| least(theta) - energy, bottom, high),
        ]
    }
}

/// Where a function that rises from below zero crosses that.
fn bisect(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..50 {
        let middle = f64::midpoint(low, high);
        *(if f(middle) < 0.0 { &mut low } else { &mut high }) = middle;
    }
    low
}
