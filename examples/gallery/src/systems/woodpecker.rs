//! The woodpecker toy, with the numbers of Leine, Glocker and van Campen (2001).

use lagrange_core::contact::Contact;
use lagrange_core::{Method, StateOf, prelude::*};

use crate::exhibit::{Moves, across_contacts};
use crate::{Exhibit, Knob, Moment, Paint, Scene, Units, View, knob, xy};

#[derive(Clone, Lagrangian)]
#[coordinates(y, sleeve, bird)]
#[lagrangian(
    (m + m_s)/2*y_dot^2 + (j_s + m*a^2)/2*sleeve_dot^2 + (j + m*b^2)/2*bird_dot^2
    + m*a*y_dot*sleeve_dot + m*b*y_dot*bird_dot + m*a*b*sleeve_dot*bird_dot
    - c/2*(sleeve - bird)^2 - (m + m_s)*g*y - m*g*a*sleeve - m*g*b*bird
)]
#[contact(beak: reach - h_b*bird >= 0, restitution: e, friction(mu): y_dot + a*sleeve_dot + (b - l)*bird_dot)]
#[contact(lower: play + h*sleeve >= 0, friction(mu): y_dot + r*sleeve_dot)]
#[contact(upper: play - h*sleeve >= 0, friction(mu): y_dot + r*sleeve_dot)]
pub(super) struct Woodpecker {
    m: f64,
    m_s: f64,
    j: f64,
    j_s: f64,
    c: f64,
    g: f64,
    a: f64,
    b: f64,
    l: f64,
    reach: f64,
    play: f64,
    h_b: f64,
    h: f64,
    r: f64,
    e: f64,
    mu: f64,
    beak: Contact,
    lower: Contact,
    upper: Contact,
}

/// Radii of the pole, and of the sleeve around it.
const POLE: f64 = 0.0025;
const SLEEVE: f64 = 0.0031;

impl Exhibit<3> for Woodpecker {
    const TITLE: &'static str = "Woodpecker toy";
    const ABOUT: &'static str = "The sleeve jams at an edge, the woodpecker swings on its spring and frees \
        it, the beak hits the pole, and the sleeve jams again: it pecks its way down. Dots are contacts that \
        hold; where one slides it is of the colour of forces.";
    const KNOBS: &'static [Knob; 3] = &[
        knob("mu", "friction", "", [0.25, 0.35], 0.3),
        knob("e", "restitution of the beak", "", [0.3, 0.6], 0.5),
        knob("g", "gravity", "m/s²", [9.0, 10.5], 9.81),
    ];
    const UNITS: Option<Units> = Some(&[
        ("beak", "N"),
        ("beak_friction", "N"),
        ("lower", "N"),
        ("lower_friction", "N"),
        ("upper", "N"),
        ("upper_friction", "N"),
    ]);
    const PACE: f64 = 0.1;

    fn set([mu, e, g]: [f64; 3]) -> (Self, State<f64, 3>) {
        let (play, h) = (SLEEVE - POLE, 0.0058);
        let toy = Self {
            m: 0.0045,
            m_s: 0.0003,
            j: 7e-7,
            j_s: 5e-9,
            c: 0.0056,
            g,
            a: 0.010,
            b: 0.015,
            l: 0.0201,
            reach: 0.010 + 0.015 - 0.0201 - POLE,
            play,
            h_b: 0.02,
            h,
            r: SLEEVE,
            e,
            mu,
            beak: Contact::Open,
            lower: Contact::Closed,
            upper: Contact::Open,
        };
        (toy, State::new([0.0, -play / h, -0.2788], [-0.3411, 0.0, -7.4583]))
    }

    fn begin(self, start: StateOf<Self>) -> Result<Box<dyn Moves<Self>>, Error>
    where
        Dop853: Method<Self>,
    {
        across_contacts(&self, start)
    }

    fn view(&self, state: &State<f64, 3>) -> View {
        View::plane(xy(0.01, state.q[0]), 0.035, 20.0 * self.m * self.g)
    }

    fn draw(&self, now: &Moment<Self>, scene: &mut Scene) {
        let [y, sleeve, bird] = now.state.q.into();
        let middle = xy(0.0, y);
        for side in [-POLE, POLE] {
            scene.line(Paint::Fixed, 3.0, &[xy(side, y - 0.1), xy(side, y + 0.1)]);
        }
        // Marks on the pole, each a centimetre below the one before.
        for k in -8..=8 {
            let mark = 0.01 * ((100.0 * y).round() + f64::from(k));
            scene.line(Paint::Guide, 1.5, &[xy(-POLE, mark), xy(POLE, mark)]);
        }
        let turned = |angle: f64, x: f64, y: f64| {
            xy(x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos())
        };
        let edge = |x: f64, height: f64| middle + turned(sleeve, x, height);
        for side in [-self.r, self.r] {
            scene.line(Paint::Other, 4.0, &[edge(side, -self.h), edge(side, self.h)]);
        }
        let spring = edge(self.a, 0.0);
        scene.spring(edge(self.r, 0.0), spring, 0.0015);
        let body = |x: f64, height: f64| spring + turned(bird, x, height);
        scene.face(
            Paint::Body,
            &[
                body(0.011, -0.02),
                body(0.019, -0.01),
                body(0.019, 0.012),
                body(0.012, 0.022),
                body(0.009, 0.012),
            ],
        );
        let beak = body(self.b - self.l, self.h_b);
        scene.line(Paint::Body, 4.0, &[spring, body(self.b, 0.0)]);
        scene.line(Paint::Body, 3.0, &[body(0.012, 0.02), beak]);
        let touches =
            [(self.beak, beak), (self.lower, edge(self.r, -self.h)), (self.upper, edge(self.r, self.h))];
        for (contact, at) in touches {
            match contact {
                Contact::Open => {}
                Contact::Closed | Contact::Shares(_) => scene.dot(Paint::Constraint, 9.0, at),
                Contact::Slides(_) => scene.dot(Paint::Force, 9.0, at),
            }
        }
        // Friction, along the pole: each contact is followed by its own.
        for (k, (_, at)) in touches.into_iter().enumerate() {
            scene.constraint_force(at, xy(0.0, now.multipliers[2 * k + 1]));
        }
        scene.dot(Paint::Fixed, 5.0, spring);
    }
}
