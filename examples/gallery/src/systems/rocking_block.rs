//! A block that rocks from corner to corner (Housner 1963).

use lagrange_core::contact::Contact;
use lagrange_core::{Method, StateOf, prelude::*};

use crate::exhibit::{Moves, across_contacts};
use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, theta)]
#[define(corner(s) = [x + s*b*cos(theta) + h*sin(theta), y + s*b*sin(theta) - h*cos(theta)])]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*(b^2 + h^2)/6*theta_dot^2 - m*g*y)]
#[contact(floor[i in 0..2]: corner(2*i - 1)[1] >= 0, friction(mu): der(corner(2*i - 1))[0])]
pub(super) struct RockingBlock {
    m: f64,
    b: f64,
    h: f64,
    g: f64,
    mu: f64,
    floor: [Contact; 2],
}

impl RockingBlock {
    /// A point of the block, in half widths and half heights.
    fn point(&self, state: &State<f64, 3>, s: f64, w: f64) -> Point {
        let (sine, cosine) = state.q[2].sin_cos();
        let along = xy(cosine, sine) * (s * self.b);
        xy(state.q[0], state.q[1]) + along + xy(-sine, cosine) * (w * self.h)
    }
}

impl Exhibit<4> for RockingBlock {
    const TITLE: &'static str = "Rocking block";
    const ABOUT: &'static str = "The block turns about one corner, hits the floor with the other, and turns \
        about that. Each impact takes the same part of its energy, as Housner found, and the block rocks \
        faster and faster until it stands.";
    const KNOBS: &'static [Knob; 4] = &[
        knob("tilt", "first angle, as a part of that at which it would fall", "", [0.1, 0.95], 0.9),
        knob("b", "half width", "m", [0.1, 0.25], 0.15),
        knob("h", "half height", "m", [0.4, 0.8], 0.6),
        knob("g", "gravity", "m/s²", [1.0, 20.0], 9.81),
    ];
    const UNITS: Option<Units> = Some(&[("floor", "N"), ("floor_friction", "N")]);
    const PACE: f64 = 0.5;

    fn set([tilt, b, h, g]: [f64; 4]) -> (Self, State<f64, 3>) {
        let angle = tilt * (b / h).atan();
        let (sine, cosine) = angle.sin_cos();
        let block = Self { m: 3.0, b, h, g, mu: 0.8, floor: [Contact::Closed, Contact::Open] };
        (block, State::at_rest([b * cosine - h * sine - b, b * sine + h * cosine, angle]))
    }

    fn begin(self, start: StateOf<Self>) -> Result<Box<dyn Moves<Self>>, Error>
    where
        Dop853: Method<Self>,
    {
        across_contacts(&self, start)
    }

    fn view(&self, _: &State<f64, 3>) -> View {
        View::plane(xy(0.0, self.h), 1.3 * self.h, 4.0 * self.m * self.g)
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let corner = |[s, w]: [f64; 2]| self.point(&now.state, s, w);
        scene.line(Paint::Fixed, 3.0, &[xy(-2.0, 0.0), xy(2.0, 0.0)]);
        scene.face(Paint::Body, &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner));
        scene.dot(Paint::Fixed, 6.0, corner([0.0, 0.0]));
        for (i, floor) in self.floor.iter().enumerate() {
            let foot = corner([2.0 * i as f64 - 1.0, -1.0]);
            if *floor != Contact::Open {
                scene.dot(Paint::Constraint, 9.0, foot);
            }
            scene.constraint_force(foot, xy(now.multipliers[2 + i], now.multipliers[i]));
        }
    }
}
