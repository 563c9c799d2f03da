//! Rolling down an incline, Milton (8.8)–(8.10).

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

/// A sphere, a cylinder and a hoop; `shape` is I/ma².
#[derive(Clone, Lagrangian)]
#[coordinates(x: [3], phi: [3])]
#[lagrangian(sum(i in 0..3, m/2*x_dot[i]^2 + shape[i]*m*a^2/2*phi_dot[i]^2 + m*g*x[i]*sin(alpha)))]
#[constraint(no_slip[i in 0..3]: x_dot[i] - a*phi_dot[i] = 0)]
pub(super) struct Race {
    m: f64,
    a: f64,
    g: f64,
    alpha: f64,
    shape: [f64; 3],
}

/// How far their inclines are apart.
const APART: f64 = 2.4;

impl Exhibit<5> for Race {
    const TITLE: &'static str = "Sphere, cylinder and hoop";
    const ABOUT: &'static str = "They roll down inclines without slipping; ẍ is 5/7, 2/3 and 1/2 of g sin \
        α, whatever their mass and radius. The multiplier of rolling is friction: it points up the slope, \
        and is largest for the hoop. Milton (8.8)–(8.10).";
    const KNOBS: &'static [Knob; 5] = &[
        knob("alpha", "incline", "rad", [0.0, 0.5], 0.06),
        knob("v_0", "speed at the start, up the slope", "m/s", [0.0, 4.0], 1.5),
        knob("m", "mass of each", "kg", [0.1, 5.0], 1.0),
        knob("a", "radius of each", "m", [0.2, 0.8], 0.5),
        knob("g", "gravity", "m/s²", [0.0, 20.0], 9.81),
    ];
    const UNITS: Option<Units> = Some(&[("no_slip", "N")]);

    fn set([alpha, speed, m, a, g]: [f64; 5]) -> (Self, State<f64, 6>) {
        let spin = -speed / a;
        let velocities = [-speed, -speed, -speed, spin, spin, spin];
        (Self { m, a, g, alpha, shape: [0.4, 0.5, 1.0] }, State::new([0.0; 6], velocities))
    }

    fn view(&self, state: &State<f64, 6>) -> View {
        let middle = self.downhill() * (state.q[0] + state.q[2]) / 2.0;
        View::plane(
            middle,
            4.5_f64.max(0.6 * (state.q[0] - state.q[2]).abs() + 2.0),
            1.5 * self.m * 9.81 * self.alpha.sin().max(0.02),
        )
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let (along, up) = (self.downhill(), xy(self.alpha.sin(), self.alpha.cos()));
        for i in 0..3 {
            let (x, phi) = (now.state.q[i], now.state.q[3 + i]);
            let ground = xy(0.0, APART * (1.0 - i as f64) - self.a);
            let contact = ground + along * x;
            let metre = |k: f64| ground + along * (x.round() + k);
            scene.line(Paint::Fixed, 2.0, &[metre(-30.0), metre(30.0)]);
            for k in -30..=30 {
                scene.line(Paint::Fixed, 1.0, &[metre(f64::from(k)), metre(f64::from(k)) - up * 0.12]);
            }
            let centre = contact + up * self.a;
            match i {
                0 => scene.ball(Paint::Body, self.a, centre),
                1 => scene.disc(Paint::Other, centre, Point::z(), self.a),
                _ => scene.circle(Paint::Momentum, 6.0, centre, Point::z(), self.a),
            }
            let spoke = xy(phi.sin(), phi.cos()) * self.a;
            scene.line(Paint::Fixed, 2.0, &[centre - spoke, centre + spoke]);
            scene.constraint_force(contact, along * now.force[i]);
        }
    }
}

impl Race {
    fn downhill(&self) -> Point {
        xy(self.alpha.cos(), -self.alpha.sin())
    }
}
