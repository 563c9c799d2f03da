//! A star in the potential of Hénon and Heiles.

use lagrange_core::prelude::*;

use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

#[derive(Clone, Lagrangian)]
#[coordinates(x, y)]
#[lagrangian((x_dot^2 + y_dot^2)/2 - (x^2 + y^2)/2 - x^2*y + y^3/3)]
pub(super) struct HenonHeiles;

impl Exhibit<3> for HenonHeiles {
    const TITLE: &'static str = "Hénon and Heiles";
    const ABOUT: &'static str = "A star in a galaxy, at x = 0 to start with. Its energy draws the line that \
        it cannot cross; from 1/6 on it may leave. At a low energy its path fills a pattern, as if \
        something else were conserved; closer to 1/6 most paths are chaos. (M. Hénon and C. Heiles, 1964.)";
    const KNOBS: &'static [Knob; 3] = &[
        knob("E", "energy", "", [0.01, 0.166], 0.125),
        knob("y_0", "where it starts", "", [-0.45, 0.6], -0.1),
        knob("v_y", "velocity along y, as a part of what the energy allows", "", [-1.0, 1.0], 0.1),
    ];
    const UNITS: Option<Units> = None;
    const PACE: f64 = 8.0;

    fn set([energy, y, part]: [f64; 3]) -> (Self, State<f64, 2>) {
        let speed = (2.0 * (energy - potential(0.0, y))).max(0.0).sqrt();
        (Self, State::new([0.0, y], [speed * (1.0 - part * part).sqrt(), speed * part]))
    }

    fn view(&self, _: &State<f64, 2>) -> View {
        View::plane(xy(0.0, 0.2), 0.95, 1.0)
    }

    fn trails(&self, state: &State<f64, 2>) -> Vec<Point> {
        vec![state.q.push(0.0)]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let energy = self.energy(&now.state);
        scene.line(Paint::Guide, 1.5, &contour(1.0 / 6.0));
        scene.face(Paint::Guide, &contour(energy));
        scene.line(Paint::Fixed, 1.5, &contour(energy));
        scene.ball(Paint::Body, 0.03, now.state.q.push(0.0));
        scene.force(now.state.q.push(0.0), self.momentum_rate(&now.state).push(0.0));
    }
}

fn potential(x: f64, y: f64) -> f64 {
    (x * x + y * y) / 2.0 + x * x * y - y * y * y / 3.0
}

/// Where the potential is that, in all directions from the origin: within the triangle it grows on the way out.
fn contour(energy: f64) -> Vec<Point> {
    let at = |k: u32| {
        let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / 120.0).sin_cos();
        let (mut inside, mut outside) = (0.0, edge(sine, cosine));
        for _ in 0..30 {
            let middle = f64::midpoint(inside, outside);
            if potential(middle * cosine, middle * sine) < energy {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        xy(cosine, sine) * inside
    };
    (0..=120).map(at).collect()
}

/// How far the triangle through the three saddles reaches: its sides are at 1/2 from the origin.
fn edge(sine: f64, cosine: f64) -> f64 {
    let sides = [[0.0, -1.0], [0.75_f64.sqrt(), 0.5], [-0.75_f64.sqrt(), 0.5]];
    let towards = sides.map(|[x, y]| cosine * x + sine * y);
    0.5 / towards.into_iter().fold(0.0, f64::max)
}
