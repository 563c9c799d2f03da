//! A pole balanced on a cart in a wind.

use lagrange_core::nalgebra::Vector4;
use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

/// θ is measured from the upright; the cart is pushed by what holds it in this wind less the feedback.
#[derive(Clone, Lagrangian)]
#[coordinates(x, theta)]
#[define(bob = [x + l*sin(theta), l*cos(theta)])]
#[lagrangian(cart/2*x_dot^2 + m/2*dot(der(bob), der(bob)) - m*g*bob[1])]
#[define(control = -wind - strength*dot(gain, [x, theta - lean, x_dot, theta_dot]))]
#[force(x: control + wind)]
#[force(theta: wind*l*cos(theta))]
#[observable(u = control)]
pub(super) struct CartPole {
    cart: f64,
    m: f64,
    l: f64,
    g: f64,
    wind: f64,
    lean: f64,
    strength: f64,
    gain: Vector4<f64>,
}

/// Of least cost for 1 kg, 0.2 kg and 0.6 m, as the example `cart_pole` finds it.
const GAIN: [f64; 4] = [-3.1623, -42.9893, -4.4086, -9.9971];

impl Exhibit<5> for CartPole {
    const TITLE: &'static str = "Pole on a cart";
    const ABOUT: &'static str = "A feedback balances the pole in a steady wind, leaning against that; the \
        green arrows are the wind and the push of the motor. Make the feedback weaker, and see when the \
        pole falls.";
    const KNOBS: &'static [Knob; 5] = &[
        knob("theta_0", "angle from the upright", "rad", [-0.9, 0.9], 0.45),
        knob("x_0", "where the cart starts", "m", [-1.0, 1.0], 0.5),
        knob("wind", "force of the wind", "N", [-1.0, 1.0], 0.5),
        knob("strength", "of the feedback", "", [0.0, 2.0], 1.0),
        knob("m", "mass of the bob", "kg", [0.05, 0.6], 0.2),
    ];
    const UNITS: Option<Units> = Some(&[]);

    fn set([theta, x, wind, strength, m]: [f64; 5]) -> (Self, State<f64, 2>) {
        let g = 9.81;
        let lean = -(wind / (m * g)).atan();
        let cart_pole = Self { cart: 1.0, m, l: 0.6, g, wind, lean, strength, gain: GAIN.into() };
        (cart_pole, State::at_rest([x, theta]))
    }

    fn view(&self, state: &State<f64, 2>) -> View {
        // It may run away.
        View::plane(xy(state.q[0] - state.q[0].clamp(-1.0, 1.0), 0.2), 1.6, 6.0)
    }

    fn trails(&self, state: &State<f64, 2>) -> Vec<Point> {
        vec![self.bob(state)]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let (x, bob) = (now.state.q[0], self.bob(&now.state));
        let ground = -0.22;
        scene.line(Paint::Fixed, 2.0, &[xy(x - 9.0, ground), xy(x + 9.0, ground)]);
        let corners = [[-0.22, -0.12], [0.22, -0.12], [0.22, 0.0], [-0.22, 0.0]];
        scene.face(Paint::Body, &corners.map(|[a, b]| xy(x + a, b)));
        for wheel in [-0.13, 0.13] {
            let axle = xy(x + wheel, -0.16);
            scene.circle(Paint::Fixed, 2.0, axle, Point::z(), 0.06);
            let spoke = xy((x / 0.06).sin(), (x / 0.06).cos()) * 0.06;
            scene.line(Paint::Fixed, 1.5, &[axle - spoke, axle + spoke]);
        }
        scene.line(Paint::Fixed, 4.0, &[xy(x, 0.0), bob]);
        scene.ball(Paint::Other, 0.12 * self.m.cbrt(), bob);
        scene.force(bob, xy(self.wind, 0.0));
        scene.force(xy(x, -0.06), xy(self.u(&now.state), 0.0));
    }
}

impl CartPole {
    fn bob(&self, state: &State<f64, 2>) -> Point {
        let (sine, cosine) = state.q[1].sin_cos();
        xy(state.q[0] + self.l * sine, self.l * cosine)
    }
}
