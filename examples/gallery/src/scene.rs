//! What is drawn of one moment: lines, balls, faces and arrows in space, as numbers that the page reads.

use lagrange_core::nalgebra::{Rotation3, UnitQuaternion, Vector3};

/// A place in the scene.
pub type Point = Vector3<f64>;

/// A place in the plane.
pub const fn xy(x: f64, y: f64) -> Point {
    Vector3::new(x, y, 0.0)
}

/// By what colour; the page has one of each for light and for dark.
#[derive(Clone, Copy, Debug)]
pub enum Paint {
    /// What moves.
    Body,
    /// What moves beside it.
    Other,
    /// What stands still.
    Fixed,
    /// A line that is only thought of.
    Guide,
    /// A force of a constraint.
    Constraint,
    /// Another force.
    Force,
    /// A momentum.
    Momentum,
}

/// In the order that the page knows.
#[derive(Clone, Copy)]
enum Kind {
    Line,
    Trail,
    Ball,
    Dot,
    Face,
    Arrow,
    /// A circle around the first point, of which the half towards the viewer is seen.
    Ring,
}

/// From where the scene is seen.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// What is in the middle.
    pub centre: Point,
    /// How far one sees from there at least.
    pub radius: f64,
    /// The azimuth and the elevation of who looks at it; nothing for a scene in the plane.
    pub from: Option<[f64; 2]>,
    /// The force whose arrow is as long as the radius.
    pub force: f64,
}

impl View {
    /// Of the plane.
    pub const fn plane(centre: Point, radius: f64, force: f64) -> Self {
        Self { centre, radius, from: None, force }
    }

    /// Of space, a little from above.
    pub const fn space(centre: Point, radius: f64, force: f64) -> Self {
        Self { centre, radius, from: Some([-0.9, 0.35]), force }
    }
}

/// A scene of one moment.
///
/// Each thing drawn is a kind, a paint, a size, and the number of its points, which follow.
#[derive(Clone, Debug)]
pub struct Scene {
    numbers: Vec<f32>,
    /// How long the arrow of a newton is.
    newton: f64,
}

impl Scene {
    /// With arrows of forces, or without.
    pub(crate) fn new(view: &View, with_forces: bool) -> Self {
        Self { numbers: Vec::new(), newton: if with_forces { view.radius / view.force } else { 0.0 } }
    }

    pub(crate) fn into_numbers(self) -> Vec<f32> {
        self.numbers
    }

    fn push(&mut self, kind: Kind, paint: Paint, size: f64, points: &[Point]) {
        self.numbers.extend([kind as u8 as f32, paint as u8 as f32, size as f32, points.len() as f32]);
        self.numbers.extend(points.iter().flat_map(|point| point.iter().map(|x| *x as f32)));
    }

    /// A line, so many pixels wide.
    pub fn line(&mut self, paint: Paint, width: f64, points: &[Point]) {
        self.push(Kind::Line, paint, width, points);
    }

    /// Where something has been, the last point being the latest.
    pub(crate) fn trail(&mut self, points: &[Point]) {
        self.push(Kind::Trail, Paint::Body, 1.5, points);
    }

    /// A ball of this radius.
    pub fn ball(&mut self, paint: Paint, radius: f64, at: Point) {
        self.push(Kind::Ball, paint, radius, &[at]);
    }

    /// A dot, so many pixels wide.
    pub fn dot(&mut self, paint: Paint, width: f64, at: Point) {
        self.push(Kind::Dot, paint, width, &[at]);
    }

    /// A filled polygon.
    pub fn face(&mut self, paint: Paint, corners: &[Point]) {
        self.push(Kind::Face, paint, 1.0, corners);
    }

    /// An arrow as long as it is.
    pub fn arrow(&mut self, paint: Paint, from: Point, along: Point) {
        self.push(Kind::Arrow, paint, 2.5, &[from, from + along]);
    }

    /// The force of a constraint, in newtons.
    pub fn constraint_force(&mut self, at: Point, force: Point) {
        self.arrow(Paint::Constraint, at, force * self.newton);
    }

    /// Another force, in newtons.
    pub fn force(&mut self, at: Point, force: Point) {
        self.arrow(Paint::Force, at, force * self.newton);
    }

    /// A circle, so many pixels wide.
    pub fn circle(&mut self, paint: Paint, width: f64, centre: Point, normal: Point, radius: f64) {
        self.line(paint, width, &circle(centre, normal, radius));
    }

    /// A filled circle.
    pub fn disc(&mut self, paint: Paint, centre: Point, normal: Point, radius: f64) {
        self.face(paint, &circle(centre, normal, radius));
    }

    /// A spring between two places, as wide as said.
    pub fn spring(&mut self, from: Point, to: Point, width: f64) {
        let along = to - from;
        let across = Point::z().cross(&along).try_normalize(1e-9).unwrap_or_else(Point::x) * width;
        let turn =
            |k: u32| from + along * (0.08 + 0.84 * f64::from(k) / 24.0) + across * SWAY[k as usize % 4];
        let mut points = vec![from];
        points.extend((0..=24).map(turn));
        points.push(to);
        self.line(Paint::Fixed, 1.5, &points);
    }

    /// A ball whose turning is seen by three circles on it.
    pub fn marked_ball(&mut self, paint: Paint, radius: f64, at: Point, pose: UnitQuaternion<f64>) {
        self.ball(paint, radius, at);
        for axis in [Point::x(), Point::y(), Point::z()] {
            let mut points = vec![at];
            points.extend(circle(at, pose * axis, radius));
            self.push(Kind::Ring, Paint::Fixed, 1.5, &points);
        }
    }

    /// A box with these edges, turned.
    pub fn solid(&mut self, paint: Paint, at: Point, turn: UnitQuaternion<f64>, edges: [f64; 3]) {
        let corner = |signs: [f64; 3]| at + turn * Point::from_fn(|i, _| signs[i] * edges[i] / 2.0);
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let face = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[first, second]| {
                    let mut signs = [side; 3];
                    (signs[(axis + 1) % 3], signs[(axis + 2) % 3]) = (first, second);
                    corner(signs)
                });
                self.face(paint, &face);
            }
        }
    }

    /// The lines of a floor at z = 0, as far as said.
    pub fn floor(&mut self, centre: Point, reach: f64, height: f64) {
        for k in -4..=4 {
            let across = reach * f64::from(k) / 4.0;
            for [a, b] in [[[across, -reach], [across, reach]], [[-reach, across], [reach, across]]] {
                let at = |p: [f64; 2]| Vector3::new(centre.x + p[0], centre.y + p[1], height);
                self.line(Paint::Guide, 1.0, &[at(a), at(b)]);
            }
        }
    }
}

/// How far the turns of a spring are from its middle.
const SWAY: [f64; 4] = [0.0, 1.0, 0.0, -1.0];

fn circle(centre: Point, normal: Point, radius: f64) -> Vec<Point> {
    let turn = Rotation3::rotation_between(&Point::z(), &normal)
        .unwrap_or_else(|| Rotation3::from_euler_angles(3.0, 0.0, 0.0));
    let at = |k: u32| {
        let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / 48.0).sin_cos();
        centre + turn * (radius * xy(cosine, sine))
    };
    (0..=48).map(at).collect()
}
