//! A cylinder on an incline, held by a spring, Milton (8.4)–(8.7).

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

#[derive(Clone, Lagrangian)]
#[coordinates(X, phi)]
#[define(inertia = m/2 * a^2)]
#[lagrangian(m/2 * X_dot^2 + inertia/2 * phi_dot^2 + m*g*X*sin(alpha) - k/2 * X^2)]
#[constraint(no_slip: X_dot - a*phi_dot = 0)]
pub(super) struct RollingCylinder {
    m: f64,
    a: f64,
    g: f64,
    alpha: f64,
    k: f64,
}

/// How long the spring is at rest.
const SPRING: f64 = 1.6;

impl Exhibit<5> for RollingCylinder {
    const TITLE: &'static str = "Cylinder on a spring";
    const ABOUT: &'static str = "Rolling is written with velocities, Ẋ − aφ̇ = 0; the derive finds out that \
        it is the rate of X − aφ. The cylinder oscillates with ω² = 2k/3m, and friction turns around twice \
        a period. Milton (8.4)–(8.7).";
    const KNOBS: &'static [Knob; 5] = &[
        knob("X_0", "where it is let go", "m", [-0.9, 1.2], 0.9),
        knob("alpha", "incline", "rad", [0.0, 0.6], 0.2),
        knob("k", "stiffness of the spring", "N/m", [1.0, 40.0], 8.0),
        knob("m", "mass", "kg", [0.1, 3.0], 1.0),
        knob("a", "radius", "m", [0.1, 0.5], 0.3),
    ];
    const UNITS: Option<Units> = Some(&[("no_slip", "N")]);

    fn set([x, alpha, k, m, a]: [f64; 5]) -> (Self, State<f64, 2>) {
        (Self { m, a, g: 9.81, alpha, k }, State::at_rest([x, 0.0]))
    }

    fn view(&self, _: &State<f64, 2>) -> View {
        View::plane(Point::zeros(), 1.9, self.m * 9.81)
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let (along, up) = (xy(self.alpha.cos(), -self.alpha.sin()), xy(self.alpha.sin(), self.alpha.cos()));
        let [x, phi] = [now.state.q[0], now.state.q[1]];
        let (contact, hook) = (along * x, along * -SPRING + up * self.a);
        let centre = contact + up * self.a;
        scene.line(Paint::Fixed, 3.0, &[hook + up * 0.4, along * -SPRING, along * 2.5]);
        scene.spring(hook, centre, 0.09);
        scene.disc(Paint::Body, centre, Point::z(), self.a);
        let spoke = (up * phi.cos() + along * phi.sin()) * self.a;
        scene.line(Paint::Fixed, 2.5, &[centre - spoke, centre + spoke]);
        scene.constraint_force(contact, along * now.force[0]);
        scene.force(centre, along * (-self.k * x));
    }
}
