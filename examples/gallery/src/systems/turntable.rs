//! A mass on a spring in a frame that turns, Milton (8.43)–(8.57).

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

/// In the frame: v₀ = v + Ω×r.
#[derive(Clone, Lagrangian)]
#[coordinates(r: [3])]
#[define(v = r_dot)]
#[define(W = [0, 0, omega])]
#[lagrangian(m/2*dot(v, v) + m*dot(v, cross(W, r)) + m/2*dot(cross(W, r), cross(W, r)) - k/2*dot(r, r))]
#[observable(coriolis = 2*m*cross(v, W))]
#[observable(centrifugal = m*cross(W, cross(r, W)))]
pub(super) struct Turntable {
    m: f64,
    k: f64,
    omega: f64,
}

/// The frame on the left, what one sees from outside on the right.
const APART: f64 = 1.25;

impl Exhibit<5> for Turntable {
    const TITLE: &'static str = "Turning frame";
    const ABOUT: &'static str = "A mass on a spring, seen from a frame that turns (left) and from outside \
        (right). One arrow is the force of Coriolis, across the velocity, the other, along the radius, the \
        centrifugal force and the spring together. What is conserved is E = E₀ − L·Ω. Milton (8.43)–(8.57).";
    const KNOBS: &'static [Knob; 5] = &[
        knob("omega", "rate of the frame", "rad/s", [-4.0, 4.0], 1.0),
        knob("k", "stiffness of the spring", "N/m", [0.0, 10.0], 3.0),
        knob("x_0", "where it starts", "m", [0.1, 1.0], 0.8),
        knob("u_0", "speed outwards, in the frame", "m/s", [-1.0, 1.0], 0.0),
        knob("v_0", "speed sideways, in the frame", "m/s", [-2.0, 2.0], 0.0),
    ];
    const UNITS: Option<Units> = Some(&[]);

    fn set([rate, k, x, outwards, sideways]: [f64; 5]) -> (Self, State<f64, 3>) {
        (Self { m: 1.0, k, omega: rate }, State::new([x, 0.0, 0.0], [outwards, sideways, 0.0]))
    }

    fn view(&self, state: &State<f64, 3>) -> View {
        View::plane(Point::zeros(), 2.4_f64.max(state.q.norm() + APART), 10.0)
    }

    fn trails(&self, state: &State<f64, 3>) -> Vec<Point> {
        vec![inside(state.q), self.outside(state)]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let (r, angle) = (now.state.q, self.omega * now.state.t);
        for (side, turn) in [(-APART, 0.0), (APART, angle)] {
            let middle = xy(side, 0.0);
            scene.disc(Paint::Guide, middle, Point::z(), 1.1);
            for k in 0..4 {
                let (sine, cosine) = (turn + f64::from(k) * std::f64::consts::FRAC_PI_2).sin_cos();
                let width = if k == 0 { 2.5 } else { 1.0 };
                scene.line(Paint::Fixed, width, &[middle, middle + xy(cosine, sine) * 1.1]);
            }
        }
        let bob = inside(r);
        scene.spring(inside(Point::zeros()), bob, 0.05);
        scene.ball(Paint::Body, 0.07, bob);
        scene.spring(xy(APART, 0.0), self.outside(&now.state), 0.05);
        scene.ball(Paint::Body, 0.07, self.outside(&now.state));
        scene.force(bob, self.coriolis(&now.state));
        scene.force(bob, self.centrifugal(&now.state) - self.k * r);
    }
}

fn inside(r: Point) -> Point {
    r - xy(APART, 0.0)
}

impl Turntable {
    fn outside(&self, state: &State<f64, 3>) -> Point {
        let (sine, cosine) = (self.omega * state.t).sin_cos();
        xy(APART + state.q.x * cosine - state.q.y * sine, state.q.x * sine + state.q.y * cosine)
    }
}
