//! A system of rigid bodies with numerical parameters, and its positions and velocities at one state.

use super::algebra::{
    Matrix, UNIT, Vector, cross, dot, product, quaternion_product, scaled, sum, times, turn, turn_by,
};

#[derive(Clone, Debug, Default)]
pub(super) struct Model {
    pub(super) time: f64,
    pub(super) coordinates: Vec<f64>,
    pub(super) velocities: Vec<f64>,
    /// Links without the fixed one, which has number 0: link k is `links[k - 1]`.
    pub(super) links: Vec<Link>,
    pub(super) bodies: Vec<Body>,
    pub(super) loads: Vec<Load>,
    /// Generalized force Q of each coordinate.
    pub(super) forces: Vec<f64>,
    pub(super) ties: Vec<Tie>,
}

/// A link, and the joint that connects it to the link before.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub(super) before: usize,
    pub(super) joint: Joint,
}

#[derive(Clone, Debug)]
pub(super) enum Joint {
    /// Translation by a vector along the axes of the link before.
    Slide([Motion; 3]),
    /// Rotation about a unit axis.
    Turn(Vector, Motion),
    /// Constant rotation from the link before.
    Placed(Matrix),
    /// Rotation by a quaternion, given by the index of its first coordinate.
    Ball(usize),
}

/// A function of coordinates and time: c + Σ c q + Σ c q q + Σ c tᵏ + Σ a sin(w t + p).
#[derive(Clone, Debug, Default)]
pub(super) struct Motion {
    pub(super) constant: f64,
    pub(super) linear: Vec<(f64, usize)>,
    pub(super) products: Vec<(f64, usize, usize)>,
    /// Coefficients of t and of t².
    pub(super) powers: [f64; 2],
    pub(super) waves: Vec<[f64; 3]>,
}

/// A rigid body, along the axes of its link. The inertia about the centre is a constant matrix times `growth`.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) mass: Motion,
    pub(super) centre: Point,
    pub(super) inertia: Matrix,
    pub(super) growth: Motion,
    /// Acceleration of gravity, along the fixed axes.
    pub(super) gravity: Vector,
}

/// A point at rest in a link.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub(super) link: usize,
    pub(super) at: Vector,
}

/// Loads: forces at points, along the fixed axes, and torques.
#[derive(Clone, Debug)]
pub(super) enum Load {
    Given(Point, Vector),
    /// Torque on a link, along its own axes.
    Torque(usize, Vector),
    /// Spring force k (d − l) between two points at distance d.
    Spring(Point, Point, f64, f64),
    /// Damping force −c v.
    Damper(Point, f64),
    /// Force v × B on a unit charge.
    Magnetic(Point, Vector),
}

/// A constraint, left side − right side = 0. Each variant names the left side.
#[derive(Clone, Debug)]
pub(super) enum Tie {
    /// Position of the first point minus that of the second.
    Together(Point, Point),
    /// Squared distance of two points.
    Distance(Point, Point),
    /// Component of a position along a fixed axis.
    Level(Point, usize),
    /// Component of a velocity along an axis of the point's link.
    Skate(Point, usize),
    /// Squared norm of four coordinates, by the index of the first.
    Unit(usize),
}

/// Value and derivatives of a motion at a state.
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) rate: f64,
    /// Partial derivatives ∂/∂q, each with the index of its coordinate.
    pub(super) slopes: Vec<(usize, f64)>,
    /// Second time derivative if no coordinate accelerates.
    pub(super) drift: f64,
}

/// Position and velocity of a link, along the fixed axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    /// Rotation matrix, with the axes of the link as columns.
    pub(super) axes: Matrix,
    pub(super) origin: Vector,
    pub(super) turning: Vector,
    pub(super) moving: Vector,
}

impl Motion {
    pub(super) fn of(coordinate: usize) -> Self {
        Self { linear: vec![(1.0, coordinate)], ..Self::default() }
    }

    pub(super) fn fixed(constant: f64) -> Self {
        Self { constant, ..Self::default() }
    }

    pub(super) fn times(&self, c: f64) -> Self {
        Self {
            constant: c * self.constant,
            linear: self.linear.iter().map(|&(x, i)| (c * x, i)).collect(),
            products: self.products.iter().map(|&(x, i, j)| (c * x, i, j)).collect(),
            powers: self.powers.map(|x| c * x),
            waves: self.waves.iter().map(|&[a, w, p]| [c * a, w, p]).collect(),
        }
    }

    fn has_coordinates(&self) -> bool {
        !(self.linear.is_empty() && self.products.is_empty())
    }

    pub(super) fn jet(&self, model: &Model) -> Jet {
        let (q, v, t) = (&model.coordinates, &model.velocities, model.time);
        let [first, second] = self.powers;
        let mut jet = Jet {
            value: self.constant + first * t + second * t * t,
            rate: first + 2.0 * second * t,
            slopes: Vec::new(),
            drift: 2.0 * second,
        };
        for &[a, w, p] in &self.waves {
            let (sin, cos) = (w * t + p).sin_cos();
            jet.value += a * sin;
            jet.rate += a * w * cos;
            jet.drift -= a * w * w * sin;
        }
        for &(c, i) in &self.linear {
            jet.value += c * q[i];
            jet.slopes.push((i, c));
        }
        for &(c, i, j) in &self.products {
            jet.value += c * q[i] * q[j];
            jet.slopes.extend([(i, c * q[j]), (j, c * q[i])]);
            jet.drift += 2.0 * c * v[i] * v[j];
        }
        jet.rate += jet.slopes.iter().map(|&(i, slope)| slope * v[i]).sum::<f64>();
        jet
    }
}

impl Model {
    /// Poses of all links, the fixed one first.
    pub(super) fn poses(&self) -> Vec<Pose> {
        let mut poses = vec![Pose { axes: UNIT, origin: [0.0; 3], turning: [0.0; 3], moving: [0.0; 3] }];
        for Link { before, joint } in &self.links {
            poses.push(self.after(&poses[*before], joint));
        }
        poses
    }

    fn after(&self, before: &Pose, joint: &Joint) -> Pose {
        match joint {
            Joint::Slide(by) => {
                let jets = by.each_ref().map(|motion| motion.jet(self));
                let arm = times(before.axes, jets.each_ref().map(|jet| jet.value));
                let rate = times(before.axes, jets.each_ref().map(|jet| jet.rate));
                let moving = sum([before.moving, cross(before.turning, arm), rate]);
                Pose { origin: sum([before.origin, arm]), moving, ..*before }
            }
            Joint::Turn(axis, angle) => {
                let angle = angle.jet(self);
                let rate = scaled(angle.rate, times(before.axes, *axis));
                before.turned(turn(*axis, angle.value), rate)
            }
            Joint::Placed(by) => before.turned(*by, [0.0; 3]),
            Joint::Ball(first) => {
                let columns = self.ball(before, *first);
                let rates = columns.into_iter().zip(&self.velocities[*first..]);
                let rate = rates.fold([0.0; 3], |sum_, (column, v)| sum([sum_, scaled(*v, column)]));
                before.turned(turn_by(self.quaternion(*first)), rate)
            }
        }
    }

    pub(super) fn quaternion(&self, first: usize) -> [f64; 4] {
        std::array::from_fn(|k| self.coordinates[first + k])
    }

    /// Angular velocity 2 q̇ q̄ for a unit rate of each component of q, where |q| = 1.
    pub(super) fn ball(&self, before: &Pose, first: usize) -> [Vector; 4] {
        let [w, x, y, z] = self.quaternion(first);
        std::array::from_fn(|k| {
            let mut rate = [0.0; 4];
            rate[k] = 2.0;
            let [_, turning @ ..] = quaternion_product(rate, [w, -x, -y, -z]);
            times(before.axes, turning)
        })
    }

    /// Returns true if a coordinate moves the link.
    pub(super) fn is_moved(&self, link: usize) -> bool {
        self.is_turned(link)
            || self.is_any(link, |joint| match joint {
                Joint::Slide(by) => by.iter().any(Motion::has_coordinates),
                _ => false,
            })
    }

    /// Returns true if a coordinate rotates the link.
    pub(super) fn is_turned(&self, link: usize) -> bool {
        self.is_any(link, |joint| match joint {
            Joint::Turn(_, angle) => angle.has_coordinates(),
            Joint::Ball(_) => true,
            Joint::Slide(_) | Joint::Placed(_) => false,
        })
    }

    /// Returns true if a joint between the link and the fixed one satisfies `is`.
    fn is_any(&self, link: usize, is: impl Fn(&Joint) -> bool) -> bool {
        let on_the_way = std::iter::successors(link.checked_sub(1), |&k| self.links[k].before.checked_sub(1));
        on_the_way.into_iter().any(|k| is(&self.links[k].joint))
    }

    /// Position and velocity of a point, along the fixed axes.
    pub(super) fn place(&self, poses: &[Pose], point: Point) -> (Vector, Vector) {
        let pose = &poses[point.link];
        let arm = times(pose.axes, point.at);
        (sum([pose.origin, arm]), sum([pose.moving, cross(pose.turning, arm)]))
    }

    /// Returns true if the rows of the ties are far from linearly dependent: none is short, and the Gram matrix of the
    /// normalized rows has no small pivot.
    pub(super) fn is_tied_well(&self) -> bool {
        let rows = self.tie_rows();
        let lengths: Vec<f64> =
            rows.iter().map(|row| row.iter().map(|x| x * x).sum::<f64>().sqrt()).collect();
        if lengths.iter().any(|length| *length < 0.1) {
            return false;
        }
        let product = |i: usize, j: usize| {
            rows[i].iter().zip(&rows[j]).map(|(x, y)| x * y).sum::<f64>() / (lengths[i] * lengths[j])
        };
        let gram: Vec<Vec<f64>> =
            (0..rows.len()).map(|i| (0..rows.len()).map(|j| product(i, j)).collect()).collect();
        let zero = vec![0.0; rows.len()];
        super::algebra::solved(gram, zero).1 > 0.02
    }

    /// Derivative of the rate of each tie by the velocity of each coordinate.
    fn tie_rows(&self) -> Vec<Vec<f64>> {
        let rates = |velocities: Vec<f64>| Self { velocities, ..self.clone() }.tie_rates();
        let n = self.coordinates.len();
        let rest = rates(vec![0.0; n]);
        let columns: Vec<Vec<f64>> =
            (0..n).map(|i| rates((0..n).map(|j| if i == j { 1.0 } else { 0.0 }).collect())).collect();
        let row = |a: usize| columns.iter().map(|column| column[a] - rest[a]).collect();
        (0..rest.len()).map(row).collect()
    }

    fn tie_rates(&self) -> Vec<f64> {
        let poses = self.poses();
        let of = |tie: &Tie| match *tie {
            Tie::Together(a, b) => {
                let (a, b) = (self.place(&poses, a).1, self.place(&poses, b).1);
                (0..3).map(|k| a[k] - b[k]).collect()
            }
            Tie::Distance(a, b) => {
                let ((r, v), (s, w)) = (self.place(&poses, a), self.place(&poses, b));
                let (arm, rate) = (sum([r, scaled(-1.0, s)]), sum([v, scaled(-1.0, w)]));
                vec![2.0 * dot(arm, rate)]
            }
            Tie::Level(point, axis) => vec![self.place(&poses, point).1[axis]],
            Tie::Skate(point, axis) => {
                let direction = times(poses[point.link].axes, UNIT[axis]);
                vec![dot(direction, self.place(&poses, point).1)]
            }
            Tie::Unit(first) => {
                let q = self.quaternion(first);
                vec![(0..4).map(|k| 2.0 * q[k] * self.velocities[first + k]).sum()]
            }
        };
        self.ties.iter().flat_map(of).collect::<Vec<f64>>()
    }
}

impl Pose {
    fn turned(&self, by: Matrix, rate: Vector) -> Self {
        Self { axes: product(self.axes, by), turning: sum([self.turning, rate]), ..*self }
    }
}
