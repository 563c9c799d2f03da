//! A ball with spin that bounces, slides and rolls.

use lagrange_core::contact::Contact;
use lagrange_core::{Method, StateOf, prelude::*};

use crate::exhibit::{Moves, across_contacts};
use crate::{Exhibit, Knob, Moment, Paint, Point, Scene, Units, View, knob, xy};

#[derive(Clone, Lagrangian)]
#[coordinates(x, y, phi)]
#[lagrangian(m/2*(x_dot^2 + y_dot^2) + m*a^2/5*phi_dot^2 - m*g*y)]
#[contact(floor: y - a >= 0, restitution: e, friction(mu): x_dot - a*phi_dot)]
pub(super) struct BouncingBall {
    m: f64,
    a: f64,
    g: f64,
    e: f64,
    mu: f64,
    floor: Contact,
}

impl Exhibit<5> for BouncingBall {
    const TITLE: &'static str = "Ball with backspin";
    const ABOUT: &'static str = "The floor is a contact: it is a constraint while it pushes, and bounces lie \
        between. Friction at each bounce takes of the spin, until the ball comes back. It slides, red, or \
        rolls.";
    const KNOBS: &'static [Knob; 5] = &[
        knob("v_0", "velocity forwards", "m/s", [-2.0, 2.0], 0.9),
        knob("w_0", "spin", "1/s", [-100.0, 100.0], -60.0),
        knob("e", "restitution", "", [0.0, 0.95], 0.75),
        knob("mu", "friction", "", [0.01, 1.0], 0.15),
        knob("a", "radius", "m", [0.05, 0.2], 0.12),
    ];
    const UNITS: Option<Units> = Some(&[("floor", "N"), ("floor_friction", "N")]);

    fn set([v, w, e, mu, a]: [f64; 5]) -> (Self, State<f64, 3>) {
        let ball = Self { m: 0.2, a, g: 9.81, e, mu, floor: Contact::Open };
        (ball, State::new([0.0, 1.4, 0.0], [v, 0.0, w]))
    }

    fn begin(self, start: StateOf<Self>) -> Result<Box<dyn Moves<Self>>, Error>
    where
        Dop853: Method<Self>,
    {
        across_contacts(&self, start)
    }

    fn view(&self, state: &State<f64, 3>) -> View {
        View::plane(xy(state.q[0], 0.8), 1.1, 10.0 * self.m * self.g)
    }

    fn trails(&self, state: &State<f64, 3>) -> Vec<Point> {
        vec![xy(state.q[0], state.q[1])]
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let [x, y, phi] = now.state.q.into();
        // Marks on the floor, every half of a metre.
        let first = (2.0 * x).round();
        scene.line(Paint::Fixed, 3.0, &[xy(x - 4.0, 0.0), xy(x + 4.0, 0.0)]);
        for k in -8..=8 {
            let mark = (first + f64::from(k)) / 2.0;
            scene.line(Paint::Guide, 1.5, &[xy(mark, 0.0), xy(mark, -0.08)]);
        }
        let (centre, foot) = (xy(x, y), xy(x, y - self.a));
        scene.disc(Paint::Body, centre, Point::z(), self.a);
        let spoke = xy(phi.sin(), phi.cos()) * self.a;
        scene.line(Paint::Fixed, 2.5, &[centre - spoke, centre + spoke]);
        match self.floor {
            Contact::Open => {}
            Contact::Closed | Contact::Shares(_) => scene.dot(Paint::Constraint, 9.0, foot),
            Contact::Slides(_) => scene.dot(Paint::Force, 9.0, foot),
        }
        scene.constraint_force(foot, xy(now.force[0], now.force[1]));
    }
}
